#include "physics/restriction.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "physics/motor.h"

namespace ukemi {
namespace {

constexpr double kStopCfm = 1e-9;
constexpr double kClassicStopErp = 0.2;
constexpr std::size_t kRowsPerMotor = 3;

constexpr int suffixed(int parameter, std::size_t row) {
  return parameter + static_cast<int>(row) * dParamGroup;
}

double inertia_about(const Model& model, int body, const Vec3& world_axis) {
  const Vec3 axis = orientation(model, body).conjugate() * world_axis;
  return axis.dot(model.bodies()[body].inertia * axis);
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
  // Euler angles are measured from the orientations that the bodies have when the axes are set:
  // those of a = 0, alpha = 0.
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
  for (std::size_t i = 0; i < count; ++i)
    set_row(motor_, i, {acting[i].first, 0.0, 1.0 / acting[i].second, unbounded()});
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
