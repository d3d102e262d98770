// Tone: what it asks of which joint, and how long; and what is left of a man's muscles when he is knocked
// out.
#include "behave/tone.h"

#include "behave/alert.h"
#include "behave/fallen_man.h"
#include "behave/knocked_out.h"
#include "feet/stand.h"

namespace ukemi {
namespace {

/// What is asked of a joint some time after the start, N m.
double cap_n_m(Joint joint, double share, double time_s, double larger = 1.0) {
  test::Faller faller;
  faller.man.body.mass_kg = 73.0 * larger;
  faller.man.body.height_m = 1.741;
  ToneBehaviour tone(faller.man.body, {share, 0.6});
  tone.start(faller.senses(Vec3::Zero(), Vec3::Zero()));
  Goals goals;
  tone.drive(time_s, goals);
  const auto& asked = goals.tone[index(joint)];
  return asked ? asked->cap_n_m : 0.0;
}

TEST(Tone, AsksOfEachJointWhatAMansGives) {
  const std::pair<Joint, double> expected[] = {
      {Joint::spine, 200.0},     {Joint::chest, 150.0},     {Joint::neck, 30.0},    {Joint::clavicle_l, 60.0},
      {Joint::shoulder_l, 60.0}, {Joint::shoulder_r, 60.0}, {Joint::elbow_r, 45.0}, {Joint::wrist_l, 10.0},
      {Joint::hip_r, 150.0},     {Joint::knee_l, 150.0},    {Joint::ankle_l, 60.0}, {Joint::ankle_r, 60.0}};
  for (const auto& [joint, n_m] : expected) EXPECT_NEAR(cap_n_m(joint, 1.0, 0.0), n_m, 1e-9) << name(joint);
  EXPECT_NEAR(cap_n_m(Joint::shoulder_r, 0.3, 0.0), 18.0, 1e-9);
  EXPECT_NEAR(cap_n_m(Joint::shoulder_r, 1.0, 0.0, 2.0), 120.0, 1e-9) << "of twice the weight";
}

TEST(Tone, FadesSmoothlyInItsTime) {
  EXPECT_NEAR(cap_n_m(Joint::hip_r, 1.0, 0.15), 150.0 * 0.84375, 1e-9);
  EXPECT_NEAR(cap_n_m(Joint::hip_r, 1.0, 0.3), 75.0, 1e-9);
  EXPECT_NEAR(cap_n_m(Joint::hip_r, 1.0, 0.6), 0.0, 1e-9);
}

/// What a man who is knocked out at 0.5 s asks of his muscles, N m/rad over all joints.
double stiffness_at(double time_s) {
  const test::Faller faller;
  const ArticulatedBody& body = faller.man.body;
  auto standing = std::make_unique<Standing>(body, faller.man.segments, 9.81, StandSettings{});
  auto alive = std::make_unique<Alert>(std::move(standing), body, faller.man.range, faller.strength,
                                       FallSettings::alert());
  KnockedOut man(std::move(alive), body, {Knockout::At::time, 0.5}, {0.3, 0.6});
  Senses senses = faller.senses(Vec3::Zero(), Vec3::Zero());
  man.start(senses);
  for (int i = 1; 0.01 * i <= time_s + 1e-9; ++i) {
    senses.time_s = 0.01 * i;
    man.observe(senses, 0.01);
  }
  Goals goals;
  man.drive(time_s, goals);
  double sum = 0.0;
  for (const auto& joint : goals.joints)
    for (const JointGoal& goal : joint) sum += goal.stiffness_n_m_rad;
  return sum;
}

TEST(KnockedOut, MusclesLetGoInAnEighthOfASecond) {
  const double awake = stiffness_at(0.49);
  EXPECT_GT(awake, 1000.0);
  EXPECT_NEAR(stiffness_at(0.56), 0.5 * awake, 0.02 * awake);
  EXPECT_LT(stiffness_at(0.60), 0.1 * awake);
  EXPECT_EQ(stiffness_at(0.63), 0.0);
}

}  // namespace
}  // namespace ukemi
