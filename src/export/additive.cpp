#include "export/additive.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kNothing = 1e-9;

void subtract(Track& track, std::size_t key, const LocalTransform& from) {
  double* value = track.values.data() + key * (track.path == TrackPath::rotation ? 4 : 3);
  if (track.path == TrackPath::rotation) {
    const Quat delta = from.rotation.conjugate() * Quat(value[3], value[0], value[1], value[2]);
    std::copy_n(delta.coeffs().data(), 4, value);
    return;
  }
  for (int i = 0; i < 3; ++i) {
    if (track.path == TrackPath::translation)
      value[i] -= from.translation[i];
    else if (from.scale[i] != 0.0)
      value[i] /= from.scale[i];
  }
}

/// Puts a difference on a transform.
void put_on(const LocalTransform& base, TrackPath path, double* value) {
  if (path == TrackPath::rotation) {
    const Quat sum = base.rotation * Quat(value[3], value[0], value[1], value[2]);
    std::copy_n(sum.coeffs().data(), 4, value);
    return;
  }
  for (int i = 0; i < 3; ++i)
    value[i] = path == TrackPath::translation ? base.translation[i] + value[i] : base.scale[i] * value[i];
}

bool is_nothing(const Track& track) {
  const std::size_t width = track.path == TrackPath::rotation ? 4 : 3;
  for (std::size_t i = 0; i < track.values.size(); ++i) {
    double none = track.path == TrackPath::scale ? 1.0 : 0.0;
    if (track.path == TrackPath::rotation && i % width == 3) none = track.values[i] < 0.0 ? -1.0 : 1.0;
    if (std::abs(track.values[i] - none) > kNothing) return false;
  }
  return true;
}

}  // namespace

std::string_view name(Additive form) {
  constexpr std::string_view kNames[] = {"off", "identity", "rest"};
  return kNames[static_cast<int>(form)];
}

ReducedClip on_rest(const ReducedClip& difference, const Skeleton& skeleton) {
  ReducedClip result = difference;
  for (Track& track : result.tracks) {
    const LocalTransform& rest = skeleton.nodes[track.node].rest;
    const std::size_t width = track.path == TrackPath::rotation ? 4 : 3;
    for (std::size_t at = 0; at + width <= track.values.size(); at += width)
      put_on(rest, track.path, track.values.data() + at);
  }
  return result;
}

ReducedClip additive(const ReducedClip& clip, const Pose& pose) {
  ReducedClip result = clip;
  for (Track& track : result.tracks)
    for (std::size_t key = 0; key < track.times.size(); ++key)
      subtract(track, key, pose[static_cast<std::size_t>(track.node)]);
  const bool moves = !std::all_of(result.tracks.begin(), result.tracks.end(), is_nothing);
  if (moves) std::erase_if(result.tracks, is_nothing);
  result.keys = 0;
  for (const Track& track : result.tracks) result.keys += track.times.size();
  return result;
}

}  // namespace ukemi
