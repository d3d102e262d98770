#include "simulate/simulate.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "humanoid/rotations.h"
#include "simulate/check.h"
#include "simulate/collision.h"
#include "simulate/figures.h"
#include "simulate/limits.h"
#include "simulate/model.h"
#include "simulate/scene_props.h"

namespace ukemi {
namespace {

/// How steps are taken. Adaptive: 240 Hz, 120 Hz when calm, halved down to 1/960 s when a step's result is
/// bad. Fixed: the yardstick that gains are measured against.
struct Stepping {
  bool adaptive = true;
  double tick_s = 1.0 / 960.0;
  int base_ticks = 4;
  int calm_ticks = 8;
  Reach reach{0.02, 1.5};
  double max_correcting_speed = 0.3;  // m/s, of contacts
  bool sparse_friction = true;
};

constexpr int kCalmSteps = 8;
constexpr double kCalmSpeed = 3.0;             // rad/s, of every joint
constexpr double kWorstExcess = radians(0.5);  // above: the step is rejected
constexpr double kWorstSeparation = 0.006;     // m
constexpr double kWorstSinking = 0.008;        // m, growth of a pair's depth in one step
constexpr double kFloorDepth = 0.005;          // m: below this in the floor
constexpr double kFloorSinking = 0.002;        // m: a pair may grow only so much
constexpr double kWorstMiss =
    radians(0.3);  // beyond an edge without a row: the step is taken again with all rows
constexpr double kErp = 0.8;
constexpr double kErpPerSecond = 192.0;  // ERP = min(0.8, 192 h): correction speed does not grow as h shrinks
constexpr double kCfm = 1e-9;
constexpr double kContactLayer = 0.001;  // m
constexpr double kRunaway = 100.0;       // m/s
constexpr double kTornApart = 0.115;  // of the height: a joint whose halves are so far apart is none any more
constexpr double kRestSpeed = 0.02;   // m/s
constexpr double kRestTurning = 0.1;  // rad/s
constexpr double kRestSpan_s = 0.25;
constexpr double kSlowSpeed = 0.2;    // m/s, and
constexpr double kSlowTurning = 1.0;  // rad/s: for kSlowSpan_s the body settles into the pose it has
constexpr double kSlowSpan_s = 0.15;
constexpr double kSettleRamp_s = 0.5;
constexpr double kSettleShare = 0.5;  // of the tone

constexpr double kEarthGravity = 9.81;  // m/s^2
constexpr double kEnergyGain = 0.8;     // of mass g height: more energy from nowhere is an explosion
constexpr double kBlowShare = 0.01;     // and of the energy of what hits, which no solver keeps exactly

/// Thrown out of a run that is no motion of a body any more.
struct Diverged {
  Segment segment;
  double time_s, speed;
  std::string how{};  // where it is not the speed
};

/// `refinement`: so many times shorter than the settings say.
Stepping stepping_of(const SimulationSettings& settings, int refinement) {
  Stepping s;
  s.tick_s /= refinement;
  if (settings.fixed_hz > 0.0) {
    s.adaptive = false;
    s.tick_s = 1.0 / (settings.fixed_hz * refinement);
    s.base_ticks = s.calm_ticks = 1;
    s.reach = {std::max(0.25, 120.0 * s.tick_s), 0.0};
    s.max_correcting_speed = 1.0;
    s.sparse_friction = false;
  }
  return s;
}

/// Frames between two step ends: positions linearly, rotations along the arc.
Rigid between(const Rigid& a, const Rigid& b, double u) {
  return {a.rotation.slerp(u, b.rotation), a.translation + u * (b.translation - a.translation)};
}

BodyPose between(const BodyPose& a, const BodyPose& b, double u) {
  BodyPose pose;
  for (int s = 0; s < kSegmentCount; ++s) pose[s] = between(a[s], b[s], u);
  return pose;
}

class Simulation {
 public:
  /// `judged`: range that the figures are taken against; null: the range in force.
  Simulation(const ArticulatedBody& body, const RangeOfMotion& range, const RangeOfMotion* judged,
             const ActiveThresholds& thresholds, const StartState& start, const Scene& scene,
             const SimulationSettings& settings, int refinement)
      : settings_(settings),
        judged_(judged),
        torn_apart_(kTornApart * body.height_m),
        most_energy_j_(kEnergyGain * body.mass_kg * kEarthGravity * body.height_m),
        stepping_(stepping_of(settings, refinement)),
        direction_(scene.direction),
        model_(world_, body, range),
        collision_(world_, model_, body, settings.self_collision),
        stage_(world_, model_, collision_, scene, settings.gravity),
        recorder_(model_, settings.gravity) {
    dWorldSetGravity(world_.id(), 0.0, -settings.gravity, 0.0);
    dWorldSetCFM(world_.id(), kCfm);
    dWorldSetContactSurfaceLayer(world_.id(), kContactLayer);
    dWorldSetContactMaxCorrectingVel(world_.id(), stepping_.max_correcting_speed);
    model_.place(start.segments, start.linear_velocity, start.angular_velocity);
    collision_.accept_overlaps();
    passive_.reserve(model_.joints().size());
    active_.reserve(model_.joints().size());
    tone_.reserve(model_.joints().size());
    for (const ModelJoint& joint : model_.joints()) {
      passive_.emplace_back(world_, model_, joint, settings.limits);
      active_.emplace_back(world_, model_, joint, settings.active, settings.active_k,
                           thresholds[index(joint.joint)]);
    }
    // Torques grow with weight and height.
    const double strength = tone_of(settings) * body.mass_kg * body.height_m / (73.0 * 1.741);
    for (const ModelJoint& joint : model_.joints()) tone_.emplace_back(world_, model_, joint, strength);
    set_erp(base_h());
  }

  void run(Diagnostics& diagnostics);
  /// Of what has been run; takes the trajectory.
  SimulationResult result();
  const std::vector<double>& excesses() const { return recorder_.excesses(); }
  double time_s() const { return stepping_.tick_s * static_cast<double>(ticks_); }
  /// When and where a joint first came apart or energy came from nowhere; a run goes on all the same.
  const std::optional<Diverged>& torn() const { return torn_; }

 private:
  double base_h() const { return stepping_.tick_s * stepping_.base_ticks; }
  bool projecting() const { return settings_.limits == Limits::edges; }

  void run_to_end();
  void set_erp(double h);
  void add_forces(double h);
  void advance(int ticks);
  bool try_step(int ticks);
  bool sinks(const Contacts& next) const;
  void take_step(double h);
  double project(double worst_excess);
  void accept(int ticks, const std::vector<double>& excesses, double projected, double separation,
              Contacts next);
  std::vector<double> joint_excesses() const;
  std::vector<double> judged_excesses() const;
  double worst_separation() const;
  double worst_joint_speed() const;
  double tone_share() const;
  std::vector<Rigid> prop_poses() const;
  void save();
  void restore();
  void check_speeds() const;
  void watch_joints(double worst_separation);
  void watch_energy();
  Diverged fastest(std::string how) const;
  void watch_rest(int ticks);
  void add_frames_until(double time_s);

  SimulationSettings settings_;
  const RangeOfMotion* judged_;
  double torn_apart_;     // m
  double most_energy_j_;  // to be gained without a cause
  std::optional<Diverged> torn_;
  Stepping stepping_;
  Vec3 direction_;  // of the blow
  OdeWorld world_;
  Model model_;
  Collision collision_;
  SceneProps stage_;
  Recorder recorder_;
  std::vector<PassiveLimit> passive_;
  std::vector<ActiveLimit> active_;
  std::vector<Tone> tone_;
  std::vector<bool> all_rows_;
  Contacts contacts_;
  std::vector<RigidState> saved_;
  long ticks_ = 0;
  int calm_steps_ = 0;
  double still_s_ = 0.0, slow_s_ = 0.0;
  std::optional<double> settling_since_s_;
  bool resting_ = false;
  double erp_h_ = 0.0;
  Trajectory trajectory_;
  BodyPose before_, now_;
  std::vector<Rigid> props_before_, props_now_;
  double before_s_ = 0.0;
};

void Simulation::set_erp(double h) {
  if (h == erp_h_) return;
  erp_h_ = h;
  const double erp = stepping_.adaptive ? std::min(kErp, kErpPerSecond * h) : kErp;
  dWorldSetERP(world_.id(), erp);
  // Ball joints copied the world's ERP when they were made.
  for (const ModelJoint& joint : model_.joints()) {
    dJointSetBallParam(joint.id, dParamERP, erp);
    dJointSetBallParam(joint.id, dParamCFM, kCfm);
  }
}

void Simulation::add_forces(double h) {
  const double damping = std::min(damping_of(settings_), kMaxExplicitGain / h);
  const double tone = tone_share();
  for (std::size_t j = 0; j < model_.joints().size(); ++j) {
    passive_[j].prepare(h, stepping_.reach, all_rows_[j]);
    active_[j].prepare(time_s() >= settings_.active_delay_s);
    tone_[j].prepare(h, tone);
    if (damping > 0.0) apply_damping(model_, model_.joints()[j], damping);
  }
  stage_.apply(time_s());
}

/// Full at the blow, gone after the fade, back in part once the body lies still.
double Simulation::tone_share() const {
  if (settling_since_s_) return kSettleShare * std::min(1.0, (time_s() - *settling_since_s_) / kSettleRamp_s);
  if (settings_.tone_fade_s <= 0.0) return 0.0;
  const double left = std::clamp(1.0 - time_s() / settings_.tone_fade_s, 0.0, 1.0);
  return left * left * (3.0 - 2.0 * left);
}

void Simulation::save() {
  saved_.clear();
  for (const ModelBody& body : model_.bodies()) saved_.push_back(read_state(body.id));
  for (const dBodyID prop : stage_.bodies()) saved_.push_back(read_state(prop));
}

void Simulation::restore() {
  std::size_t next = 0;
  for (const ModelBody& body : model_.bodies()) write_state(body.id, saved_[next++]);
  for (const dBodyID prop : stage_.bodies()) write_state(prop, saved_[next++]);
}

void Simulation::check_speeds() const {
  for (const ModelBody& body : model_.bodies()) {
    const RigidState s = read_state(body.id);
    const double speed = s.linear_velocity.norm();
    if (!(speed < kRunaway) || !s.position.allFinite() || !s.angular_velocity.allFinite() ||
        !s.rotation.coeffs().allFinite())
      throw Diverged{body.segment, time_s(), speed};
  }
  for (const dBodyID prop : stage_.bodies()) {
    const RigidState s = read_state(prop);
    if (!s.position.allFinite() || !s.linear_velocity.allFinite() || !s.rotation.coeffs().allFinite())
      throw fastest("what hits it is nowhere any more");
  }
}

/// The segment that was fastest at the end of the last good step.
Diverged Simulation::fastest(std::string how) const {
  Diverged result{Segment::pelvis, time_s(), 0.0, std::move(how)};
  for (std::size_t i = 0; i < std::min(saved_.size(), model_.bodies().size()); ++i) {
    const double speed = saved_[i].linear_velocity.norm();
    if (speed > result.speed) {
      result.segment = model_.bodies()[i].segment;
      result.speed = speed;
    }
  }
  return result;
}

void Simulation::watch_energy() {
  if (torn_ || recorder_.energy_gain_j() < most_energy_j_) return;
  torn_ = fastest(fmt::format("{:.3g} J came from nowhere", recorder_.energy_gain_j()));
}

void Simulation::watch_joints(double worst_separation) {
  if (torn_ || worst_separation < torn_apart_) return;
  const auto farthest = std::max_element(model_.joints().begin(), model_.joints().end(),
                                         [this](const ModelJoint& a, const ModelJoint& b) {
                                           return model_.separation(a) < model_.separation(b);
                                         });
  const ModelBody& child = model_.bodies()[farthest->child];
  torn_ = Diverged{child.segment, time_s(), vec3(dBodyGetLinearVel(child.id)).norm(),
                   fmt::format("it is {:.2g} m off its joint", worst_separation)};
}

std::vector<double> Simulation::joint_excesses() const {
  std::vector<double> result;
  result.reserve(model_.joints().size());
  for (const ModelJoint& joint : model_.joints()) result.push_back(excess(joint.range, model_.chart(joint)));
  return result;
}

std::vector<double> Simulation::judged_excesses() const {
  const BodyPose segments = model_.segments();
  const PerJoint<SwingTwist> charts = charts_of(*judged_, rotations_of(segments));
  std::vector<double> result;
  result.reserve(model_.joints().size());
  for (const ModelJoint& joint : model_.joints())
    result.push_back(excess(judged_->joints[index(joint.joint)], charts[index(joint.joint)]));
  return result;
}

double Simulation::worst_separation() const {
  double worst = 0.0;
  for (const ModelJoint& joint : model_.joints()) worst = std::max(worst, model_.separation(joint));
  return worst;
}

double Simulation::worst_joint_speed() const {
  double worst = 0.0;
  for (const ModelJoint& joint : model_.joints())
    worst = std::max(worst, (vec3(dBodyGetAngularVel(model_.bodies()[joint.child].id)) -
                             vec3(dBodyGetAngularVel(model_.bodies()[joint.parent].id)))
                                .norm());
  return worst;
}

/// One ODE step; once more with all rows of a joint that went beyond an edge which had none.
void Simulation::take_step(double h) {
  constexpr int kTries = 3;
  all_rows_.assign(model_.joints().size(), false);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    add_forces(h);
    collision_.touch(contacts_, {stepping_.sparse_friction, 0.8});
    dWorldStep(world_.id(), h);
    dJointGroupEmpty(world_.contacts());
    check_speeds();
    bool again = false;
    for (std::size_t j = 0; j < passive_.size(); ++j) {
      if (passive_[j].missed() <= kWorstMiss) continue;
      all_rows_[j] = true;
      again = true;
    }
    if (!again || attempt + 1 == kTries || !stepping_.adaptive) return;
    restore();
  }
}

bool Simulation::sinks(const Contacts& next) const {
  for (std::size_t p = 0; p < next.depth.size(); ++p) {
    const double growth = next.depth[p] - contacts_.depth[p];
    if (growth > kWorstSinking) return true;
    if (collision_.is_floor(p) && next.depth[p] > kFloorDepth && growth > kFloorSinking) return true;
  }
  return false;
}

bool Simulation::try_step(int ticks) {
  const double h = stepping_.tick_s * ticks;
  save();
  set_erp(h);
  take_step(h);
  std::vector<double> excesses = joint_excesses();
  const double separation = worst_separation();
  const bool can_halve = stepping_.adaptive && ticks > 1;
  const double worst = *std::max_element(excesses.begin(), excesses.end());
  if (can_halve && (separation > kWorstSeparation || worst > kWorstExcess)) {
    restore();
    return false;
  }
  if (judged_ != nullptr) excesses = judged_excesses();
  watch_joints(separation);
  const double projected = project(worst);
  check_speeds();
  Contacts next = collision_.find();
  if (can_halve && sinks(next)) {
    restore();
    return false;
  }
  accept(ticks, excesses, projected, separation, std::move(next));
  return true;
}

/// Worst excess that projection leaves.
double Simulation::project(double worst_excess) {
  if (!projecting() || worst_excess <= 0.0) return 0.0;
  model_.project();
  const std::vector<double> left = joint_excesses();
  return *std::max_element(left.begin(), left.end());
}

void Simulation::advance(int ticks) {
  if (try_step(ticks)) return;
  recorder_.rejected();
  advance(ticks / 2);
  advance(ticks / 2);
}

void Simulation::accept(int ticks, const std::vector<double>& excesses, double projected, double separation,
                        Contacts next) {
  const double h = stepping_.tick_s * ticks;
  double work = stage_.work(time_s(), h);
  for (const Tone& tone : tone_) work += tone.work(h);
  ticks_ += ticks;
  contacts_ = std::move(next);
  recorder_.excess_of_step(excesses, projected);
  recorder_.step(time_s(), h, contacts_, stage_.prop_energy(), work, separation);
  watch_energy();
  calm_steps_ = worst_joint_speed() < kCalmSpeed ? calm_steps_ + 1 : 0;
  watch_rest(ticks);
  before_ = now_;
  props_before_ = props_now_;
  now_ = model_.segments();
  props_now_ = prop_poses();
  add_frames_until(time_s());
  before_s_ = time_s();
}

void Simulation::watch_rest(int ticks) {
  double speed = 0.0;
  double turning = 0.0;
  for (const ModelBody& body : model_.bodies()) {
    speed = std::max(speed, vec3(dBodyGetLinearVel(body.id)).norm());
    turning = std::max(turning, vec3(dBodyGetAngularVel(body.id)).norm());
  }
  const double h = stepping_.tick_s * ticks;
  slow_s_ = speed < kSlowSpeed && turning < kSlowTurning ? slow_s_ + h : 0.0;
  if (slow_s_ > kSlowSpan_s && !settling_since_s_ && time_s() > settings_.tone_fade_s) {
    settling_since_s_ = time_s();
    for (Tone& tone : tone_) tone.capture();
  }
  still_s_ = speed < kRestSpeed && turning < kRestTurning ? still_s_ + h : 0.0;
  if (still_s_ < kRestSpan_s || resting_) return;
  resting_ = true;
  recorder_.rest(time_s() - still_s_);
}

/// Frames whose time lies in (before, time_s]; a frame on the step's end is the state itself.
void Simulation::add_frames_until(double time_s) {
  const double slack = 1e-6 * stepping_.tick_s;
  for (;;) {
    const double frame_s = static_cast<double>(trajectory_.frames.size()) / settings_.fps;
    if (frame_s > time_s + slack || frame_s > settings_.duration_s + slack) return;
    const double span = time_s - before_s_;
    const double u = span > 0.0 ? (frame_s - before_s_) / span : 1.0;
    const bool on_end = std::abs(frame_s - time_s) <= slack;
    trajectory_.frames.push_back(on_end ? now_ : between(before_, now_, u));
    for (std::size_t i = 0; i < props_now_.size(); ++i)
      trajectory_.props[i].poses.push_back(on_end ? props_now_[i]
                                                  : between(props_before_[i], props_now_[i], u));
  }
}

std::vector<Rigid> Simulation::prop_poses() const {
  std::vector<Rigid> poses;
  for (const dBodyID prop : stage_.bodies())
    poses.push_back({quat(dBodyGetQuaternion(prop)), vec3(dBodyGetPosition(prop))});
  return poses;
}

void Simulation::run(Diagnostics& diagnostics) {
  stage_.begin(diagnostics);
  check_speeds();
  recorder_.momentum(stage_.momentum_n_s());
  trajectory_.fps = settings_.fps;
  trajectory_.props = stage_.props();
  trajectory_.impact_point = stage_.impact_point();
  trajectory_.impact_direction = direction_;
  contacts_ = collision_.find();
  now_ = before_ = model_.segments();
  props_now_ = props_before_ = prop_poses();
  most_energy_j_ += kBlowShare * std::abs(stage_.prop_energy());
  recorder_.step(0.0, 0.0, contacts_, stage_.prop_energy(), 0.0, 0.0);
  add_frames_until(0.0);
  try {
    run_to_end();
  } catch (const OdeFailure& failure) {
    throw fastest(fmt::format("the physics engine failed: {}", failure.what()));
  }
}

void Simulation::run_to_end() {
  const long end = std::lround(std::ceil(settings_.duration_s / stepping_.tick_s - 1e-6));
  while (ticks_ < end && !(resting_ && settings_.stop_at_rest && stepping_.adaptive)) {
    const bool on_calm_grid = ticks_ % stepping_.calm_ticks == 0;
    const int ticks = calm_steps_ >= kCalmSteps && on_calm_grid ? stepping_.calm_ticks : stepping_.base_ticks;
    advance(ticks);
  }
  // At rest the pose is held to the end.
  before_ = now_;
  props_before_ = props_now_;
  before_s_ = time_s();
  add_frames_until(settings_.duration_s);
}

SimulationResult Simulation::result() {
  SimulationResult result;
  result.limits = recorder_.limits(projecting());
  result.figures = recorder_.figures();
  result.trajectory = std::move(trajectory_);
  return result;
}

}  // namespace

double tone_of(const SimulationSettings& settings) {
  return settings.tone.value_or(settings.fixed_hz > 0.0 ? 0.0 : 0.3);
}
double damping_of(const SimulationSettings& settings) {
  return settings.damping.value_or(settings.fixed_hz > 0.0 ? 0.0 : 10.0);
}

namespace {

Error error_of(const Diverged& diverged) {
  const std::string speed =
      fmt::format("the simulation diverged at {:.3f} s: {:.3g} m/s", diverged.time_s, diverged.speed);
  return {ErrorKind::simulation,
          "",
          0,
          0,
          std::string(name(diverged.segment)),
          diverged.how.empty() ? speed : fmt::format("{}, {}", speed, diverged.how),
          "use a weaker blow, a plausible --mass and --height, or --rate fixed:960"};
}

/// A run, and what came apart in it.
struct Attempt {
  Trial trial;
  std::optional<Error> torn;
};

/// Runs a scene; a run that fails leaves what it has.
Result<Attempt> try_scene(const ArticulatedBody& body, const RangeOfMotion& range,
                          const RangeOfMotion* judged, const StartState& start, const Scene& scene,
                          const SimulationSettings& settings, int refinement, Diagnostics& diagnostics) {
  if (const auto fault = fault_of(body, range, start, scene, settings)) return *fault;
  Result<ActiveThresholds> thresholds = load_active_thresholds(settings.active_file);
  if (!thresholds) return thresholds.error();
  std::unique_ptr<Simulation> simulation;
  Attempt attempt;
  Trial& trial = attempt.trial;
  try {
    static const bool look_ahead = look_ahead_works();
    if (!look_ahead && settings.limits == Limits::edges)
      return Error{ErrorKind::internal,
                   "",
                   0,
                   0,
                   "",
                   "this version of ODE does not take stops ahead as limits (StopERP -1), as 0.16.2 does",
                   "build with ODE 0.16.2, or use --limits segments"};
    simulation =
        std::make_unique<Simulation>(body, range, judged, *thresholds, start, scene, settings, refinement);
    simulation->run(diagnostics);
  } catch (const Diverged& diverged) {
    trial.failure = error_of(diverged);
  } catch (const OdeFailure& failure) {
    trial.failure = Error{ErrorKind::simulation,
                          "",
                          0,
                          0,
                          "",
                          fmt::format("the physics engine cannot begin: {}", failure.what()),
                          "use a weaker blow, or a plausible --mass and --height"};
  }
  if (!simulation) return *trial.failure;
  trial.result = simulation->result();
  trial.excesses = simulation->excesses();
  trial.simulated_s = simulation->time_s();
  if (simulation->torn()) attempt.torn = error_of(*simulation->torn());
  return attempt;
}

}  // namespace

namespace {

void warn_of_sinking(const SimulationFigures& figures, double height_m, Diagnostics& diagnostics) {
  constexpr double kWorstShare = 0.02;  // of the height
  if (figures.floor_penetration_max_m < kWorstShare * height_m) return;
  diagnostics.warn(
      "", fmt::format("the body sinks {:.2g} m into the floor: give a plausible --mass and --height, or a "
                      "higher --rate",
                      figures.floor_penetration_max_m));
}

}  // namespace

Result<SimulationResult> simulate(const ArticulatedBody& body, const RangeOfMotion& range,
                                  const StartState& start, const Scene& scene,
                                  const SimulationSettings& settings, Diagnostics& diagnostics) {
  constexpr int kRefined = 2;
  for (int refinement = 1;; refinement *= kRefined) {
    auto attempt = try_scene(body, range, nullptr, start, scene, settings, refinement, diagnostics);
    if (!attempt) return attempt.error();
    const std::optional<Error>& failure = attempt->trial.failure ? attempt->trial.failure : attempt->torn;
    if (!failure) {
      warn_of_sinking(attempt->trial.result.figures, body.height_m, diagnostics);
      return std::move(attempt->trial.result);
    }
    if (refinement == kRefined) return *failure;
    diagnostics.warn(failure->joint, failure->what + "; it is run again at twice the rate");
  }
}

Result<Trial> simulate_trial(const ArticulatedBody& body, const RangeOfMotion& range,
                             const RangeOfMotion& judged, const StartState& start, const Scene& scene,
                             const SimulationSettings& settings, Diagnostics& diagnostics) {
  auto attempt =
      try_scene(body, range, &judged == &range ? nullptr : &judged, start, scene, settings, 1, diagnostics);
  if (!attempt) return attempt.error();
  return std::move(attempt->trial);
}

}  // namespace ukemi
