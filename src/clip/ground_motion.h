// Figures moved over the ground: facing, placing, and the root motion that engines ask for.
#pragma once

#include <vector>

#include "base/math.h"
#include "base/skeleton.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// `v` without its height.
Vec3 level(const Vec3& v);

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

}  // namespace ukemi
