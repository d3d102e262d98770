#include "physics/muscles.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kFullTorqueAt = 0.35;   // rad: error at which tone gives all its torque
constexpr double kToneDamping_s = 0.12;  // damping over stiffness
constexpr double kRise_s =
    0.2;  // from nothing to full strength (75 to 85 % of the peak after 200 ms in people)
constexpr double kStretching_rad_s = 0.05;  // speed against the torque from which a muscle is stretched
constexpr double kWellWithin = 0.9;         // share of a bound up to which it is left out
constexpr int kWarySteps = 6;               // after an expectation that was wrong
constexpr double kLeastDamping = 1e-3;      // N m s: a row needs some

/// Rotation that takes the goal to the present rotation, world, rad.
Vec3 error_to(const Model& model, const ModelJoint& joint, const Quat& parent_from_child) {
  const Quat in_bodies = model.segment_in_body(parent_of(joint.joint)).rotation * parent_from_child *
                         model.segment_in_body(child_of(joint.joint)).rotation.conjugate();
  const Quat held = orientation(model, joint.parent) * in_bodies;
  return log_rotation(orientation(model, joint.child) * held.conjugate());
}

}  // namespace

Tone::Tone(OdeWorld& world, const Model& model, const ModelJoint& joint)
    : model_(model), joint_(joint), motor_(create_motor(world, model, joint)) {}

// A spring k and damper c over a step h as a motor: CFM = 1 / (h k + c), target speed = -k e CFM. A greater
// CFM keeps the torque that this asks for below its cap; a row with a finite FMax would do so too, but costs
// ODE's solver more than one without.
void Tone::prepare(double h, const std::optional<SoftGoal>& goal) {
  rows_.clear();
  const double cap = goal ? goal->cap_n_m : 0.0;
  dJointSetAMotorNumAxes(motor_, cap > 0.0 ? 3 : 0);
  if (cap <= 0.0) return;
  const Mat3 axes = world_from_joint(model_, joint_).toRotationMatrix();
  const Vec3 error = error_to(model_, joint_, goal->parent_from_child);
  const Vec3 omega = relative_omega(model_, joint_);
  const double stiffness = cap / kFullTorqueAt;
  const double cfm = 1.0 / (stiffness * (h + kToneDamping_s));
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = axes.col(i);
    const double target = -stiffness * error.dot(axis) * cfm;
    const double speed = omega.dot(axis);
    const double row_cfm = std::max(cfm, std::abs(target - speed) / cap);
    set_row(motor_, static_cast<std::size_t>(i), {axis, target, row_cfm, unbounded()});
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

Muscle::Muscle(OdeWorld& world, const Model& model, const ModelJoint& joint, const JointStrength& strength)
    : model_(model), joint_(joint), strength_(strength), motor_(create_motor(world, model, joint)) {}

Muscle::Sum Muscle::sum_of(double h, const std::vector<JointGoal>& goals, const Mat3& axes) const {
  Sum sum;
  for (const JointGoal& goal : goals) {
    const Vec3 error = error_to(model_, joint_, goal.parent_from_child);
    const Vec3 wanted =
        goal.feed_forward_n_m - goal.stiffness_n_m_rad * error + goal.damping_n_m_s_rad * goal.velocity;
    sum.wanted += axes.transpose() * wanted;
    sum.damping += goal.damping_n_m_s_rad + h * goal.stiffness_n_m_rad;
    sum.least += goal.least_n_m;
    sum.most += goal.most_n_m;
  }
  sum.damping = std::max(sum.damping, kLeastDamping);
  return sum;
}

void Muscle::bound(double h, const Vec3& omega, Sum& sum) const {
  for (int i = 0; i < 3; ++i) {
    sum.least[i] = std::max(sum.least[i], strength_.least_n_m[i]);
    sum.most[i] = std::min(sum.most[i], strength_.most_n_m[i]);
    if (!given_) continue;
    // Growing takes time, letting go does not; nor does holding against what stretches the muscle
    // (short-range stiffness, tendons).
    const double grown = h / kRise_s;
    if (omega[i] > -kStretching_rad_s)
      sum.most[i] = std::min(sum.most[i], std::max((*given_)[i], 0.0) + grown * strength_.most_n_m[i]);
    if (omega[i] < kStretching_rad_s)
      sum.least[i] = std::max(sum.least[i], std::min((*given_)[i], 0.0) + grown * strength_.least_n_m[i]);
  }
}

// As Tone's rows, d = h k + c. A motor's bound is the same either way, a muscle's is not: the middle of its
// bounds is added outright, and the motor gives the rest.
void Muscle::prepare(double h, const std::vector<JointGoal>& goals) {
  rows_.clear();
  dJointSetAMotorNumAxes(motor_, goals.empty() ? 0 : 3);
  if (goals.empty()) return;
  const Mat3 axes =
      (orientation(model_, joint_.parent) * model_.segment_in_body(parent_of(joint_.joint)).rotation)
          .toRotationMatrix();
  Sum sum = sum_of(h, goals, axes);
  const Vec3 omega = relative_omega(model_, joint_);
  bound(h, axes.transpose() * omega, sum);
  const Vec3 middle = 0.5 * (sum.least + sum.most);
  add_torque(model_, joint_, axes * middle);
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = axes.col(i);
    const double half = 0.5 * (sum.most[i] - sum.least[i]);
    MotorRow row{axis, (sum.wanted[i] - middle[i]) / sum.damping, 1.0 / sum.damping, half};
    const double expected = (row.target - omega.dot(axis)) / row.cfm;
    if (!careful_ && std::abs(expected) < kWellWithin * half) row.most_n_m = unbounded();
    set_row(motor_, static_cast<std::size_t>(i), row);
    rows_.push_back({row, middle[i], half, omega.dot(axis)});
  }
}

bool Muscle::read() {
  torque_ = Vec3::Zero();
  if (rows_.empty()) return true;
  bool held = true;
  const Vec3 omega = relative_omega(model_, joint_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const MotorRow& row = rows_[i].motor;
    const double asked = (row.target - omega.dot(row.axis)) / row.cfm;
    held = held && (row.most_n_m < unbounded() || std::abs(asked) <= rows_[i].most_n_m);
    torque_[static_cast<int>(i)] = rows_[i].centre + std::clamp(asked, -row.most_n_m, row.most_n_m);
  }
  if (!held) careful_ = missed_ = true;
  return held;
}

void Muscle::accept() {
  given_ = torque_;
  wary_steps_ = missed_ ? kWarySteps : std::max(0, wary_steps_ - 1);
}

double Muscle::work(double h) const {
  if (rows_.empty()) return 0.0;
  const Vec3 omega = relative_omega(model_, joint_);
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i)
    sum += torque_[static_cast<int>(i)] * 0.5 * (rows_[i].speed + omega.dot(rows_[i].motor.axis)) * h;
  return sum;
}

double Muscle::share() const {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double cap = torque_[i] > 0.0 ? strength_.most_n_m[i] : -strength_.least_n_m[i];
    if (cap > 0.0) most = std::max(most, std::abs(torque_[i]) / cap);
  }
  return most;
}

}  // namespace ukemi
