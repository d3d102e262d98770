// A simple figure for skeletons without a mesh, so that their clips can be seen in any viewer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Flat-shaded triangles, three vertices each, in file units, in the pose `Humanoid::reference`; each vertex
/// moves with one node.
struct StickMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<int> nodes;            // per vertex
  std::vector<Affine> inverse_bind;  // per node of the skeleton
};

/// An elongated octahedron from every node of the body to each of its children and End Sites. Empty when no bone has a
/// length.
StickMesh make_stick_mesh(const Character& character, const Humanoid& humanoid);

}  // namespace ukemi
