// Figures moved over the ground: facing, placing, and the root motion that engines ask for.
#pragma once

#include <vector>

#include "bake/bake.h"

namespace ukemi {

/// Yaw of a segment about the world's y: where it faces once its own up axis is turned upright by the
/// shortest way. 0 faces +x.
double facing(const Quat& world_from_segment);

/// A turn about a vertical axis, then a horizontal shift.
struct GroundMove {
  double yaw = 0.0;
  Vec3 from = Vec3::Zero();  // turned about this point,
  Vec3 to = Vec3::Zero();    // which then lies here

  Rigid operator*(const Rigid& segment) const;
  /// The pose with root and detached segments moved.
  Pose moved(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose) const;
};

/// The move that takes the mean position and facing of some segments to that of others.
GroundMove ground_move(const std::vector<Rigid>& from, const std::vector<Rigid>& to);

/// Nodes that move when the figure does: the humanoid's root and detached segments.
std::vector<int> movers(const Skeleton& skeleton, const Humanoid& humanoid);

/// Moves nodes by `offset` (world, metres).
void displace(const Skeleton& skeleton, const Humanoid& humanoid, const std::vector<int>& nodes,
              const Vec3& offset, Pose& pose);

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
