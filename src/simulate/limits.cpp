#include "simulate/limits.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kStopCfm = 1e-9;
constexpr double kClassicStopErp = 0.2;
constexpr std::size_t kRowsPerMotor = 3;

constexpr int suffixed(int parameter, std::size_t row) {
  return parameter + static_cast<int>(row) * dParamGroup;
}

Quat orientation(const Model& model, int body) { return quat(dBodyGetQuaternion(model.bodies()[body].id)); }

/// World axes of the joint frame.
Quat world_from_joint(const Model& model, const ModelJoint& joint) {
  return orientation(model, joint.parent) * joint.parent_from_joint;
}

Vec3 relative_omega(const Model& model, const ModelJoint& joint) {
  return vec3(dBodyGetAngularVel(model.bodies()[joint.child].id)) -
         vec3(dBodyGetAngularVel(model.bodies()[joint.parent].id));
}

double inertia_about(const Model& model, int body, const Vec3& world_axis) {
  const Vec3 axis = orientation(model, body).conjugate() * world_axis;
  return axis.dot(model.bodies()[body].inertia * axis);
}

void add_torque(const Model& model, const ModelJoint& joint, const Vec3& torque) {
  dBodyAddTorque(model.bodies()[joint.child].id, torque.x(), torque.y(), torque.z());
  dBodyAddTorque(model.bodies()[joint.parent].id, -torque.x(), -torque.y(), -torque.z());
}

/// A motor whose angles grow with the child's rotation relative to the parent.
dJointID create_motor(OdeWorld& world, const Model& model, const ModelJoint& joint) {
  const dJointID motor = dJointCreateAMotor(world.id(), nullptr);
  dJointAttach(motor, model.bodies()[joint.child].id, model.bodies()[joint.parent].id);
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, 0);
  return motor;
}

void set_axis(dJointID motor, std::size_t row, const Vec3& axis) {
  dJointSetAMotorAxis(motor, static_cast<int>(row), 0, axis.x(), axis.y(), axis.z());
}

/// One-sided stop `distance` ahead (or behind, when negative) along `axis` of length |axis|.
void set_look_ahead(dJointID motor, std::size_t row, const Vec3& axis, double distance) {
  const double length = axis.norm();
  set_axis(motor, row, axis / length);
  dJointSetAMotorAngle(motor, static_cast<int>(row), std::abs(distance) / length);
  dJointSetAMotorParam(motor, suffixed(dParamLoStop, row), -dInfinity);
  dJointSetAMotorParam(motor, suffixed(dParamHiStop, row), 0.0);
  dJointSetAMotorParam(motor, suffixed(dParamStopERP, row), distance >= 0.0 ? -1.0 : 1.0);
  dJointSetAMotorParam(motor, suffixed(dParamStopCFM, row), kStopCfm);
}

}  // namespace

PassiveLimit::PassiveLimit(OdeWorld& world, const Model& model, const ModelJoint& joint, Limits kind)
    : world_(world), model_(model), joint_(joint), kind_(kind) {
  if (kind != Limits::axis && kind != Limits::segments_euler) return;
  // Euler angles are measured from the orientations that the bodies have when the axes are set: those of a =
  // 0, alpha = 0.
  const dBodyID child = model.bodies()[joint.child].id;
  const RigidState state = read_state(child);
  const Quat frame = world_from_joint(model, joint);
  set_quaternion(child, (frame * joint.joint_from_child_neutral.conjugate()).normalized());
  const dJointID euler = motor(0);
  const Vec3 link = frame * Vec3::UnitX();
  const Vec3 up = frame * Vec3::UnitZ();
  dJointSetAMotorMode(euler, dAMotorEuler);
  dJointSetAMotorAxis(euler, 0, 1, link.x(), link.y(), link.z());
  dJointSetAMotorAxis(euler, 2, 2, up.x(), up.y(), up.z());
  for (std::size_t row = 0; row < kRowsPerMotor; ++row) {
    dJointSetAMotorParam(euler, suffixed(dParamStopERP, row), kClassicStopErp);
    dJointSetAMotorParam(euler, suffixed(dParamStopCFM, row), kStopCfm);
  }
  write_state(child, state);
}

dJointID PassiveLimit::motor(std::size_t i) {
  while (motors_.size() <= i) motors_.push_back(create_motor(world_, model_, joint_));
  return motors_[i];
}

void PassiveLimit::prepare(double h, const Reach& reach, bool all) {
  switch (kind_) {
    case Limits::edges:
      return prepare_edges(h, reach, all);
    case Limits::segments:
      return prepare_chords();
    case Limits::axis:
    case Limits::segments_euler:
      return prepare_euler();
    case Limits::none:
      return;
  }
}

void PassiveLimit::prepare_edges(double h, const Reach& reach, bool all) {
  const SwingTwist chart = model_.chart(joint_);
  edge_rows(joint_.range, chart, rows_);
  const Quat frame = world_from_joint(model_, joint_);
  const Vec3 omega = frame.conjugate() * relative_omega(model_, joint_);
  present_.clear();
  for (const LimitRow& row : rows_)
    if (all || row.distance < reach.margin + reach.steps * h * std::max(0.0, row.row.dot(omega)))
      present_.push_back({frame * row.row, row.distance});
  complete_ = present_.size() == rows_.size();
  set_rows(present_);
}

void PassiveLimit::set_rows(const std::vector<LimitRow>& rows) {
  const std::size_t needed = (rows.size() + kRowsPerMotor - 1) / kRowsPerMotor;
  for (std::size_t m = 0; m < std::max(needed, motors_.size()); ++m) {
    const std::size_t first = m * kRowsPerMotor;
    const std::size_t count = first < rows.size() ? std::min(kRowsPerMotor, rows.size() - first) : 0;
    dJointSetAMotorNumAxes(motor(m), static_cast<int>(count));
    for (std::size_t i = 0; i < count; ++i)
      set_look_ahead(motor(m), i, rows[first + i].row, rows[first + i].distance);
  }
}

// Figure 4 with the rows that the chart's own gradient gives: stops on a_y, a_z and alpha.
void PassiveLimit::prepare_chords() {
  const SwingTwist chart = model_.chart(joint_);
  const ChordStops stops = chord_stops(joint_.range, chart);
  const Quat frame = world_from_joint(model_, joint_);
  const std::array<Vec3, 3> axes = {swing_row(chart, Vec2(1, 0)), swing_row(chart, Vec2(0, 1)),
                                    twist_row(chart)};
  const std::array<double, 3> angles = {chart.swing.x(), chart.swing.y(), chart.twist};
  const std::array<std::array<double, 2>, 3> bounds = {
      stops.a_y, stops.a_z, {joint_.range.twist_min, joint_.range.twist_max}};
  const dJointID id = motor(0);
  dJointSetAMotorNumAxes(id, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = axes[i].norm();
    set_axis(id, i, frame * axes[i] / length);
    dJointSetAMotorAngle(id, static_cast<int>(i), angles[i] / length);
    dJointSetAMotorParam(id, suffixed(dParamLoStop, i), bounds[i][0] / length);
    dJointSetAMotorParam(id, suffixed(dParamHiStop, i), bounds[i][1] / length);
    dJointSetAMotorParam(id, suffixed(dParamStopERP, i), kClassicStopErp);
    dJointSetAMotorParam(id, suffixed(dParamStopCFM, i), kStopCfm);
  }
}

// Stops on the Euler angles alpha (about the child's x), a_y and a_z (about the parent's z): fixed ones from
// the polygon's bounding box, or each step's chords.
void PassiveLimit::prepare_euler() {
  std::array<double, 2> a_y{0.0, 0.0};
  std::array<double, 2> a_z{0.0, 0.0};
  if (kind_ == Limits::segments_euler) {
    const ChordStops stops = chord_stops(joint_.range, model_.chart(joint_));
    a_y = stops.a_y;
    a_z = stops.a_z;
  } else {
    for (const Vec2& corner : joint_.range.polygon) {
      a_y = {std::min(a_y[0], corner.x()), std::max(a_y[1], corner.x())};
      a_z = {std::min(a_z[0], corner.y()), std::max(a_z[1], corner.y())};
    }
  }
  const std::array<std::array<double, 2>, 3> bounds = {
      std::array<double, 2>{joint_.range.twist_min, joint_.range.twist_max}, a_y, a_z};
  for (std::size_t i = 0; i < 3; ++i) {
    dJointSetAMotorParam(motors_[0], suffixed(dParamLoStop, i), bounds[i][0]);
    dJointSetAMotorParam(motors_[0], suffixed(dParamHiStop, i), bounds[i][1]);
  }
}

double PassiveLimit::missed() const {
  return kind_ == Limits::edges && !complete_ ? excess(joint_.range, model_.chart(joint_)) : 0.0;
}

ActiveLimit::ActiveLimit(OdeWorld& world, const Model& model, const ModelJoint& joint, Active kind, double k,
                         const Vec3& threshold)
    : model_(model), joint_(joint), kind_(kind), k_(k), threshold_(threshold) {
  if (kind_ == Active::implicit) motor_ = create_motor(world, model, joint);
}

void ActiveLimit::prepare(bool enabled) {
  if (kind_ == Active::off) return;
  const Vec2 swing = model_.chart(joint_).swing;
  const Quat frame = world_from_joint(model_, joint_) * exp_rotation(Vec3(0.0, swing.x(), swing.y()));
  const Vec3 omega = relative_omega(model_, joint_);
  const std::array<Vec3, 3> axes = {frame * Vec3::UnitY(), frame * Vec3::UnitZ(), frame * Vec3::UnitX()};
  std::size_t count = 0;
  std::array<std::pair<Vec3, double>, 3> acting;
  for (int i = 0; i < 3 && enabled; ++i)
    if (std::abs(omega.dot(axes[i])) > threshold_[i])
      acting[count++] = {axes[i], k_ * inertia_about(model_, joint_.child, axes[i])};
  if (kind_ == Active::explicit_torque) {
    for (std::size_t i = 0; i < count; ++i)
      add_torque(model_, joint_, -acting[i].second * omega.dot(acting[i].first) * acting[i].first);
    return;
  }
  dJointSetAMotorNumAxes(motor_, static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    set_axis(motor_, i, acting[i].first);
    dJointSetAMotorParam(motor_, suffixed(dParamVel, i), 0.0);
    dJointSetAMotorParam(motor_, suffixed(dParamFMax, i), dInfinity);
    dJointSetAMotorParam(motor_, suffixed(dParamCFM, i), 1.0 / acting[i].second);
  }
}

namespace {

constexpr double kFullTorqueAt = 0.35;   // rad: error at which a joint gives all its torque
constexpr double kToneDamping_s = 0.12;  // damping over stiffness

/// What a man's joint can give, N m: isometric maxima of adult men, the weaker direction (dynamometry; neck,
/// trunk, shoulder and elbow are rough).
double joint_torque(Joint joint) {
  switch (joint) {
    case Joint::spine:
      return 200.0;
    case Joint::chest:
      return 150.0;
    case Joint::neck:
      return 30.0;
    case Joint::clavicle_l:
    case Joint::clavicle_r:
    case Joint::shoulder_l:
    case Joint::shoulder_r:
      return 60.0;
    case Joint::elbow_l:
    case Joint::elbow_r:
      return 45.0;
    case Joint::wrist_l:
    case Joint::wrist_r:
      return 10.0;
    case Joint::hip_l:
    case Joint::hip_r:
      return 150.0;
    case Joint::knee_l:
    case Joint::knee_r:
      return 150.0;
    case Joint::ankle_l:
    case Joint::ankle_r:
      break;
  }
  return 60.0;
}

}  // namespace

Tone::Tone(OdeWorld& world, const Model& model, const ModelJoint& joint, double strength)
    : model_(model), joint_(joint), torque_(strength * joint_torque(joint.joint)) {
  if (torque_ > 0.0) motor_ = create_motor(world, model, joint);
  capture();
}

void Tone::capture() {
  parent_from_child_ = orientation(model_, joint_.parent).conjugate() * orientation(model_, joint_.child);
}

// A spring k and damper c over a step h as a motor: CFM = 1 / (h k + c), target speed = -k e CFM. A greater
// CFM keeps the torque that this asks for below its cap; a row with a finite FMax would do so too, but costs
// ODE's solver many times as much as one without.
void Tone::prepare(double h, double share) {
  if (motor_ == nullptr) return;
  rows_.clear();
  dJointSetAMotorNumAxes(motor_, share > 0.0 ? 3 : 0);
  if (share <= 0.0) return;
  const Mat3 axes = world_from_joint(model_, joint_).toRotationMatrix();
  const Quat held = orientation(model_, joint_.parent) * parent_from_child_;
  const Vec3 error = log_rotation(orientation(model_, joint_.child) * held.conjugate());
  const Vec3 omega = relative_omega(model_, joint_);
  const double cap = share * torque_;
  const double stiffness = cap / kFullTorqueAt;
  const double cfm = 1.0 / (stiffness * (h + kToneDamping_s));
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = axes.col(i);
    const auto row = static_cast<std::size_t>(i);
    const double target = -stiffness * error.dot(axis) * cfm;
    set_axis(motor_, row, axis);
    const double speed = omega.dot(axis);
    const double row_cfm = std::max(cfm, std::abs(target - speed) / cap);
    dJointSetAMotorParam(motor_, suffixed(dParamVel, row), target);
    dJointSetAMotorParam(motor_, suffixed(dParamFMax, row), dInfinity);
    dJointSetAMotorParam(motor_, suffixed(dParamCFM, row), row_cfm);
    rows_.push_back({axis, target, row_cfm, speed});
  }
}

double Tone::work(double h) const {
  if (rows_.empty()) return 0.0;
  const Vec3 omega = relative_omega(model_, joint_);
  double sum = 0.0;
  for (const Row& row : rows_) {
    const double speed = omega.dot(row.axis);
    sum += (row.target - speed) / row.cfm * 0.5 * (row.speed + speed) * h;
  }
  return sum;
}

void apply_damping(const Model& model, const ModelJoint& joint, double k) {
  const Vec3 omega = relative_omega(model, joint);
  const double speed = omega.norm();
  if (speed < 1e-9) return;
  const Vec3 axis = omega / speed;
  const double inertia =
      std::min(inertia_about(model, joint.child, axis), inertia_about(model, joint.parent, axis));
  add_torque(model, joint, -k * inertia * omega);
}

bool look_ahead_works() {
  constexpr double kStep = 1.0 / 240.0;
  constexpr double kDistance = 0.01;
  OdeWorld world;
  const dBodyID body = dBodyCreate(world.id());
  dBodySetAngularVel(body, 0.0, 10.0, 0.0);  // would turn by 0.042 rad in the step
  const dJointID motor = dJointCreateAMotor(world.id(), nullptr);
  dJointAttach(motor, body, nullptr);
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, 1);
  set_look_ahead(motor, 0, Vec3::UnitY(), kDistance);
  dWorldSetCFM(world.id(), 1e-9);
  dWorldStep(world.id(), kStep);
  return std::abs(dBodyGetAngularVel(body)[1] * kStep - kDistance) < 1e-6;
}

}  // namespace ukemi
