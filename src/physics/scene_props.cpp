#include "physics/scene_props.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kTouchDepth = 0.0002;  // m: what hits starts touching
constexpr double kReach = 3.0;          // m: where the search for the first touch starts
constexpr double kRampThickness = 0.04;
constexpr double kSlippery = 0.05;  // friction of soles on an oiled floor, about
constexpr double kLongestRamp = 3.0;

void set_pose(dGeomID geom, const Vec3& at, const Quat& q) {
  const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetPosition(geom, at.x(), at.y(), at.z());
  dGeomSetQuaternion(geom, rotation);
}

/// Axes: x along `along`, z horizontal.
Quat facing(const Vec3& along) {
  const Vec3 side = along.cross(Vec3::UnitY());
  const Vec3 z = side.norm() > 1e-6 ? Vec3(side.normalized()) : Vec3(Vec3::UnitZ());
  Mat3 axes;
  axes << along, z.cross(along), z;
  return Quat(axes).normalized();
}

/// Height of the probe's centre when it lies on the floor, m.
double height_on_floor(dGeomID probe) {
  dReal box[6];
  dGeomGetAABB(probe, box);
  return dGeomGetPosition(probe)[1] - box[2];
}

}  // namespace

SceneProps::SceneProps(OdeWorld& world, Model& model, Collision& collision, const Scene& scene,
                       double gravity)
    : world_(world), model_(model), collision_(collision), scene_(scene), gravity_(gravity) {
  if (scene_.loads.empty()) scene_.loads = {{scene_.target, scene_.direction}};
}

std::optional<double> SceneProps::sole_friction(double time_s) const {
  return time_s < scene_.slippery_s ? std::optional(kSlippery) : std::nullopt;
}

void SceneProps::begin(Diagnostics& diagnostics) {
  impact_point_ = vec3(dBodyGetPosition(target().id));
  switch (scene_.kind) {
    case SceneKind::ball:
    case SceneKind::box:
      return begin_missile(diagnostics);
    case SceneKind::slope:
      return begin_slope(diagnostics);
    case SceneKind::impulse:
    case SceneKind::explosion:
      return begin_impulse();
    case SceneKind::fall:
      return begin_fall();
    case SceneKind::none:
      return;
    case SceneKind::push:
    case SceneKind::trip:
    case SceneKind::slip:
    case SceneKind::pull:
      momentum_ = scene_.push_force_n * scene_.push_duration_s;
  }
}

/// A line that leads into the floor is raised until the probe, where it first touches the body, is clear of
/// it.
std::optional<SceneProps::Meeting> SceneProps::meet(dGeomID probe, Vec3 start) const {
  constexpr int kTries = 12;
  const Vec3& along = scene_.direction;
  std::optional<Meeting> meeting;
  for (int i = 0; i < kTries; ++i) {
    const auto touch = collision_.first_touch(probe, start, along, kReach);
    if (!touch) break;
    meeting = Meeting{start + (touch->distance + kTouchDepth) * along, touch->segment};
    const double missing = height_on_floor(probe) - meeting->at.y();
    if (missing <= 0.0) break;
    start.y() += missing + kTouchDepth;
  }
  return meeting;
}

/// Aimed at the target's centre, or beside it by the scene's offset; where another segment is in the way the
/// aim moves away from it, by at most the missile's radius.
Vec3 SceneProps::aim(dGeomID probe, Diagnostics& diagnostics) const {
  constexpr int kTries = 12;
  const Vec3& along = scene_.direction;
  const Vec3 centre = vec3(dBodyGetPosition(target().id)) + scene_.aim_offset;
  const Vec3 start = centre - kReach * along;
  const auto first = meet(probe, start);
  if (!first) return centre;
  if (first->segment == scene_.target) return first->at;
  const Vec3 away = centre - vec3(dBodyGetPosition(model_.bodies()[model_.body_of(first->segment)].id));
  const Vec3 aside = (away - along.dot(away) * along).normalized();
  for (int i = 1; i <= kTries; ++i) {
    const auto other = meet(probe, start + scene_.ball_radius_m * i / kTries * aside);
    if (other && other->segment == scene_.target) return other->at;
  }
  diagnostics.warn(std::string(name(scene_.target)),
                   fmt::format("the blow meets the {} first", name(first->segment)));
  return first->at;
}

void SceneProps::launch(dGeomID geom, const Vec3& at, const Vec3& velocity, const Vec3& angular_velocity,
                        const Quat& rotation) {
  const dBodyID body = dBodyCreate(world_.id());
  const double r = scene_.ball_radius_m;
  const bool box = dGeomGetClass(geom) == dBoxClass;
  dMass mass;
  if (box)
    dMassSetBoxTotal(&mass, scene_.ball_mass_kg, 2.0 * r, 2.0 * r, 2.0 * r);
  else
    dMassSetSphereTotal(&mass, scene_.ball_mass_kg, r);
  dBodySetMass(body, &mass);
  write_state(body, {at, velocity, angular_velocity, rotation});
  collision_.add_prop(geom, body);
  bodies_.push_back(body);
  inertias_.push_back(
      {scene_.ball_mass_kg, (box ? 2.0 / 3.0 : 0.4) * scene_.ball_mass_kg * r * r * Mat3::Identity()});
  Prop prop;
  prop.kind = box ? Prop::Kind::box : Prop::Kind::ball;
  prop.radius = r;
  prop.size = Vec3::Constant(2.0 * r);
  props_.push_back(prop);
  momentum_ = scene_.ball_mass_kg * velocity.norm();
  carried_ = scene_.ball_mass_kg * scene_.direction.dot(velocity);
  impact_point_ = at + r * velocity.normalized();
}

void SceneProps::begin_missile(Diagnostics& diagnostics) {
  const double r = scene_.ball_radius_m;
  const bool box = scene_.kind == SceneKind::box;
  const dGeomID geom = box ? dCreateBox(nullptr, 2.0 * r, 2.0 * r, 2.0 * r) : dCreateSphere(nullptr, r);
  const Quat rotation = box ? facing(scene_.direction) : Quat::Identity();
  set_pose(geom, Vec3::Zero(), rotation);
  const Vec3 at = aim(geom, diagnostics);
  if (at.y() < height_on_floor(geom) - kTouchDepth)
    diagnostics.warn(std::string(name(scene_.target)), "the blow comes out of the floor");
  launch(geom, at, scene_.ball_speed_m_s * scene_.direction, Vec3::Zero(), rotation);
}

/// A ramp whose foot lies where the ball, rolling down without slipping, meets the body. From rest the ball
/// would need v^2 = 10/7 g (height); the ramp that stands there is at most 3 m long.
void SceneProps::begin_slope(Diagnostics& diagnostics) {
  const double r = scene_.ball_radius_m;
  const Vec3 flat = Vec3(scene_.direction.x(), 0.0, scene_.direction.z()).normalized();
  const Vec3 down = std::cos(scene_.slope_rad) * flat - std::sin(scene_.slope_rad) * Vec3::UnitY();
  const Vec3 normal = std::sin(scene_.slope_rad) * flat + std::cos(scene_.slope_rad) * Vec3::UnitY();
  const dGeomID ball = dCreateSphere(nullptr, r);
  Vec3 foot = vec3(dBodyGetPosition(target().id)) - flat;
  foot.y() = 0.0;
  for (int i = 0; i < 8; ++i) {
    const auto touch = collision_.first_touch(ball, foot + r * normal - kReach * down, down, 2.0 * kReach);
    if (!touch) break;
    foot += (touch->distance - kReach) * flat;
    if (i == 7 && touch->segment != scene_.target)
      diagnostics.warn(std::string(name(scene_.target)),
                       fmt::format("the ball meets the {} first", name(touch->segment)));
  }
  const double height = 0.7 * scene_.ball_speed_m_s * scene_.ball_speed_m_s / gravity_;
  const double length =
      std::clamp(height / std::sin(scene_.slope_rad), 4.0 * r, std::max(4.0 * r, kLongestRamp));
  const Vec3 centre = foot - 0.5 * length * down - 0.5 * kRampThickness * normal;
  const Vec3 size(length, kRampThickness, 6.0 * r);
  const dGeomID ramp = dCreateBox(nullptr, size.x(), size.y(), size.z());
  set_pose(ramp, centre, facing(down));
  const Vec3 axis = normal.cross(down);  // rolling without slipping: v = omega x (r normal)
  launch(ball, foot + (r - kTouchDepth) * normal + kTouchDepth * down, scene_.ball_speed_m_s * down,
         scene_.ball_speed_m_s / r * axis, Quat::Identity());
  collision_.add_prop(ramp, nullptr);
  Prop prop;
  prop.kind = Prop::Kind::box;
  prop.size = size;
  prop.moves = false;
  prop.poses = {{facing(down), centre}};
  props_.push_back(prop);
}

void SceneProps::begin_impulse() {
  for (const Load& load : scene_.loads) {
    const ModelBody& body = body_of(load.segment);
    RigidState state = read_state(body.id);
    state.linear_velocity += scene_.impulse_n_s / body.mass_kg * load.way;
    write_state(body.id, state);
  }
  momentum_ = scene_.impulse_n_s;
}

/// Turns the whole body about the ground below its centre of mass, and lifts it.
void SceneProps::begin_fall() {
  Vec3 centre = Vec3::Zero();
  double mass = 0.0;
  for (const ModelBody& body : model_.bodies()) {
    centre += body.mass_kg * vec3(dBodyGetPosition(body.id));
    mass += body.mass_kg;
  }
  centre /= mass;
  const Vec3 flat = Vec3(scene_.direction.x(), 0.0, scene_.direction.z()).normalized();
  const Vec3 omega = scene_.tip_speed_m_s / std::max(centre.y(), 0.1) * Vec3::UnitY().cross(flat);
  const Vec3 pivot(centre.x(), 0.0, centre.z());
  for (const ModelBody& body : model_.bodies()) {
    RigidState state = read_state(body.id);
    state.linear_velocity += omega.cross(state.position - pivot);
    state.angular_velocity += omega;
    state.position.y() += scene_.fall_height_m;
    write_state(body.id, state);
  }
  momentum_ = mass * scene_.tip_speed_m_s;
  impact_point_ = centre + scene_.fall_height_m * Vec3::UnitY();
}

void SceneProps::apply(double time_s) const {
  if (!pushing(time_s)) return;
  for (const Load& load : scene_.loads) {
    const Vec3 force = scene_.push_force_n * load.way;
    dBodyAddForce(body_of(load.segment).id, force.x(), force.y(), force.z());
  }
}

double SceneProps::work(double time_s, double h, const std::vector<RigidState>& before) const {
  if (!pushing(time_s)) return 0.0;
  double work = 0.0;
  for (const Load& load : scene_.loads) {
    const Vec3 start = before[static_cast<std::size_t>(model_.body_of(load.segment))].linear_velocity;
    const Vec3 end = vec3(dBodyGetLinearVel(body_of(load.segment).id));
    work += h * scene_.push_force_n * load.way.dot(0.5 * (start + end));
  }
  return work;
}

double SceneProps::delivered_n_s(double time_s) const {
  if (is_push(scene_.kind)) return scene_.push_force_n * std::min(time_s, scene_.push_duration_s);
  if (bodies_.empty()) return momentum_;
  return carried_ -
         inertias_.front().mass_kg * scene_.direction.dot(vec3(dBodyGetLinearVel(bodies_.front())));
}

double SceneProps::prop_energy() const {
  double energy = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const RigidState state = read_state(bodies_[i]);
    energy += kinetic_energy(inertias_[i].mass_kg, inertias_[i].tensor, state) +
              inertias_[i].mass_kg * gravity_ * state.position.y();
  }
  return energy;
}

}  // namespace ukemi
