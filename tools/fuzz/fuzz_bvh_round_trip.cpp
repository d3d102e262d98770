// BVH read, written and read again: the same joints, channels and rotations.
#include <algorithm>
#include <cmath>

#include "export/export.h"
#include "fuzz/checks.h"
#include "load/load.h"

namespace {

using namespace ukemi;

constexpr double kLargest = 1e6;  // beyond, rounding is larger than the tolerance
constexpr std::size_t kMostFrames = 50;

/// Whether all numbers are of a size that a motion can have.
bool is_moderate(const Character& character) {
  for (const auto& row : character.bvh->frames)
    for (const double v : row)
      if (std::abs(v) > kLargest) return false;
  for (const Node& node : character.skeleton.nodes)
    if (node.rest.translation.cwiseAbs().maxCoeff() > kLargest) return false;
  return character.bvh->frames.size() <= kMostFrames && character.bvh->frame_time_s > 1e-4;
}

/// A joint with fewer than three rotation channels cannot take every rotation.
bool same(const LocalTransform& a, const LocalTransform& b) {
  return (a.translation - b.translation).norm() < 1e-6 * (1.0 + a.translation.norm()) &&
         angle_between(a.rotation, b.rotation) < 1e-5;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Diagnostics diagnostics;
  const auto first = read_bvh(fuzz::text_of(data, size), "folder/input.bvh", diagnostics);
  if (!first || !is_moderate(*first)) return 0;
  const Animation& animation = first->animations.front();
  const Clip clip = sample_clip(first->skeleton, animation, animation.fps);
  const auto text = write_bvh(*first, Humanoid{}, clip, BvhOptions{}, diagnostics);
  fuzz::require(static_cast<bool>(text), "what was read can be written");
  const auto second = read_bvh(*text, "folder/output.bvh", diagnostics);
  if (!second) std::fputs((second.error().message() + '\n').c_str(), stderr);
  fuzz::require(static_cast<bool>(second), "what was written can be read");
  fuzz::require_sound(*second);
  fuzz::require(second->skeleton.size() == first->skeleton.size(), "the joints are the same");
  fuzz::require(second->bvh->channels == first->bvh->channels, "the channels are the same");
  fuzz::require(second->bvh->frames.size() == clip.frames.size(), "the frames are the same");
  const Animation& again = second->animations.front();
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const Pose pose = sample(second->skeleton, again, static_cast<double>(i) / again.fps);
    for (int joint = 0; joint < first->skeleton.size(); ++joint)
      fuzz::require(same(clip.frames[i][joint], pose[joint]), "the motion is the same");
  }
  return 0;
}
