// The character's surface in a pose.
#pragma once

#include <functional>
#include <vector>

#include "base/character.h"

namespace ukemi {

/// Extent along a direction, file units.
struct SkinExtent {
  bool found = false;
  double min = 0.0;
  double max = 0.0;
};

/// Extent of every vertex along `direction` (linear blend skinning; rigid parts with their node).
/// `counts(node)`: which vertices count, by the node that carries them (the joint of the largest weight).
SkinExtent skin_extent(const Character& character, const std::vector<Affine>& world_from_node,
                       const Vec3& direction, const std::function<bool(int node)>& counts = {});

/// Which nodes carry vertices: most of a skinned one's weight, or a mesh of their own.
std::vector<char> carries_skin(const Character& character);

}  // namespace ukemi
