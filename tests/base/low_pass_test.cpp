#include "base/low_pass.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

std::vector<double> sine(double frequency_hz, double rate_hz, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(std::sin(2.0 * kPi * frequency_hz * static_cast<double>(i) / rate_hz));
  return values;
}

TEST(LowPass, HalvesItsCutoffWithoutDelay) {
  const Butterworth filter(12.0, 120.0);
  const std::vector<double> slow = sine(1.0, 120.0, 240), edge = sine(12.0, 120.0, 240);
  const std::vector<double> slow_filtered = zero_phase(slow, filter, 30, Beyond::mirrored);
  const std::vector<double> edge_filtered = zero_phase(edge, filter, 30, Beyond::mirrored);
  for (std::size_t i = 60; i < 180; ++i) {
    EXPECT_NEAR(slow_filtered[i], slow[i], 0.001) << i;
    EXPECT_NEAR(edge_filtered[i], 0.5 * edge[i], 0.001) << i;
  }
}

TEST(LowPass, ALevelStaysUnderBothEndsAndASlopeWhereTheyAreTurned) {
  const Butterworth filter(6.0, 60.0);
  const std::vector<double> level(30, 2.5);
  std::vector<Vec3> slope;
  for (int i = 0; i < 60; ++i) slope.push_back(Vec3(0.1 * i, 1.0, -0.2 * i));
  for (const Beyond ends : {Beyond::mirrored, Beyond::turned})
    for (const double value : zero_phase(level, filter, 20, ends)) EXPECT_NEAR(value, 2.5, 1e-9);
  const std::vector<Vec3> turned = zero_phase(slope, filter, 59, Beyond::turned);
  const std::vector<Vec3> mirrored = zero_phase(slope, filter, 59, Beyond::mirrored);
  for (std::size_t i = 0; i < slope.size(); ++i) EXPECT_LT((turned[i] - slope[i]).norm(), 1e-3) << i;
  EXPECT_GT((mirrored[0] - slope[0]).norm(), 0.05) << "a mirrored slope has a corner";
}

TEST(LowPass, ReachesBeyondAShortSequence) {
  const std::vector<double> values = {1.0, 1.0, 1.0};
  for (const double value : zero_phase(values, Butterworth(5.0, 60.0), 50, Beyond::turned))
    EXPECT_NEAR(value, 1.0, 1e-9);
}

}  // namespace
}  // namespace ukemi
