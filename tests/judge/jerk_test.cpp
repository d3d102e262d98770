#include "judge/jerk.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

/// Three nodes, of which the second turns by `angle(time)` about an axis.
template <typename Angle>
Clip turning(double fps, int frames, const Angle& angle) {
  Clip clip{"turns", fps, {}, {}};
  for (int f = 0; f < frames; ++f) {
    Pose pose(3);
    pose[1].rotation = exp_rotation(angle(f / fps) * Vec3(0.0, 0.6, 0.8));
    clip.frames.push_back(pose);
  }
  return clip;
}

TEST(Jerk, OfACubicTurnIsItsThirdDerivativeAtAnyFrameRate) {
  const auto cubic = [](double t) { return radians(50.0 * t * t * t); };
  for (const double fps : {30.0, 60.0, 120.0}) {
    const JerkPeak peak = largest_jerk(turning(fps, 20, cubic));
    EXPECT_NEAR(peak.deg_s3, 300.0, 1e-3) << fps;
    EXPECT_EQ(peak.node, 1) << fps;
  }
}

TEST(Jerk, IsFoundWhereItIs) {
  // At rest until 0.5 s, then at a steady speed: the corner is a jerk of speed times the rate squared.
  const auto corner = [](double t) { return radians(10.0 * std::max(0.0, t - 0.5)); };
  const JerkPeak peak = largest_jerk(turning(60.0, 60, corner));
  EXPECT_NEAR(peak.deg_s3, 10.0 * 60.0 * 60.0, 1e-3);
  EXPECT_NEAR(peak.time_s, 0.5, 1.5 / 60.0);
  EXPECT_NEAR(largest_jerk(turning(60.0, 60, [](double t) { return radians(90.0 * t); })).deg_s3, 0.0, 1e-3);
}

}  // namespace
}  // namespace ukemi
