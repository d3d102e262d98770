#include <gtest/gtest.h>

#include "restrict/active.h"
#include "restrict/range_of_motion.h"
#include "support/random.h"

namespace ukemi {
namespace {

SwingTwist random_chart(Random& random, double max_swing) {
  SwingTwist chart;
  do {
    chart.swing = test::random_vector2(random, max_swing);
  } while (chart.swing.norm() > max_swing);
  chart.twist = random.uniform(-3.0, 3.0);
  return chart;
}

TEST(Chart, RoundTripsToTwelveDigits) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const SwingTwist chart = random_chart(random, 2.9);
    const SwingTwist back = swing_twist(joint_rotation(chart));
    EXPECT_LT((back.swing - chart.swing).norm(), 1e-12);
    EXPECT_NEAR(back.twist, chart.twist, 1e-12);
  }
}

TEST(Chart, LinkDirectionIsTheClosedForm) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const SwingTwist chart = random_chart(random, 2.9);
    const double theta = chart.swing.norm();
    const double k = std::sin(theta) / theta;
    const Vec3 link = joint_rotation(chart) * Vec3::UnitX();
    EXPECT_LT((link - Vec3(std::cos(theta), k * chart.swing.y(), -k * chart.swing.x())).norm(), 1e-13);
  }
}

TEST(Chart, RowsAreTheRatesOfTheChart) {
  Random random(3);
  const double h = 1e-6;
  for (int i = 0; i < 500; ++i) {
    SwingTwist chart = random_chart(random, 2.4);
    chart.twist *= 0.8;  // away from the wrap
    const Vec3 omega = test::random_vector(random);
    const Quat q = joint_rotation(chart);
    const SwingTwist after = swing_twist(exp_rotation(h * omega) * q);
    const SwingTwist before = swing_twist(exp_rotation(-h * omega) * q);
    const Vec2 rate = (after.swing - before.swing) / (2 * h);
    EXPECT_NEAR(swing_row(chart, Vec2(1, 0)).dot(omega), rate.x(), 2e-8);
    EXPECT_NEAR(swing_row(chart, Vec2(0, 1)).dot(omega), rate.y(), 2e-8);
    EXPECT_NEAR(twist_row(chart).dot(omega), (after.twist - before.twist) / (2 * h), 2e-8);
  }
}

TEST(Chart, IsDefinedAtASwingOfPi) {
  const SwingTwist chart = swing_twist(Quat(0, 0, 1, 0));
  EXPECT_NEAR(chart.swing.norm(), kPi, 1e-12);
}

TEST(Polygon, DistanceIsSignedAndExactForConcaveShapes) {
  // An L: the notch's corner (1, 1) is reflex.
  const std::vector<Vec2> shape{{-1, -1}, {3, -1}, {3, 1}, {1, 1}, {1, 3}, {-1, 3}};
  EXPECT_NEAR(polygon_distance(shape, Vec2(0, 0)), -1.0, 1e-15);
  EXPECT_NEAR(polygon_distance(shape, Vec2(2, 2)), 1.0, 1e-15);
  EXPECT_NEAR(polygon_distance(shape, Vec2(4, 2)), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(polygon_distance(shape, Vec2(0.5, 0.5)), -std::sqrt(0.5), 1e-15)
      << "the reflex corner is nearest";
  EXPECT_LT((nearest_boundary_point(shape, Vec2(2, 1.5)) - Vec2(2, 1)).norm(), 1e-15);
}

TEST(Polygon, EveryEdgeIsNearestToWhatLiesBesideItsMiddle) {
  const std::vector<Vec2> shape{{-1, -1}, {3, -1}, {3, 1}, {1, 1}, {1, 3}, {-1, 3}};
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Vec2 from = shape[i], to = shape[(i + 1) % shape.size()], along = (to - from).normalized();
    const Vec2 outwards(along.y(), -along.x());  // the corners go round to the left
    const Vec2 middle = 0.5 * (from + to);
    EXPECT_LT((nearest_boundary_point(shape, middle + 0.3 * outwards) - middle).norm(), 1e-15)
        << "edge " << i;
    EXPECT_NEAR(polygon_distance(shape, middle + 0.3 * outwards), 0.3, 1e-15) << "edge " << i;
    EXPECT_NEAR(polygon_distance(shape, middle - 0.3 * outwards), -0.3, 1e-15) << "edge " << i;
  }
}

TEST(Range, ExcessIsTheLargerOfSwingAndTwistAndClampRemovesIt) {
  JointRange range;
  range.polygon = {{0.5, 0}, {0, 0.5}, {-0.5, 0}, {0, -0.5}};
  range.twist_min = -0.2;
  range.twist_max = 0.3;
  SwingTwist chart{{0.0, 0.7}, 0.6};
  EXPECT_NEAR(excess(range, chart), 0.3, 1e-15);
  chart.twist = 0.31;
  EXPECT_NEAR(excess(range, chart), 0.2, 1e-15);
  EXPECT_LT(excess(range, clamp_to_range(range, chart)), 1e-15);
  EXPECT_EQ(excess(range, SwingTwist{{0.1, 0.1}, -0.1}), 0.0);
}

TEST(Range, WideningHoldsTheChartWithItsMarginAndKeepsTheRest) {
  JointRange range;
  range.polygon = {{0.5, 0}, {0, 0.5}, {-0.5, 0}, {0, -0.5}};
  range.twist_min = -0.2;
  range.twist_max = 0.3;
  const std::vector<Vec2> before = range.polygon;
  const SwingTwist outside{{0.6, 0.4}, 0.29};
  EXPECT_NEAR(widen_to_hold(range, outside, 0.05), 0.5 / std::sqrt(2.0) + 0.05, 1e-12);
  EXPECT_LE(polygon_distance(range.polygon, outside.swing), -0.05 + 1e-12);
  EXPECT_NEAR(range.twist_max, 0.34, 1e-15);
  for (const Vec2& corner : before) EXPECT_LE(polygon_distance(range.polygon, corner), 1e-12);
  EXPECT_NEAR(widen_to_hold(range, outside, 0.05), 0.0, 1e-12) << "a second time does nothing";
}

TEST(Widening, HoldsAPoseByTheMarginWhereItIsNearTheEdgeAndOutside) {
  const auto square = [] {
    JointRange range;
    range.polygon = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    range.twist_min = -0.3;
    range.twist_max = 0.3;
    return range;
  };
  const double margin = 0.05;
  JointRange deep = square(), near = square(), outside = square();
  EXPECT_EQ(widen_to_hold(deep, {Vec2(0.44, 0.0), 0.0}, margin), 0.0);
  EXPECT_EQ(deep.polygon.size(), 4u);
  EXPECT_NEAR(widen_to_hold(near, {Vec2(0.48, 0.0), 0.0}, margin), 0.03, 1e-12);
  EXPECT_LE(polygon_distance(near.polygon, Vec2(0.48, 0.0)), -margin + 1e-12);
  EXPECT_NEAR(widen_to_hold(outside, {Vec2(0.6, 0.0), 0.4}, margin), 0.15, 1e-12);
  EXPECT_LE(polygon_distance(outside.polygon, Vec2(0.6, 0.0)), -margin + 1e-12);
  EXPECT_NEAR(outside.twist_max, 0.45, 1e-12);
  EXPECT_EQ(outside.twist_min, -0.3);
}

TEST(Thresholds, AreDegreesPerSecondInTheFileAndRadiansInTheProgram) {
  const auto thresholds = load_active_thresholds("");
  ASSERT_TRUE(thresholds) << thresholds.error().message();
  // As assets/limits/active.toml has them.
  EXPECT_NEAR((*thresholds)[index(Joint::spine)].x(), radians(120.0), 1e-12);
  EXPECT_NEAR((*thresholds)[index(Joint::elbow_l)].y(), radians(305.0), 1e-12);
  EXPECT_EQ((*thresholds)[index(Joint::elbow_l)], (*thresholds)[index(Joint::elbow_r)]);
}

}  // namespace
}  // namespace ukemi
