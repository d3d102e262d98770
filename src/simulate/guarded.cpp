#include "simulate/guarded.h"

#include <cmath>
#include <exception>
#include <utility>

namespace ukemi {
namespace {

constexpr double kHuge = 1e9;
constexpr double kUnit = 1e-6;  // of a quaternion's length

bool sane(double value) { return std::abs(value) <= kHuge; }
bool sane(const Vec3& v) { return sane(v.x()) && sane(v.y()) && sane(v.z()); }
bool sane(const Quat& q) { return std::abs(q.norm() - 1.0) <= kUnit; }

/// What is wrong with a goal, or null.
const char* fault(const JointGoal& goal) {
  if (!sane(goal.parent_from_child)) return "asks for a rotation that is not finite or not of unit length";
  if (!sane(goal.velocity)) return "asks for a velocity that is not finite or beyond all bounds";
  if (!sane(goal.feed_forward_n_m) || !sane(goal.least_n_m) || !sane(goal.most_n_m))
    return "asks for a torque that is not finite or beyond all bounds";
  if (!sane(goal.stiffness_n_m_rad) || !sane(goal.damping_n_m_s_rad))
    return "asks for a stiffness or damping that is not finite or beyond all bounds";
  if (goal.stiffness_n_m_rad < 0.0 || goal.damping_n_m_s_rad < 0.0)
    return "asks for a stiffness or damping below 0";
  if ((goal.least_n_m.array() > goal.most_n_m.array()).any()) return "asks for a least torque above the most";
  return nullptr;
}

const char* fault(const SoftGoal& goal) {
  if (!sane(goal.parent_from_child)) return "asks for a rotation that is not finite or not of unit length";
  if (!sane(goal.cap_n_m) || goal.cap_n_m < 0.0)
    return "asks for a torque that is not finite or beyond all bounds";
  return nullptr;
}

/// What `call` gives. Throws ControllerFailure where it throws.
template <typename Call>
auto guard(Call call) {
  try {
    return call();
  } catch (const std::exception& exception) {
    throw ControllerFailure{"", std::string("fails: ") + exception.what()};
  } catch (...) {
    throw ControllerFailure{"", "fails and does not say why"};
  }
}

class Guarded : public Controller {
 public:
  explicit Guarded(std::unique_ptr<Controller> inner) : inner_(std::move(inner)) {}

  void start(const Senses& senses) override {
    guard([&] { inner_->start(senses); });
  }
  void observe(const Senses& senses, double h) override {
    guard([&] { inner_->observe(senses, h); });
  }
  void drive(double time_s, Goals& goals) const override {
    guard([&] { inner_->drive(time_s, goals); });
    if (auto failure = fault_of(goals)) throw std::move(*failure);
  }
  bool done() const override {
    return guard([&] { return inner_->done(); });
  }
  bool over() const override {
    return guard([&] { return inner_->over(); });
  }
  bool hopeless() const override {
    return guard([&] { return inner_->hopeless(); });
  }
  ControllerReport report() const override {
    return guard([&] { return inner_->report(); });
  }

 private:
  std::unique_ptr<Controller> inner_;
};

}  // namespace

std::optional<ControllerFailure> fault_of(const Goals& goals) {
  for (int j = 0; j < kJointCount; ++j) {
    const std::string joint(name(joint_at(j)));
    for (const JointGoal& goal : goals.joints[j])
      if (const char* what = fault(goal)) return ControllerFailure{joint, what};
    if (goals.tone[j])
      if (const char* what = fault(*goals.tone[j])) return ControllerFailure{joint, what};
  }
  if (!sane(goals.help_n))
    return ControllerFailure{"", "asks for help that is not finite or beyond all bounds"};
  return std::nullopt;
}

std::unique_ptr<Controller> guarded(const MakeController& make) {
  if (!make) return nullptr;
  auto inner = guard([&] { return make(); });
  return inner ? std::make_unique<Guarded>(std::move(inner)) : nullptr;
}

}  // namespace ukemi
