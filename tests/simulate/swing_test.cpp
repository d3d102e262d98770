// A single link that is pulled into the boundary of its joint.
#include "physics/swing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ukemi {
namespace {

constexpr double kPull = 3.0;       // rad/s^2
constexpr double kDuration = 0.25;  // s

/// Corners 30 degrees out on the axes: every edge is slanted.
JointRange slanted() {
  JointRange range;
  const double m = radians(30.0);
  range.polygon = {{m, 0}, {0, m}, {-m, 0}, {0, -m}};
  range.twist_min = -1.0;
  range.twist_max = 1.0;
  return range;
}

const Vec2 kEdgeMiddle = radians(15.0) * Vec2(1, 1);

/// Degrees slid along the edge from its middle, pulled at `phi` from the edge's normal.
double slide_deg(Limits limits, double phi) {
  const Vec2 normal = Vec2(1, 1).normalized(), along = Vec2(-1, 1).normalized();
  SwingSettings settings;
  settings.limits = limits;
  settings.start = kEdgeMiddle;
  settings.pull = kPull * (std::cos(phi) * normal + std::sin(phi) * along);
  settings.duration_s = kDuration;
  const auto charts = swing_joint(slanted(), settings);
  EXPECT_TRUE(charts);
  return degrees(along.dot(charts->back().swing - kEdgeMiddle));
}

/// The edge's middle lies along its normal, so with n = a / theta and t = e_x x n the torque's parts are n
/// and theta (cot(theta) t + e_x), the edge takes the first, and the second accelerates along the edge by its
/// squared length, (theta / sin theta)^2. Leading order in time.
double frictionless_deg(double phi) {
  const double theta = kEdgeMiddle.norm();
  const double stretch = theta / std::sin(theta);
  return degrees(0.5 * kPull * std::sin(phi) * stretch * stretch * kDuration * kDuration);
}

double largest_excess_deg(const JointRange& range, const std::vector<SwingTwist>& charts) {
  double largest = 0.0;
  for (const SwingTwist& chart : charts) largest = std::max(largest, degrees(excess(range, chart)));
  return largest;
}

TEST(Swing, EdgesSlideAsFarAsTheFrictionlessClosedForm) {
  for (const double phi : {20.0, 45.0, 60.0, 80.0})
    EXPECT_NEAR(slide_deg(Limits::edges, radians(phi)), frictionless_deg(radians(phi)),
                0.02 * frictionless_deg(radians(phi)))
        << phi;
}

TEST(Swing, SegmentsStickOnSlantedEdges) {
  EXPECT_LT(slide_deg(Limits::segments, radians(20.0)), 0.1 * frictionless_deg(radians(20.0)));
  EXPECT_LT(slide_deg(Limits::segments, radians(45.0)), 0.1 * frictionless_deg(radians(45.0)));
}

TEST(Swing, APullStraightAtTheEdgeDoesNotMoveTheLink) {
  EXPECT_NEAR(slide_deg(Limits::edges, 0.0), 0.0, 1e-6);
}

TEST(Swing, IndependentAxesLeaveTheShouldersPolygonAndEdgesDoNot) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  const JointRange& shoulder = range->joints[index(Joint::shoulder_r)];
  SwingSettings settings;
  settings.pull = 6.0 * Vec2(84.0, -100.0).normalized();
  settings.damping = 1.5;
  settings.duration_s = 2.0;
  const auto excess_under = [&](Limits limits) {
    settings.limits = limits;
    const auto charts = swing_joint(shoulder, settings);
    EXPECT_TRUE(charts);
    return largest_excess_deg(shoulder, *charts);
  };
  EXPECT_GT(excess_under(Limits::axis), 10.0);
  EXPECT_LT(excess_under(Limits::edges), 0.5);
}

}  // namespace
}  // namespace ukemi
