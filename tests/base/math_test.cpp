#include "base/math.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace ukemi {
namespace {

TEST(Math, ExpAndLogAreInverse) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Quat q = test::random_rotation(random);
    EXPECT_LT(angle_between(q, exp_rotation(log_rotation(q))), 1e-14);
  }
  EXPECT_LT((log_rotation(exp_rotation(Vec3(1e-9, 2e-9, 0))) - Vec3(1e-9, 2e-9, 0)).norm(), 1e-20);
}

TEST(Math, AngleBetweenIsExactForTinyAngles) {
  EXPECT_NEAR(angle_between(Quat::Identity(), exp_rotation(Vec3(0, 3e-12, 0))), 3e-12, 1e-24);
}

TEST(Math, RotationPartOfAMirroredMapIsARotation) {
  Random random(2);
  const Quat q = test::random_rotation(random);
  const Mat3 mirrored = -2.0 * q.toRotationMatrix();
  EXPECT_LT(angle_between(rotation_part(mirrored), q), 1e-14);
  EXPECT_LT(angle_between(rotation_part(Mat3(3.0 * q.toRotationMatrix())), q), 1e-14);
}

TEST(Math, TwistAngleReadsTheTwistBelowASwing) {
  const Quat swing = exp_rotation(Vec3(0, 0.7, -0.4));
  EXPECT_NEAR(twist_angle(swing * exp_rotation(Vec3(0.9, 0, 0)), Vec3::UnitX()), 0.9, 1e-14);
}

TEST(Math, ShortestRotationOfOppositeAndZeroDirections) {
  EXPECT_LT((shortest_rotation(Vec3::UnitY(), -Vec3::UnitY()) * Vec3::UnitY() + Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT(angle_between(shortest_rotation(Vec3::Zero(), Vec3::UnitY()), Quat::Identity()), 1e-15);
}

}  // namespace
}  // namespace ukemi
