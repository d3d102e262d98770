#include <gtest/gtest.h>

#include "restrict/active.h"
#include "restrict/limit_rows.h"
#include "support/random.h"

namespace ukemi {
namespace {

JointRange square() {
  JointRange range;
  range.polygon = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  range.twist_min = -0.5;
  range.twist_max = 0.5;
  return range;
}

TEST(EdgeRows, DistancesAreThoseOfTheEdgesAndOfTheTwist) {
  std::vector<LimitRow> rows;
  edge_rows(square(), {{0.25, -0.5}, 0.1}, rows);
  ASSERT_EQ(rows.size(), 6u);
  std::vector<double> distances;
  for (const LimitRow& row : rows) distances.push_back(row.distance);
  std::sort(distances.begin(), distances.end());
  const std::vector<double> expected{0.4, 0.5, 0.6, 0.75, 1.25, 1.5};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(distances[i], expected[i], 1e-12);
}

TEST(EdgeRows, ASmallStepThatObeysThemStaysInside) {
  Random random(5);
  JointRange range = square();
  range.polygon = {{1, -0.5},   {0.3, 0.1},  {0.9, 1},
                   {-0.6, 0.9}, {-0.2, 0.1}, {-0.7, -0.8}};  // two reflex corners
  const double h = 1e-4;
  std::vector<LimitRow> rows;
  int obeyed = 0;
  for (int i = 0; i < 20000; ++i) {
    const SwingTwist chart{test::random_vector2(random), random.uniform(-0.5, 0.5)};
    if (excess(range, chart) > 0.0) continue;
    const Vec3 omega = test::random_vector(random, 200.0);
    edge_rows(range, chart, rows);
    const bool fits = std::all_of(rows.begin(), rows.end(), [&](const LimitRow& row) {
      return row.row.dot(omega) * h <= row.distance;
    });
    if (!fits) continue;
    ++obeyed;
    const SwingTwist after = swing_twist(exp_rotation(h * omega) * joint_rotation(chart));
    EXPECT_LT(excess(range, after), 1e-3);
  }
  EXPECT_GT(obeyed, 1000);
}

TEST(ChordStops, AreTheEndsOfTheChordsThroughTheState) {
  JointRange range = square();
  range.polygon = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  const ChordStops stops = chord_stops(range, {{0.25, 0.5}, 0.0});
  EXPECT_NEAR(stops.a_y[0], -0.5, 1e-12);
  EXPECT_NEAR(stops.a_y[1], 0.5, 1e-12);
  EXPECT_NEAR(stops.a_z[0], -0.75, 1e-12);
  EXPECT_NEAR(stops.a_z[1], 0.75, 1e-12);
}

TEST(ChordStops, OutsideUseTheChordThroughTheNearestBoundaryPoint) {
  const ChordStops stops = chord_stops(square(), {{1.5, 0.5}, 0.0});
  EXPECT_NEAR(stops.a_y[1], 1.0, 1e-9);
  EXPECT_NEAR(stops.a_y[0], -1.0, 1e-9);
}

TEST(ActiveThresholds, AreAboveZeroAndTheSameOnBothSides) {
  const auto thresholds = load_active_thresholds("");
  ASSERT_TRUE(thresholds) << thresholds.error().message();
  for (int j = 0; j < kJointCount; ++j) {
    EXPECT_GT((*thresholds)[j].minCoeff(), radians(50.0));
    EXPECT_EQ((*thresholds)[j], (*thresholds)[index(mirror_of(joint_at(j)))]);
  }
}

}  // namespace
}  // namespace ukemi
