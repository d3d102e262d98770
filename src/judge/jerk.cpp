#include "judge/jerk.h"

namespace ukemi {

JerkPeak largest_jerk(const Clip& clip) {
  const auto angular_velocity = [&](std::size_t frame, std::size_t node) -> Vec3 {
    const Quat& from = clip.frames[frame][node].rotation;
    return log_rotation(from.conjugate() * clip.frames[frame + 1][node].rotation) * clip.fps;
  };
  JerkPeak peak;
  for (std::size_t f = 0; f + 3 < clip.frames.size(); ++f)
    for (std::size_t n = 0; n < clip.frames[f].size(); ++n) {
      const Vec3 change =
          angular_velocity(f + 2, n) - 2.0 * angular_velocity(f + 1, n) + angular_velocity(f, n);
      const double jerk = degrees(change.norm() * clip.fps * clip.fps);
      if (jerk > peak.deg_s3) peak = {jerk, static_cast<int>(n), (static_cast<double>(f) + 1.5) / clip.fps};
    }
  return peak;
}

}  // namespace ukemi
