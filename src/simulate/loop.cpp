#include "simulate/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/errors.h"
#include "humanoid/rotations.h"
#include "physics/physics.h"
#include "simulate/check.h"
#include "simulate/figures.h"
#include "simulate/frames.h"
#include "simulate/guarded.h"
#include "simulate/rest.h"
#include "simulate/stepping.h"

namespace ukemi {
namespace {

constexpr double kTornApart = 0.115;    // of the height: a joint whose halves are farther apart is torn
constexpr double kEarthGravity = 9.81;  // m/s^2
constexpr double kEnergyGain = 0.8;     // of mass g height: more energy without a cause is an explosion
constexpr double kBlowShare = 0.01;     // and of the energy of what hits, which no solver keeps exactly

/// One run: steps are tried, taken back and halved where they are bad, and count once accepted.
class Simulation {
 public:
  /// `judged`: range that the figures are taken against; null: the range in force.
  Simulation(const SimulationInput& input, const RangeOfMotion* judged, int refinement)
      : settings_(input.settings),
        judged_(judged),
        torn_apart_(kTornApart * input.body.height_m),
        most_energy_j_(kEnergyGain * input.body.mass_kg * kEarthGravity * input.body.height_m),
        stepping_(stepping_of(input.settings, refinement)),
        physics_(input.body, input.range, input.thresholds, input.strength, input.start, input.scene,
                 physics_settings_of(input.settings, stepping_)),
        recorder_(physics_.model(), input.settings.gravity),
        step_length_(stepping_),
        controller_(guarded(input.controller)),
        direction_(input.scene.direction) {}

  void run(Diagnostics& diagnostics);
  /// Of what has been run; takes the trajectory.
  SimulationResult result();
  const std::vector<double>& excesses() const { return recorder_.excesses(); }
  double time_s() const { return stepping_.tick_s * static_cast<double>(ticks_); }
  /// When and where a joint first came apart or energy rose without a cause; the run goes on.
  const std::optional<Diverged>& torn() const { return torn_; }

 private:
  bool projecting() const { return settings_.limits == Limits::edges; }
  FrameWriter::State state() const { return {physics_.segments(), physics_.prop_poses()}; }

  void run_to_end();
  bool ended() const;
  void advance(int ticks);
  bool try_step(int ticks);
  double project(double worst_excess);
  void accept(int ticks, const StepResult& step, double projected, Contacts next);
  void observe(double h);
  std::vector<double> judged_excesses() const;
  void watch_joints(double separation);
  void watch_energy();

  SimulationSettings settings_;
  const RangeOfMotion* judged_;
  double torn_apart_;     // m
  double most_energy_j_;  // to be gained without a cause
  Stepping stepping_;
  Physics physics_;
  Recorder recorder_;
  StepLength step_length_;
  std::unique_ptr<Controller> controller_;
  Vec3 direction_;  // of the blow
  std::optional<Diverged> torn_;
  RestWatch rest_;
  std::optional<FrameWriter> frames_;
  Goals goals_;
  Contacts contacts_;
  long ticks_ = 0;
};

void Simulation::watch_energy() {
  if (torn_ || recorder_.energy_gain_j() < most_energy_j_) return;
  torn_ = physics_.fastest(time_s(),
                           fmt::format("{:.3g} J of energy without a cause", recorder_.energy_gain_j()));
}

void Simulation::watch_joints(double separation) {
  if (!torn_ && separation >= torn_apart_) torn_ = physics_.farthest_apart(time_s(), separation);
}

std::vector<double> Simulation::judged_excesses() const {
  const PerJoint<SwingTwist> charts = charts_of(*judged_, rotations_of(physics_.segments()));
  std::vector<double> result;
  for (const ModelJoint& joint : physics_.model().joints())
    result.push_back(excess(judged_->joints[index(joint.joint)], charts[index(joint.joint)]));
  return result;
}

bool Simulation::try_step(int ticks) {
  const double h = stepping_.tick_s * ticks;
  const bool can_halve = stepping_.adaptive && ticks > 1;
  physics_.save();
  goals_.clear();
  if (controller_) controller_->drive(time_s(), goals_);
  physics_.step(time_s(), h, goals_, contacts_);
  StepResult step{physics_.joint_excesses(), physics_.worst_separation()};
  if (can_halve && step.is_bad()) {
    physics_.restore();
    return false;
  }
  const double worst = step.worst_excess();
  if (judged_ != nullptr) step.excesses = judged_excesses();
  watch_joints(step.separation_m);
  const double projected = project(worst);
  physics_.check_speeds(time_s());
  Contacts next = physics_.find_contacts();
  if (can_halve && sinks(physics_, contacts_, next)) {
    physics_.restore();
    return false;
  }
  accept(ticks, step, projected, std::move(next));
  return true;
}

/// Worst excess that projection leaves.
double Simulation::project(double worst_excess) {
  if (!projecting() || worst_excess <= 0.0) return 0.0;
  physics_.project();
  const std::vector<double> left = physics_.joint_excesses();
  return *std::max_element(left.begin(), left.end());
}

void Simulation::advance(int ticks) {
  if (try_step(ticks)) return;
  recorder_.rejected();
  advance(ticks / 2);
  advance(ticks / 2);
}

void Simulation::accept(int ticks, const StepResult& step, double projected, Contacts next) {
  const double h = stepping_.tick_s * ticks;
  const double work = physics_.accept(time_s(), h);
  ticks_ += ticks;
  contacts_ = std::move(next);
  physics_.forget_overlaps(contacts_);
  recorder_.excess_of_step(step.excesses, projected);
  recorder_.step(time_s(), h, contacts_, physics_.scene().prop_energy(), work, step.separation_m);
  recorder_.muscles(physics_.muscle_share(), physics_.muscle_work_j());
  recorder_.help(physics_.help_n_s());
  watch_energy();
  step_length_.observe(physics_.worst_joint_speed());
  observe(h);
  frames_->add(time_s(), state());
}

/// Behaviour and rest see the step.
void Simulation::observe(double h) {
  const bool rested = rest_.since_s().has_value();
  const Senses senses = physics_.senses(time_s(), contacts_);
  recorder_.touches(senses);
  recorder_.delivered(time_s(), physics_.scene().delivered_n_s(time_s()));
  if (controller_) controller_->observe(senses, h);
  rest_.observe(time_s(), h, senses.fastest_m_s, senses.fastest_turning_rad_s);
  if (!rested && rest_.since_s()) recorder_.rest(*rest_.since_s());
}

void Simulation::run(Diagnostics& diagnostics) {
  physics_.begin(diagnostics);
  const SceneProps& scene = physics_.scene();
  recorder_.momentum(scene.momentum_n_s());
  contacts_ = physics_.find_contacts();
  frames_.emplace(settings_.fps, duration_of(settings_), stepping_.tick_s, scene.props(), state());
  frames_->trajectory.impact_point = scene.impact_point();
  if (scene.is_blow()) frames_->trajectory.impact_direction = direction_;
  most_energy_j_ += kBlowShare * std::abs(scene.prop_energy());
  recorder_.step(0.0, 0.0, contacts_, scene.prop_energy(), 0.0, 0.0);
  const Senses senses = physics_.senses(0.0, contacts_);
  recorder_.touches(senses);
  if (controller_) controller_->start(senses);
  try {
    run_to_end();
  } catch (const OdeFailure&) {
    throw physics_.fastest(time_s(), "forces and masses are too far apart for the physics engine");
  }
}

bool Simulation::ended() const {
  if (controller_ && (controller_->hopeless() || controller_->over())) return true;
  const bool at_rest = rest_.since_s() && (!controller_ || controller_->done());
  return at_rest && settings_.stop_at_rest && stepping_.adaptive;
}

void Simulation::run_to_end() {
  const long end = std::lround(std::ceil(duration_of(settings_) / stepping_.tick_s - 1e-6));
  while (ticks_ < end && !ended()) advance(step_length_.next(ticks_));
  frames_->hold();
}

SimulationResult Simulation::result() {
  SimulationResult result;
  result.limits = recorder_.limits(projecting());
  result.figures = recorder_.figures();
  if (controller_) result.behaviour = controller_->report();
  if (frames_) result.trajectory = std::move(frames_->trajectory);
  return result;
}

}  // namespace

double duration_of(const SimulationSettings& settings) { return settings.duration_s.value_or(3.0); }
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
  return error_about(
      std::string(name(diverged.segment)),
      simulation_error(diverged.how.empty() ? speed : fmt::format("{}, {}", speed, diverged.how),
                       "use a weaker blow, a plausible --mass and --height, or --rate fixed:960"));
}

Error error_of(const ControllerFailure& failure, double time_s) {
  return error_about(failure.joint,
                     internal_error(fmt::format("the behaviour {} (at {:.3f} s)", failure.what, time_s),
                                    "report this with the command line; --behaviour limp does without it"));
}

/// A run, and what came apart in it.
struct Attempt {
  Trial trial;
  std::optional<Error> torn;
};

/// Runs a scene; a run that fails leaves what it has.
Result<Attempt> try_scene(const SimulationInput& input, const RangeOfMotion* judged, int refinement,
                          Diagnostics& diagnostics) {
  if (const auto fault = fault_of(input)) return *fault;
  std::unique_ptr<Simulation> simulation;
  Attempt attempt;
  Trial& trial = attempt.trial;
  try {
    static const bool look_ahead = look_ahead_works();
    if (!look_ahead && input.settings.limits == Limits::edges)
      return internal_error(
          "this version of ODE does not take stops ahead as limits (StopERP -1), as 0.16.2 does",
          "build with ODE 0.16.2, or use --limits segments");
    simulation = std::make_unique<Simulation>(input, judged, refinement);
    simulation->run(diagnostics);
  } catch (const Diverged& diverged) {
    trial.failure = error_of(diverged);
  } catch (const OdeFailure& failure) {
    trial.failure = simulation_error(fmt::format("the physics engine cannot begin: {}", failure.what()),
                                     "use a weaker blow, or a plausible --mass and --height");
  } catch (const ControllerFailure& failure) {
    trial.failure = error_of(failure, simulation ? simulation->time_s() : 0.0);
  }
  if (!simulation) return *trial.failure;
  try {
    trial.result = simulation->result();
  } catch (const ControllerFailure& failure) {
    return error_of(failure, simulation->time_s());
  }
  trial.excesses = simulation->excesses();
  trial.simulated_s = simulation->time_s();
  if (simulation->torn()) attempt.torn = error_of(*simulation->torn());
  return attempt;
}

void warn_of_sinking(const SimulationFigures& figures, double height_m, Diagnostics& diagnostics) {
  constexpr double kWorstShare = 0.02;  // of the height
  if (figures.floor_penetration_max_m < kWorstShare * height_m) return;
  diagnostics.warn(
      "", fmt::format("the body sinks {:.2g} m into the floor: give a plausible --mass and --height, or a "
                      "higher --rate",
                      figures.floor_penetration_max_m));
}

}  // namespace

Result<SimulationResult> simulate(const SimulationInput& input, Diagnostics& diagnostics) {
  constexpr int kRefined = 2;
  for (int refinement = 1;; refinement *= kRefined) {
    auto attempt = try_scene(input, nullptr, refinement, diagnostics);
    if (!attempt) return attempt.error();
    const std::optional<Error>& failure = attempt->trial.failure ? attempt->trial.failure : attempt->torn;
    if (!failure) {
      warn_of_sinking(attempt->trial.result.figures, input.body.height_m, diagnostics);
      return std::move(attempt->trial.result);
    }
    if (refinement == kRefined) return *failure;
    diagnostics.warn(failure->joint, failure->what + "; it is run again at twice the rate");
  }
}

Result<Trial> simulate_trial(const SimulationInput& input, const RangeOfMotion& judged,
                             Diagnostics& diagnostics) {
  auto attempt = try_scene(input, &judged == &input.range ? nullptr : &judged, 1, diagnostics);
  if (!attempt) return attempt.error();
  return std::move(attempt->trial);
}

}  // namespace ukemi
