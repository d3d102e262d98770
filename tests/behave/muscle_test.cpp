// Muscles: caps by human strength that hold for the sum of all that is asked, growth in human time.
#include <gtest/gtest.h>

#include "body/muscles.h"
#include "physics/physics.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

MuscleStrength strength_of(const ArticulatedBody& body, Sex sex, double share) {
  const auto strength = muscle_strength(body, sex, share);
  EXPECT_TRUE(strength) << strength.error().message();
  return strength ? *strength : MuscleStrength{};
}

Physics physics_of(const test::StandingMan& man, const MuscleStrength& strength) {
  Scene scene;
  scene.kind = SceneKind::none;
  scene.direction = Vec3::UnitX();
  PhysicsSettings settings;
  settings.gravity = 0.0;
  return Physics(man.body, man.range, *load_active_thresholds(""), strength, man.start(), scene, settings);
}

JointGoal pull(double n_m) {
  JointGoal goal;
  goal.feed_forward_n_m = Vec3(0.0, 0.0, n_m);
  goal.least_n_m.setConstant(-1e6);
  goal.most_n_m.setConstant(1e6);
  return goal;
}

/// Share of the hip's strength after some steps of the same goals.
double share_after(const std::vector<JointGoal>& goals, int steps) {
  const test::StandingMan man;
  Physics physics = physics_of(man, strength_of(man.body, Sex::male, 1.0));
  Goals asked;
  asked.joints[index(Joint::hip_r)] = {pull(0.0)};
  for (int i = 0; i < steps; ++i) {
    physics.save();
    physics.step(i * kStep_s, kStep_s, asked, physics.find_contacts());
    physics.accept(i * kStep_s, kStep_s);
    asked.joints[index(Joint::hip_r)] = goals;
  }
  return physics.muscle_share();
}

TEST(Muscles, GiveNoMoreThanTheirStrengthForTheSumOfAllGoals) {
  EXPECT_LE(share_after({pull(5000.0)}, 60), 1.0 + 1e-9);
  EXPECT_LE(share_after({pull(120.0), pull(120.0), pull(120.0)}, 60), 1.0 + 1e-9);
  EXPECT_GT(share_after({pull(120.0), pull(120.0), pull(120.0)}, 60), 0.99);
}

TEST(Muscles, GiveWhatIsAskedBelowThat) {
  const test::StandingMan man;
  const double most = strength_of(man.body, Sex::male, 1.0)[index(Joint::hip_r)].most_n_m.z();
  EXPECT_NEAR(share_after({pull(0.1 * most)}, 30), 0.1, 0.01);
}

TEST(Muscles, TakeTheirTimeToGrow) {
  // From nothing to everything in 0.2 s.
  EXPECT_NEAR(share_after({pull(5000.0)}, 1 + 12), 12 * kStep_s / 0.2, 0.03);
  EXPECT_NEAR(share_after({pull(5000.0)}, 1 + 24), 24 * kStep_s / 0.2, 0.03);
}

TEST(Physics, GoesBackToASavedStateWithoutATrace) {
  const test::StandingMan man;
  Physics physics = physics_of(man, strength_of(man.body, Sex::male, 1.0));
  Goals asked;
  asked.joints[index(Joint::hip_r)] = {pull(20.0)};
  const Contacts contacts = physics.find_contacts();
  physics.save();
  physics.step(0.0, kStep_s, asked, contacts);
  const BodyPose once = physics.segments();
  physics.restore();
  physics.step(0.0, kStep_s, asked, contacts);
  const BodyPose twice = physics.segments();
  bool moved = false;
  for (int s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(once[s].translation, twice[s].translation) << s;
    EXPECT_EQ(once[s].rotation.coeffs(), twice[s].rotation.coeffs()) << s;
    moved = moved || once[s].translation != man.segments[s].translation;
  }
  EXPECT_TRUE(moved);
}

/// A brake at the hip while the pelvis is thrown forward: turning of the thigh against it after one step,
/// rad/s.
double turning_of_a_braked_hip(double brake_n_m_s) {
  const test::StandingMan man;
  Physics physics = physics_of(man, strength_of(man.body, Sex::male, 0.05));
  Goals asked;
  JointGoal brake = pull(0.0);
  brake.damping_n_m_s_rad = brake_n_m_s;
  asked.joints[index(Joint::hip_r)] = {brake};
  asked.help_n = Vec3(40000.0, 0.0, 0.0);
  physics.save();
  physics.step(0.0, kStep_s, asked, {});
  physics.accept(0.0, kStep_s);
  EXPECT_GE(physics.muscle_share(), brake_n_m_s > 100.0 ? 0.99 : 0.0);
  const Senses senses = physics.senses(kStep_s, {});
  return (senses.angular_velocity[index(Segment::thigh_r)] - senses.angular_velocity[0]).norm();
}

// Before the step nothing turns, so that the brake is expected to ask for nothing and its row has no bounds.
TEST(Muscles, ThatAreAskedForMoreThanWasExpectedAreStillCapped) {
  const double loose = turning_of_a_braked_hip(0.1);
  EXPECT_GT(loose, 2.0);
  EXPECT_GT(turning_of_a_braked_hip(1e5), 0.3 * loose);
}

}  // namespace
}  // namespace ukemi
