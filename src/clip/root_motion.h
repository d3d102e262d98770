// The motion of a clip over the ground: on the hips, on a root joint above them, or left out.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// What takes the motion over the ground: the hips as simulated, the root joint above them (the rig's own
/// where it has one, else one that is added to the skin), or nothing.
enum class RootMotion { hips, root, in_place };
std::string_view name(RootMotion motion);  // "hips", "root", "in-place"

struct GroundPlacement {
  RootMotion root_motion = RootMotion::hips;
  bool align = false;  // starts at the origin, facing +z
};

/// The clip as files get it.
struct ExportedClip {
  Clip clip;
  Clip on_hips;  // root: the same without the root joint, for a BVH
  /// With a root joint that the character does not have: the character with it, at the end of the nodes.
  std::optional<Character> with_root;
  Humanoid humanoid;  // fits the character in use
  int root_joint = -1;
  /// Way of the pelvis over the ground since the first frame, world, metres, one per frame; empty for hips.
  std::vector<Vec3> root_curve;
};

/// The clip turned to face +z from the origin where that is asked for, and its motion over the ground put
/// where `placement` says. `start_pelvis`: the pelvis of the start pose, world. Errors: input (a document
/// that takes no root joint).
Result<ExportedClip> exported_clip(const Character& character, const Humanoid& humanoid,
                                   const Rigid& start_pelvis, const Clip& clip,
                                   const GroundPlacement& placement);

}  // namespace ukemi
