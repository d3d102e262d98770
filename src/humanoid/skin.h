// The character's surface in a pose.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/character.h"
#include "humanoid/humanoid.h"

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

/// A node and how far the vertices that it carries lie from it in the mean, file units.
struct CarriedSkin {
  int node = -1;
  double distance = 0.0;
};
/// Of every joint of a skin that carries vertices, in the order of the nodes.
std::vector<CarriedSkin> carried_skin(const Character& character, const std::vector<Affine>& world_from_node);

/// Farther from its joint than any skin of a body: its bind pose has nothing to do with the skeleton.
inline bool is_astray(double distance, double height) { return distance > 0.6 * height; }

/// Points on the edges of triangles whose ends both count, at most `spacing` apart, file units.
std::vector<Vec3> surface_points(const Character& character, const std::vector<Affine>& world_from_node,
                                 double spacing, const std::function<bool(int node)>& counts);

/// The segment that moves each node and its skin: the node's own, or that of the node above it; the pelvis
/// for what hangs on the root and for the nodes above it; nothing for what belongs to no part of the body.
std::vector<std::optional<Segment>> segments_of_nodes(const Skeleton& skeleton, const Humanoid& humanoid);

/// Scenery: a mesh without a skin, on no bone of the body.
bool is_scenery(const Skeleton& skeleton, const Humanoid& humanoid, const MeshPart& part);

}  // namespace ukemi
