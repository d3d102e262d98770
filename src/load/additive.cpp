// Additive clips, read as the poses that they make.
#include <algorithm>
#include <array>

#include "load/gltf_reader.h"
#include "load/json_view.h"

namespace ukemi::load {
namespace {

/// The pose that the clip is the difference from.
Pose base_pose(const Skeleton& skeleton, const JsonView& ours) {
  Pose pose = rest_pose(skeleton);
  const auto from = ours.find("from");
  for (const auto& [label, local] : from ? from->members() : decltype(from->members())()) {
    const int node = skeleton.find(label);
    const auto t = local.numbers("translation", {0, 0, 0}), s = local.numbers("scale", {1, 1, 1});
    const auto r = local.numbers("rotation", {0, 0, 0, 1});
    const Quat rotation(r[3], r[0], r[1], r[2]);
    if (node >= 0 && rotation.norm() > 0.5)
      pose[node] = {Vec3(t[0], t[1], t[2]), rotation.normalized(), Vec3(s[0], s[1], s[2])};
  }
  return pose;
}

void add(Track& track, const LocalTransform& base) {
  const std::size_t width = track.path == TrackPath::rotation ? 4 : 3;
  for (std::size_t at = 0; at + width <= track.values.size(); at += width) {
    double* value = track.values.data() + at;
    if (track.path == TrackPath::rotation) {
      const Quat sum = base.rotation * Quat(value[3], value[0], value[1], value[2]);
      std::copy_n(sum.coeffs().data(), 4, value);
    }
    for (int i = 0; i < 3 && track.path == TrackPath::translation; ++i) value[i] += base.translation[i];
    for (int i = 0; i < 3 && track.path == TrackPath::scale; ++i) value[i] *= base.scale[i];
  }
}

/// What to add to differences from the rest pose so that they are differences from `pose`.
Pose beyond_rest(const Skeleton& skeleton, Pose pose) {
  for (int i = 0; i < skeleton.size(); ++i) {
    const LocalTransform& rest = skeleton.nodes[i].rest;
    pose[i].translation -= rest.translation;
    pose[i].rotation = pose[i].rotation * rest.rotation.conjugate();
    pose[i].scale = pose[i].scale.cwiseQuotient(rest.scale);
  }
  return pose;
}

std::vector<double> value_of(const LocalTransform& local, TrackPath path) {
  if (path == TrackPath::rotation) return {local.rotation.coeffs().begin(), local.rotation.coeffs().end()};
  const Vec3& v = path == TrackPath::translation ? local.translation : local.scale;
  return {v.begin(), v.end()};
}

/// A property without a track stays as in the pose. `none`: the values that mean no difference.
void restore(const Pose& base, const Pose& none, Animation& animation) {
  std::vector<std::array<bool, 3>> has_track(base.size(), std::array<bool, 3>{});
  for (const Track& track : animation.tracks)
    has_track[track.node][static_cast<std::size_t>(track.path)] = true;
  for (std::size_t node = 0; node < base.size(); ++node)
    for (std::size_t path = 0; path < 3; ++path)
      if (!has_track[node][path])
        animation.tracks.push_back({static_cast<int>(node),
                                    static_cast<TrackPath>(path),
                                    Interpolation::linear,
                                    {animation.start_s},
                                    value_of(none[node], static_cast<TrackPath>(path))});
  for (Track& track : animation.tracks)
    if (track.interpolation != Interpolation::cubic) add(track, base[track.node]);
}

}  // namespace

void restore_additive(Character& character) {
  for (Animation& animation : character.animations) try {
      if (animation.extras_json.find("additive") == std::string::npos) continue;
      const JsonDocument json(animation.extras_json);
      const auto ours = json.root().find("ukemi");
      if (!ours || !ours->boolean("additive", false)) continue;
      const Pose from = base_pose(character.skeleton, *ours);
      if (ours->boolean("on_rest", false))
        restore(beyond_rest(character.skeleton, from), rest_pose(character.skeleton), animation);
      else
        restore(from, Pose(from.size()), animation);
    } catch (const Refusal&) {  // extras that this program did not write
    }
}

}  // namespace ukemi::load
