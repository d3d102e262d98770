#include "base/animation.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kMostTransforms = 5e6;  // of one clip: 400 MB

Eigen::Vector4d key_value(const Track& track, std::size_t key, std::size_t part) {
  const std::size_t width = track.path == TrackPath::rotation ? 4 : 3;
  const std::size_t stride = track.interpolation == Interpolation::cubic ? 3 * width : width;
  const double* v = track.values.data() + key * stride + part * width;
  return {v[0], v[1], v[2], width == 4 ? v[3] : 0.0};
}

Quat as_rotation(const Eigen::Vector4d& v) {
  const double length = v.norm();
  return length > 0.0 ? Quat(v[3] / length, v[0] / length, v[1] / length, v[2] / length) : Quat::Identity();
}

Eigen::Vector4d interpolate(const Track& track, std::size_t key, double u) {
  const std::size_t middle = track.interpolation == Interpolation::cubic ? 1 : 0;
  Eigen::Vector4d a = key_value(track, key, middle);
  const Eigen::Vector4d b = key_value(track, key + 1, middle);
  switch (track.interpolation) {
    case Interpolation::step:
      return a;
    case Interpolation::cubic: {
      const double span = track.times[key + 1] - track.times[key];
      const double u2 = u * u;
      const double u3 = u2 * u;
      return (2 * u3 - 3 * u2 + 1) * a + span * (u3 - 2 * u2 + u) * key_value(track, key, 2) +
             (-2 * u3 + 3 * u2) * b + span * (u3 - u2) * key_value(track, key + 1, 0);
    }
    case Interpolation::linear:
      break;
  }
  if (track.path != TrackPath::rotation) return a + u * (b - a);
  return as_rotation(a).slerp(u, as_rotation(b)).coeffs();
}

Eigen::Vector4d evaluate(const Track& track, double time_s) {
  const std::size_t middle = track.interpolation == Interpolation::cubic ? 1 : 0;
  if (time_s <= track.times.front()) return key_value(track, 0, middle);
  if (time_s >= track.times.back()) return key_value(track, track.times.size() - 1, middle);
  const auto after = std::upper_bound(track.times.begin(), track.times.end(), time_s);
  const auto key = static_cast<std::size_t>(after - track.times.begin()) - 1;
  const double u = (time_s - track.times[key]) / (track.times[key + 1] - track.times[key]);
  return interpolate(track, key, u);
}

}  // namespace

Pose sample(const Skeleton& skeleton, const Animation& animation, double time_s) {
  Pose pose = rest_pose(skeleton);
  for (const Track& track : animation.tracks) {
    if (track.times.empty()) continue;
    const Eigen::Vector4d value = evaluate(track, time_s);
    LocalTransform& local = pose[track.node];
    if (track.path == TrackPath::rotation)
      local.rotation = as_rotation(value);
    else if (track.path == TrackPath::translation)
      local.translation = value.head<3>();
    else
      local.scale = value.head<3>();
  }
  return pose;
}

Clip sample_clip(const Skeleton& skeleton, const Animation& animation, double fps) {
  Clip clip{animation.name, fps, {}, {}};
  const double most = std::max(1.0, std::floor(kMostTransforms / static_cast<double>(skeleton.nodes.size())));
  if (animation.duration_s() * fps > most) clip.fps = most / animation.duration_s();
  // A thousandth of a frame absorbs rounded frame times (0.0333333 s).
  const auto last = static_cast<long>(std::floor(animation.duration_s() * clip.fps + 1e-3));
  for (long i = 0; i <= last; ++i)
    clip.frames.push_back(sample(skeleton, animation, animation.start_s + static_cast<double>(i) / clip.fps));
  return clip;
}

}  // namespace ukemi
