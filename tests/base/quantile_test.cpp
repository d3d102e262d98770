#include "base/quantile.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Quantile, LiesBetweenTheValues) {
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0}, 0.25), 1.25);
  EXPECT_EQ(quantile({}, 0.5), 0.0);
}

TEST(Quantile, ARankIsAValueOfTheSample) {
  EXPECT_EQ(ranked({4.0, 1.0, 3.0, 2.0}, 0), 1.0);
  EXPECT_EQ(ranked({4.0, 1.0, 3.0, 2.0}, 3), 4.0);
}

TEST(Quantile, NumbersThatAreNotGivenCountAsZero) {
  EXPECT_EQ(exceeded_by({5.0, 7.0, 6.0}, 1000, 0.001), 6.0);
  EXPECT_EQ(exceeded_by({5.0, 7.0, 6.0}, 999, 0.001), 7.0);
  EXPECT_EQ(exceeded_by({5.0, 7.0, 6.0}, 3000, 0.001), 0.0);
}

TEST(Quantile, OfTimeIsAValueOfTheSampleWeighedByItsSeconds) {
  std::vector<TimedValue> values;
  for (int i = 200; i >= 1; --i) values.push_back({static_cast<double>(i), 0.01});
  EXPECT_EQ(quantile_of_time(values, 0.99), 198.0);
  EXPECT_EQ(quantile_of_time(values, 1.0), 200.0);
  EXPECT_EQ(quantile_of_time({{7.0, 1.0}}, 0.5), 7.0);
  EXPECT_EQ(quantile_of_time({{1.0, 3.0}, {2.0, 1.0}}, 0.5), 1.0) << "by time, not by count";
  EXPECT_EQ(quantile_of_time({}, 0.5), 0.0);
}

}  // namespace
}  // namespace ukemi
