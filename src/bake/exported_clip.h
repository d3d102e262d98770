// A clip as files get it: aligned, its motion over the ground where it is asked for.
#pragma once

#include <optional>
#include <vector>

#include "bake/bake.h"

namespace ukemi {

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

/// The clip turned to face +z from the origin (settings.align) and its motion over the ground put where
/// settings.root_motion says. Errors: input (a document that takes no root joint).
Result<ExportedClip> exported_clip(const Character& character, const BakeSettings& settings,
                                   const BakeOutcome& outcome);

}  // namespace ukemi
