// Behaviours that throw, ask for no numbers or for absurd ones: an error that names joint and time, and
// nothing of it in the next run.
#include "simulate/guarded.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "behave/tone.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFailsAt_s = 0.1;

/// Does nothing until 0.1 s, then what it was made for.
class Faulty : public Controller {
 public:
  enum class In { start, observe, drive, done, report };
  Faulty(In where, std::function<void(Goals&)> act) : where_(where), act_(std::move(act)) {}

  void start(const Senses&) override { act(In::start); }
  void observe(const Senses& senses, double) override {
    time_s_ = senses.time_s;
    if (time_s_ >= kFailsAt_s) act(In::observe);
  }
  void drive(double time_s, Goals& goals) const override {
    if (where_ == In::drive && time_s >= kFailsAt_s) act_(goals);
  }
  bool done() const override {
    act(In::done);
    return true;
  }
  ControllerReport report() const override {
    act(In::report);
    return {};
  }

 private:
  void act(In where) const {
    Goals goals;
    if (where == where_) act_(goals);
  }

  In where_;
  std::function<void(Goals&)> act_;
  double time_s_ = 0.0;
};

/// A standing man with such a behaviour, for half a second.
Result<SimulationResult> run_with(MakeController make, Diagnostics& diagnostics) {
  const test::StandingMan man;
  const auto thresholds = load_active_thresholds("");
  const auto strength = muscle_strength(man.body, Sex::male, 1.0);
  EXPECT_TRUE(thresholds && strength);
  Scene scene;
  scene.kind = SceneKind::none;
  scene.direction = Vec3::UnitX();
  SimulationSettings settings;
  settings.duration_s = 0.5;
  settings.stop_at_rest = false;
  return simulate(
      {man.body, man.range, *thresholds, *strength, man.start(), scene, settings, std::move(make)},
      diagnostics);
}

Result<SimulationResult> run_with(Faulty::In where, const std::function<void(Goals&)>& act) {
  Diagnostics diagnostics;
  return run_with([&] { return std::make_unique<Faulty>(where, act); }, diagnostics);
}

TEST(GuardedBehaviour, OneThatThrowsIsAnErrorWhereverItThrows) {
  using In = Faulty::In;
  for (const In where : {In::start, In::observe, In::drive, In::report}) {
    const auto result = run_with(where, [](Goals&) { throw std::runtime_error("no legs"); });
    ASSERT_FALSE(result) << static_cast<int>(where);
    EXPECT_EQ(result.error().kind, ErrorKind::internal);
    EXPECT_TRUE(result.error().what.starts_with("the behaviour fails: no legs (at ")) << result.error().what;
    EXPECT_NE(result.error().fix.find("--behaviour limp"), std::string::npos);
  }
  const auto silent = run_with(In::drive, [](Goals&) { throw 42; });
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().what, "the behaviour fails and does not say why (at 0.100 s)");
}

TEST(GuardedBehaviour, OneThatCannotBeMadeIsAnError) {
  Diagnostics diagnostics;
  const auto result = run_with(
      []() -> std::unique_ptr<Controller> { throw std::out_of_range("no such posture"); }, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().what, "the behaviour fails: no such posture (at 0.000 s)");
  const auto none = run_with([]() -> std::unique_ptr<Controller> { return nullptr; }, diagnostics);
  EXPECT_TRUE(none) << none.error().message();
}

/// A fault of one goal at the left knee, and what is said of it.
struct BadGoal {
  const char* name;
  std::function<void(JointGoal&)> spoil;
  const char* what;
};

TEST(GuardedBehaviour, GoalsOfNoNumberOrAbsurdOnesAreAnErrorWithJointAndTime) {
  const BadGoal bad[] = {
      {"rotation of no number", [](JointGoal& g) { g.parent_from_child.coeffs().setConstant(kNan); },
       "asks for a rotation that is not finite or not of unit length"},
      {"rotation of length 2", [](JointGoal& g) { g.parent_from_child.coeffs() *= 2.0; },
       "asks for a rotation that is not finite or not of unit length"},
      {"velocity of no number", [](JointGoal& g) { g.velocity.x() = kNan; },
       "asks for a velocity that is not finite or beyond all bounds"},
      {"absurd velocity", [](JointGoal& g) { g.velocity.y() = 1e30; },
       "asks for a velocity that is not finite or beyond all bounds"},
      {"torque of no number", [](JointGoal& g) { g.feed_forward_n_m.z() = kNan; },
       "asks for a torque that is not finite or beyond all bounds"},
      {"absurd torque", [](JointGoal& g) { g.feed_forward_n_m.z() = -1e300; },
       "asks for a torque that is not finite or beyond all bounds"},
      {"bound without end", [](JointGoal& g) { g.most_n_m.x() = kInfinity; },
       "asks for a torque that is not finite or beyond all bounds"},
      {"stiffness of no number", [](JointGoal& g) { g.stiffness_n_m_rad = kNan; },
       "asks for a stiffness or damping that is not finite or beyond all bounds"},
      {"absurd damping", [](JointGoal& g) { g.damping_n_m_s_rad = 1e12; },
       "asks for a stiffness or damping that is not finite or beyond all bounds"},
      {"damping below 0", [](JointGoal& g) { g.damping_n_m_s_rad = -1.0; },
       "asks for a stiffness or damping below 0"},
      {"bounds the wrong way", [](JointGoal& g) { std::swap(g.least_n_m, g.most_n_m); },
       "asks for a least torque above the most"},
  };
  for (const BadGoal& fault : bad) {
    const auto result = run_with(Faulty::In::drive, [&](Goals& goals) {
      JointGoal goal{.stiffness_n_m_rad = 100.0, .damping_n_m_s_rad = 10.0};
      goal.least_n_m.setConstant(-50.0);
      goal.most_n_m.setConstant(50.0);
      fault.spoil(goal);
      goals.joints[index(Joint::knee_l)].push_back(goal);
    });
    ASSERT_FALSE(result) << fault.name;
    EXPECT_EQ(result.error().kind, ErrorKind::internal) << fault.name;
    EXPECT_EQ(result.error().joint, "knee_l") << fault.name;
    EXPECT_EQ(result.error().what, std::string("the behaviour ") + fault.what + " (at 0.100 s)");
  }
}

TEST(GuardedBehaviour, ToneAndHelpOfNoNumberAreErrorsToo) {
  const auto tone = run_with(Faulty::In::drive, [](Goals& goals) {
    goals.tone[index(Joint::neck)] = SoftGoal{Quat::Identity(), kNan};
  });
  ASSERT_FALSE(tone);
  EXPECT_EQ(tone.error().joint, "neck");
  const auto help = run_with(Faulty::In::drive, [](Goals& goals) { goals.help_n.y() = kInfinity; });
  ASSERT_FALSE(help);
  EXPECT_EQ(help.error().what,
            "the behaviour asks for help that is not finite or beyond all bounds (at 0.100 s)");
}

TEST(GuardedBehaviour, AFailureIsRunAgainOnceWithAWarningAndLeavesNothingBehind) {
  const auto calm = [] { return run_with(Faulty::In::drive, [](Goals&) {}); };
  const std::string before = calm()->figures.hash;
  int made = 0;
  Diagnostics diagnostics;
  const auto result = run_with(
      [&] {
        return std::make_unique<Faulty>(Faulty::In::drive, [again = made++ > 0](Goals& goals) {
          if (!again) goals.help_n.x() = kNan;
        });
      },
      diagnostics);
  EXPECT_TRUE(result) << result.error().message();
  EXPECT_EQ(made, 2);
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("it is run again at twice the rate"), std::string::npos);
  EXPECT_EQ(calm()->figures.hash, before);
}

TEST(GuardedBehaviour, HelpIsToldAsForceTimesTime) {
  const auto result = run_with(Faulty::In::drive, [](Goals& goals) { goals.help_n = Vec3(30.0, 40.0, 0.0); });
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_NEAR(result->figures.help_n_s, 50.0 * 0.4, 0.5);  // from 0.1 to 0.5 s
}

/// The strongest that a joint can do is all that comes of a goal that wants more.
TEST(GuardedBehaviour, WhatNoPersonCouldDoIsCutToWhatThisOneCan) {
  const auto result = run_with(Faulty::In::drive, [](Goals& goals) {
    JointGoal goal{.feed_forward_n_m = Vec3(0.0, 0.0, 1e6), .damping_n_m_s_rad = 1.0};
    goal.least_n_m.setConstant(-1e6);
    goal.most_n_m.setConstant(1e6);
    goals.joints[index(Joint::elbow_l)].push_back(goal);
  });
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_LE(result->figures.muscle_share_max, 1.0 + 1e-9);
  EXPECT_GT(result->figures.muscle_share_max, 0.9);
  EXPECT_EQ(result->limits.over_1deg, 0);
}

}  // namespace
}  // namespace ukemi
