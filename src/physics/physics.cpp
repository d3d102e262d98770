#include "physics/physics.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kWorstMiss =
    radians(0.3);  // beyond an edge without a row: the step is taken again with all rows
constexpr double kErp = 0.8;
constexpr double kErpPerSecond = 192.0;  // ERP = min(0.8, 192 h): correction speed does not grow as h shrinks
constexpr double kCfm = 1e-9;
constexpr double kContactLayer = 0.001;  // m
constexpr double kRunaway = 100.0;       // m/s

}  // namespace

Physics::Physics(const ArticulatedBody& body, const RangeOfMotion& range, const ActiveThresholds& thresholds,
                 const MuscleStrength& strength, const StartState& start, const Scene& scene,
                 const PhysicsSettings& settings)
    : settings_(settings),
      strength_(strength),
      parts_(body.segments.begin(), body.segments.end()),
      model_(world_, body, range),
      collision_(world_, model_, body, settings.self_collision),
      scene_(world_, model_, collision_, scene, settings.gravity) {
  dWorldSetGravity(world_.id(), 0.0, -settings.gravity, 0.0);
  dWorldSetCFM(world_.id(), kCfm);
  dWorldSetContactSurfaceLayer(world_.id(), kContactLayer);
  dWorldSetContactMaxCorrectingVel(world_.id(), settings.max_correcting_speed);
  model_.place(start.segments, start.linear_velocity, start.angular_velocity);
  collision_.accept_overlaps();
  passive_.reserve(model_.joints().size());
  active_.reserve(model_.joints().size());
  for (const ModelJoint& joint : model_.joints()) {
    passive_.emplace_back(world_, model_, joint, settings.limits);
    active_.emplace_back(world_, model_, joint, settings.active, settings.active_k,
                         thresholds[index(joint.joint)]);
  }
}

void Physics::begin(Diagnostics& diagnostics) {
  scene_.begin(diagnostics);
  check_speeds(0.0);
}

void Physics::set_erp(double h) {
  if (h == erp_h_) return;
  erp_h_ = h;
  const double erp = settings_.adaptive ? std::min(kErp, kErpPerSecond * h) : kErp;
  dWorldSetERP(world_.id(), erp);
  // Ball joints copied the world's ERP when they were made.
  for (const ModelJoint& joint : model_.joints()) {
    dJointSetBallParam(joint.id, dParamERP, erp);
    dJointSetBallParam(joint.id, dParamCFM, kCfm);
  }
}

/// Tone's motors come into being together when a controller first speaks of tone, muscles' when one first
/// asks.
void Physics::make_motors(const Goals& goals) {
  const auto asked = [](const auto& joint) { return static_cast<bool>(joint); };
  if (tone_.empty() && std::any_of(goals.tone.begin(), goals.tone.end(), asked)) {
    tone_.reserve(model_.joints().size());
    for (const ModelJoint& joint : model_.joints()) tone_.emplace_back(world_, model_, joint);
  }
  const auto any = [](const std::vector<JointGoal>& joint) { return !joint.empty(); };
  if (muscles_.empty() && std::any_of(goals.joints.begin(), goals.joints.end(), any)) {
    muscles_.reserve(model_.joints().size());
    for (const ModelJoint& joint : model_.joints())
      muscles_.emplace_back(world_, model_, joint, strength_[index(joint.joint)]);
  }
}

void Physics::add_forces(double time_s, double h, const Goals& goals) {
  const double damping = std::min(settings_.damping, kMaxExplicitGain / h);
  for (std::size_t j = 0; j < model_.joints().size(); ++j) {
    const ModelJoint& joint = model_.joints()[j];
    passive_[j].prepare(h, settings_.reach, all_rows_[j]);
    active_[j].prepare(time_s >= settings_.active_delay_s);
    if (!tone_.empty()) tone_[j].prepare(h, goals.tone[index(joint.joint)]);
    if (!muscles_.empty()) muscles_[j].prepare(h, goals.joints[index(joint.joint)]);
    if (damping > 0.0) apply_damping(model_, joint, damping);
  }
  scene_.apply(time_s);
  if (!goals.help_n.isZero())
    dBodyAddForce(model_.bodies().front().id, goals.help_n.x(), goals.help_n.y(), goals.help_n.z());
}

void Physics::step(double time_s, double h, const Goals& goals, const Contacts& contacts) {
  constexpr int kTries = 3;
  set_erp(h);
  firm_soles_ = goals.firm_soles;
  help_n_ = goals.help_n;
  all_rows_.assign(model_.joints().size(), false);
  make_motors(goals);
  for (Muscle& muscle : muscles_) muscle.begin_step();
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const bool last = attempt + 1 == kTries || !settings_.adaptive;
    if (last)
      for (Muscle& muscle : muscles_) muscle.take_care();
    add_forces(time_s, h, goals);
    collision_.touch(contacts, {settings_.sparse_friction, 0.8, goals.firm_soles,
                                scene_.sole_friction(time_s), goals.glides});
    dWorldStep(world_.id(), h);
    dJointGroupEmpty(world_.contacts());
    check_speeds(time_s);
    bool again = false;
    for (std::size_t j = 0; j < passive_.size(); ++j) {
      if (passive_[j].missed() <= kWorstMiss) continue;
      all_rows_[j] = true;
      again = true;
    }
    for (Muscle& muscle : muscles_) again = !muscle.read() || again;
    if (!again || last) break;
    restore();
  }
}

void Physics::save() {
  saved_.clear();
  for (const ModelBody& body : model_.bodies()) saved_.push_back(read_state(body.id));
  for (const dBodyID prop : scene_.bodies()) saved_.push_back(read_state(prop));
}

void Physics::restore() {
  std::size_t next = 0;
  for (const ModelBody& body : model_.bodies()) write_state(body.id, saved_[next++]);
  for (const dBodyID prop : scene_.bodies()) write_state(prop, saved_[next++]);
}

double Physics::accept(double time_s, double h) {
  double work = scene_.work(time_s, h, saved_);
  help_n_s_ += h * help_n_.norm();
  const Vec3 pelvis_velocity = vec3(dBodyGetLinearVel(model_.bodies().front().id));
  work += h * help_n_.dot(0.5 * (saved_.front().linear_velocity + pelvis_velocity));
  for (const Tone& tone : tone_) work += tone.work(h);
  muscle_share_ = 0.0;
  for (Muscle& muscle : muscles_) {
    muscle.accept();
    const double done = muscle.work(h);
    work += done;
    muscle_work_ += std::abs(done);
    muscle_share_ = std::max(muscle_share_, muscle.share());
  }
  return work;
}

void Physics::check_speeds(double time_s) const {
  for (const ModelBody& body : model_.bodies()) {
    const RigidState s = read_state(body.id);
    const double speed = s.linear_velocity.norm();
    if (!(speed < kRunaway) || !s.position.allFinite() || !s.angular_velocity.allFinite() ||
        !s.rotation.coeffs().allFinite())
      throw Diverged{body.segment, time_s, speed};
  }
  for (const dBodyID prop : scene_.bodies()) {
    const RigidState s = read_state(prop);
    if (!s.position.allFinite() || !s.linear_velocity.allFinite() || !s.rotation.coeffs().allFinite())
      throw fastest(time_s, "the projectile's position is not finite");
  }
}

Diverged Physics::fastest(double time_s, std::string how) const {
  Diverged result{Segment::pelvis, time_s, 0.0, std::move(how)};
  for (std::size_t i = 0; i < std::min(saved_.size(), model_.bodies().size()); ++i) {
    const double speed = saved_[i].linear_velocity.norm();
    if (speed > result.speed) {
      result.segment = model_.bodies()[i].segment;
      result.speed = speed;
    }
  }
  return result;
}

std::vector<double> Physics::joint_excesses() const {
  std::vector<double> result;
  result.reserve(model_.joints().size());
  for (const ModelJoint& joint : model_.joints()) result.push_back(excess(joint.range, model_.chart(joint)));
  return result;
}

double Physics::worst_separation() const {
  double worst = 0.0;
  for (const ModelJoint& joint : model_.joints()) worst = std::max(worst, model_.separation(joint));
  return worst;
}

Diverged Physics::farthest_apart(double time_s, double separation) const {
  const auto farthest = std::max_element(model_.joints().begin(), model_.joints().end(),
                                         [this](const ModelJoint& a, const ModelJoint& b) {
                                           return model_.separation(a) < model_.separation(b);
                                         });
  const ModelBody& child = model_.bodies()[farthest->child];
  return {child.segment, time_s, vec3(dBodyGetLinearVel(child.id)).norm(),
          fmt::format("it is {:.2g} m off its joint", separation)};
}

double Physics::worst_joint_speed() const {
  double worst = 0.0;
  for (const ModelJoint& joint : model_.joints())
    worst = std::max(worst, relative_omega(model_, joint).norm());
  return worst;
}

Senses Physics::senses(double time_s, const Contacts& contacts) const {
  Senses senses;
  senses.time_s = time_s;
  senses.pose = model_.segments();
  double mass = 0.0;
  for (const ModelBody& body : model_.bodies()) {
    const RigidState s = read_state(body.id);
    mass += body.mass_kg;
    senses.com += body.mass_kg * s.position;
    senses.com_velocity += body.mass_kg * s.linear_velocity;
    senses.fastest_m_s = std::max(senses.fastest_m_s, s.linear_velocity.norm());
    senses.fastest_turning_rad_s = std::max(senses.fastest_turning_rad_s, s.angular_velocity.norm());
  }
  senses.com /= mass;
  senses.com_velocity /= mass;
  for (int s = 0; s < kSegmentCount; ++s) {
    const RigidState host = read_state(model_.bodies()[model_.body_of(segment_at(s))].id);
    senses.centre[s] = senses.pose[s] * parts_[s].centre_of_mass;
    senses.angular_velocity[s] = host.angular_velocity;
    senses.velocity[s] = host.linear_velocity + host.angular_velocity.cross(senses.centre[s] - host.position);
    const Quat& turned = senses.pose[s].rotation;
    senses.angular_momentum +=
        parts_[s].mass_kg * (senses.centre[s] - senses.com).cross(senses.velocity[s] - senses.com_velocity) +
        turned * (parts_[s].inertia * (turned.conjugate() * host.angular_velocity));
  }
  for (const ModelJoint& joint : model_.joints()) senses.chart[index(joint.joint)] = model_.chart(joint);
  senses.contacts = collision_.felt(contacts);
  return senses;
}

std::vector<Rigid> Physics::prop_poses() const {
  std::vector<Rigid> poses;
  for (const dBodyID prop : scene_.bodies())
    poses.push_back({quat(dBodyGetQuaternion(prop)), vec3(dBodyGetPosition(prop))});
  return poses;
}

}  // namespace ukemi
