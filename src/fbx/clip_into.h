// A clip as a take of an FBX whose models are the skeleton's nodes.
#pragma once

#include <filesystem>

#include "base/animation.h"
#include "base/result.h"
#include "fbx/tree.h"

namespace ukemi {

/// What stands for what, in the units and axes of the tree.
struct NodesOfTree {
  Skeleton skeleton;
  std::vector<Pose> frames;
  /// Node 0 is the scene itself, as assimp has it, and not a model.
  bool has_scene_node = false;
  std::vector<int> bones;  // keyed even where they rest
};

/// Finds each node's model, in the order of the hierarchy and by name; a node behind the others of which the
/// tree knows nothing (a root joint) becomes a bone of its own. Errors: input, when a node that moves has no
/// model or one that stands elsewhere. Limits that the clip leaves are switched off, with a warning.
Status add_clip(const NodesOfTree& nodes, const Clip& clip, const std::filesystem::path& path, FbxTree& tree,
                Diagnostics& diagnostics);

}  // namespace ukemi
