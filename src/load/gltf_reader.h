// The glTF reader behind read_gltf, for documents from files and for those that the loader writes itself.
#pragma once

#include <optional>

#include "base/character.h"
#include "load/gltf_container.h"

namespace ukemi::load {

/// Nearest translation, rotation and scale of an affine matrix.
struct Decomposition {
  LocalTransform local;
  double shear = 0.0;  // largest cosine between two axes; 0 for a matrix that is exactly T * R * S
};
Decomposition decompose(const Eigen::Matrix4d& matrix);

/// The character in a document whose relative URIs start at the path's folder. Errors: input.
Result<Character> read_container(GltfContainer container, const std::filesystem::path& path,
                                 Diagnostics& diagnostics);

/// Turns animations whose extras call them additive into the motion they make when added to the pose they
/// were taken from: the nodes of "from" ({NODE: {"translation", "rotation", "scale"}}), the others at rest.
void restore_additive(Character& character);

}  // namespace ukemi::load
