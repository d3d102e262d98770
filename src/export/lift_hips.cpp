#include "export/lift_hips.h"

#include <algorithm>

namespace ukemi {
namespace {

bool has_all_positions(const BvhSource& bvh, int joint) {
  const std::vector<BvhChannel>& channels = bvh.channels[static_cast<std::size_t>(joint)];
  return std::count_if(channels.begin(), channels.end(),
                       [](BvhChannel channel) { return channel < BvhChannel::x_rotation; }) == 3;
}

void lift(const Skeleton& skeleton, const BvhSource& bvh, int hips, Pose& frame) {
  const Vec3& offset = skeleton.nodes[hips].rest.translation;
  Vec3 shift = frame[hips].translation - offset;
  for (int above = skeleton.nodes[hips].parent; above >= 0; above = skeleton.nodes[above].parent) {
    shift = frame[above].rotation * shift;
    if (!has_all_positions(bvh, above)) continue;
    frame[above].translation += shift;
    frame[hips].translation = offset;
    return;
  }
}

}  // namespace

void lift_hips(const Character& character, const Humanoid& humanoid, std::vector<Pose>& frames) {
  if (!character.bvh || humanoid.root < 0 || has_all_positions(*character.bvh, humanoid.root)) return;
  for (Pose& frame : frames) lift(character.skeleton, *character.bvh, humanoid.root, frame);
}

}  // namespace ukemi
