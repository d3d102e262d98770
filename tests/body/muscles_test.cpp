// How strong joints are.
#include "body/muscles.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "simulate/standing_man.h"

namespace ukemi {
namespace {

MuscleStrength strength_of(const ArticulatedBody& body, Sex sex, double share) {
  const auto strength = muscle_strength(body, sex, share);
  if (!strength) throw std::runtime_error(strength.error().message());
  return *strength;
}

TEST(Muscles, OfABodyGrowWithItsMassHeightAndShare) {
  test::StandingMan man;
  const int knee = index(Joint::knee_r);
  const double plain = strength_of(man.body, Sex::male, 1.0)[knee].most_n_m.z();
  EXPECT_GT(plain, 200.0);
  EXPECT_LT(plain, 400.0);
  EXPECT_NEAR(strength_of(man.body, Sex::male, 0.5)[knee].most_n_m.z(), 0.5 * plain, 1e-9);
  EXPECT_LT(strength_of(man.body, Sex::female, 1.0)[knee].most_n_m.z(), 0.9 * plain);
  man.body.mass_kg *= 2.0;
  EXPECT_NEAR(strength_of(man.body, Sex::male, 1.0)[knee].most_n_m.z(), 2.0 * plain, 1e-9);
}

TEST(Muscles, OfTheLeftMirrorThoseOfTheRight) {
  const test::StandingMan man;
  const MuscleStrength strength = strength_of(man.body, Sex::male, 1.0);
  const JointStrength& left = strength[index(Joint::hip_l)];
  const JointStrength& right = strength[index(Joint::hip_r)];
  EXPECT_DOUBLE_EQ(left.most_n_m.x(), -right.least_n_m.x());
  EXPECT_DOUBLE_EQ(left.least_n_m.y(), -right.most_n_m.y());
  EXPECT_DOUBLE_EQ(left.least_n_m.x(), -right.most_n_m.x());
  EXPECT_DOUBLE_EQ(left.most_n_m.z(), right.most_n_m.z());
  EXPECT_NE(right.most_n_m.x(), -right.least_n_m.x());
}

}  // namespace
}  // namespace ukemi
