// A clip as a take of an FBX whose models are the skeleton's nodes.
#pragma once

#include <filesystem>

#include "base/animation.h"
#include "base/result.h"
#include "fbx/tree.h"

namespace ukemi {

/// The character's nodes and its motion in the units and axes of the tree.
struct NodesOfTree {
  Skeleton skeleton;
  std::vector<Pose> frames;
  /// Node 0 is the scene itself, as assimp has it, and not a model.
  bool has_scene_node = false;
  std::vector<int> bones;  // keyed even where they rest
};

/// Finds the model of each node by name and by order in the hierarchy. A last node that the tree lacks (a
/// root joint that was added) becomes a new bone. Errors: input, when a node that moves has no model or one
/// that stands elsewhere. Limits that the clip leaves are switched off, with a warning.
Status add_clip(const NodesOfTree& nodes, const Clip& clip, const std::filesystem::path& path, FbxTree& tree,
                Diagnostics& diagnostics);

}  // namespace ukemi
