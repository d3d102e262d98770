// Meshes, their skins and materials as records of an FBX.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"
#include "fbx/models.h"
#include "fbx/scene.h"

namespace ukemi {

/// A node's transform in the bind pose.
struct BoundNode {
  int node = -1;
  Affine world_from_node = Affine::Identity();  // centimetres
};

/// Adds the meshes: a geometry for each node and skin, on the node's own model where that is no bone, and on
/// one of its own in the scene where it is skinned. `model_ids`: of each node, 0 for none; those of skinned
/// meshes without further use are not made by the caller (is_shell). Returns the bind pose.
std::vector<BoundNode> add_meshes(const FbxScene& scene, const std::vector<std::int64_t>& model_ids,
                                  FbxRecords& records);

/// Whether a node does nothing but carry skinned meshes. It gets no model: its meshes stand in the scene.
bool is_shell(const FbxScene& scene, int node);

/// A model record.
FbxRecord model_record(std::int64_t id, const std::string& name, const char* type,
                       const LocalTransform& local);

}  // namespace ukemi
