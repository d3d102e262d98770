#include "body/on_ground.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Ground, HullLeavesOutWhatLiesInside) {
  const std::vector<Vec2> hull = convex_hull({{0, 0}, {2, 0}, {1, 0.5}, {2, 1}, {0, 1}, {1, 0}, {0.3, 0.3}});
  ASSERT_EQ(hull.size(), 4u);
  EXPECT_NEAR(beyond(hull, {1, 0.5}), -0.5, 1e-12);
  EXPECT_NEAR(beyond(hull, {3, 0.5}), 1.0, 1e-12);
  EXPECT_NEAR(beyond(hull, {5, 5}), 5.0, 1e-12);
}

TEST(Ground, PointsOutsideAreMovedToTheNearestEdge) {
  const std::vector<Vec2> hull = convex_hull({{0, 0}, {2, 0}, {2, 1}, {0, 1}});
  EXPECT_TRUE(into(hull, {1.5, 0.2}).isApprox(Vec2(1.5, 0.2)));
  EXPECT_TRUE(into(hull, {1.5, -3.0}).isApprox(Vec2(1.5, 0.0)));
}

TEST(Ground, HeadingsTurnFromFrontToLeft) {
  EXPECT_TRUE(forward_of(0.0).isApprox(Vec2(1, 0)));
  EXPECT_TRUE(right_of(0.0).isApprox(Vec2(0, 1)));
  EXPECT_TRUE(forward_of(0.5 * kPi).isApprox(Vec2(0, -1), 1e-12));
  EXPECT_NEAR(yaw_of(Quat(Eigen::AngleAxisd(0.7, Vec3::UnitY())) * Vec3::UnitX()), 0.7, 1e-12);
  EXPECT_NEAR(wrapped(2.0 * kPi + 0.1), 0.1, 1e-12);
}

TEST(Ground, MinimumJerkStartsAndEndsAtRest) {
  EXPECT_EQ(min_jerk(-1.0), 0.0);
  EXPECT_EQ(min_jerk(2.0), 1.0);
  EXPECT_DOUBLE_EQ(min_jerk(0.5), 0.5);
  EXPECT_LT(min_jerk(0.01), 1e-4);
}

}  // namespace
}  // namespace ukemi
