#include "judge/signal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ukemi {
namespace {

constexpr double kFps = 60.0;

Course sine(double hertz, int frames) {
  Course course;
  for (int f = 0; f < frames; ++f) course.push_back(Vec3(std::sin(2.0 * kPi * hertz * f / kFps), 0.0, 0.0));
  return course;
}

double amplitude(const Course& course) {
  double largest = 0.0;
  for (std::size_t f = course.size() / 3; f < 2 * course.size() / 3; ++f)
    largest = std::max(largest, std::abs(course[f].x()));
  return largest;
}

TEST(Signal, ASteadyMotionPassesTheFilterAsItIsToItsEnds) {
  Course course;
  for (int f = 0; f < 40; ++f) course.push_back(Vec3(1.0, 2.0 - 0.05 * f, 0.3 * f));
  const Course filtered = low_passed(course, kFps, 6.0);
  for (int f = 0; f < 40; ++f) EXPECT_LT((filtered[f] - course[f]).norm(), 5e-3) << f;
}

TEST(Signal, AtTheCutOffHalfOfTheAmplitudeIsLeft) {
  EXPECT_NEAR(amplitude(low_passed(sine(8.0, 300), kFps, 8.0)), 0.5, 0.02);
  EXPECT_NEAR(amplitude(low_passed(sine(1.0, 300), kFps, 8.0)), 1.0, 0.002);
  EXPECT_LT(amplitude(low_passed(sine(24.0, 300), kFps, 8.0)), 0.01);
}

TEST(Signal, ACutOffNearHalfTheRateChangesNothing) {
  const Course course = sine(20.0, 30);
  EXPECT_EQ(low_passed(course, kFps, 27.0), course);
  EXPECT_NE(low_passed(course, kFps, 26.9), course);
}

TEST(Signal, RatesAreExactForParabolas) {
  Course course;
  for (int f = 0; f < 10; ++f) course.push_back(Vec3(0.0, 0.5 * (f / kFps) * (f / kFps), 0.0));
  const Course rates = rate_of(course, kFps);
  for (int f = 1; f < 9; ++f) EXPECT_NEAR(rates[f].y(), f / kFps, 1e-12);
}

}  // namespace
}  // namespace ukemi
