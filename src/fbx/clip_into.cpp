#include "fbx/clip_into.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "fbx/limits.h"
#include "fbx/models.h"
#include "fbx/take.h"
#include "load/text.h"

namespace ukemi {
namespace {

constexpr int kNoModel = -1;

Error other_skeleton(const std::filesystem::path& path, const std::string& joint, const char* what) {
  return error_about(joint, input_error(path, what, "export the file again, or write a .glb instead"));
}

/// assimp adds a number to a name that another node has: "Bone001".
bool is_name_of(const std::string& node, const std::string& model) {
  const std::string name = load::utf8_name(model);
  return node.starts_with(name) && std::all_of(node.begin() + static_cast<std::ptrdiff_t>(name.size()),
                                               node.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Pairs nodes with models, both in order: a node takes the first model with exactly its name, else the first
/// whose name assimp may have changed into it.
void pair_children(const Skeleton& skeleton, const FbxModels& all, const std::vector<int>& nodes,
                   const std::vector<int>& models, std::vector<int>& model_of) {
  std::vector<bool> taken(models.size(), false);
  const auto pair = [&](const auto& fits) {
    for (const int node : nodes)
      for (std::size_t i = 0; i < models.size() && model_of[node] == kNoModel; ++i)
        if (!taken[i] && fits(skeleton.nodes[node].name, all.models[models[i]].name)) {
          taken[i] = true;
          model_of[node] = models[i];
        }
  };
  pair([](const std::string& node, const std::string& model) { return node == load::utf8_name(model); });
  pair([](const std::string& node, const std::string& model) { return is_name_of(node, model); });
}

/// The model of every node; kNoModel where there is none.
std::vector<int> models_of_nodes(const NodesOfTree& nodes, const FbxModels& all) {
  const Skeleton& skeleton = nodes.skeleton;
  const auto children = skeleton.children();
  std::vector<int> model_of(skeleton.nodes.size(), kNoModel);
  std::vector<int> roots;
  for (const int node : skeleton.order)
    if (skeleton.nodes[node].parent < 0) roots.push_back(node);
  std::sort(roots.begin(), roots.end());
  pair_children(skeleton, all, nodes.has_scene_node ? children[0] : roots, all.roots, model_of);
  for (const int node : skeleton.order)
    if (model_of[node] != kNoModel)
      pair_children(skeleton, all, children[node], all.models[model_of[node]].children, model_of);
  return model_of;
}

bool same(const LocalTransform& a, const LocalTransform& b) {
  constexpr double kNear = 1e-9;
  return (a.translation - b.translation).norm() <= kNear * (1.0 + a.translation.norm()) &&
         angle_between(a.rotation, b.rotation) <= kNear && (a.scale - b.scale).norm() <= kNear;
}

/// Whether `node` ever leaves its rest transform.
bool moves(const NodesOfTree& nodes, int node) {
  const LocalTransform& rest = nodes.skeleton.nodes[node].rest;
  return std::any_of(nodes.frames.begin(), nodes.frames.end(),
                     [&](const Pose& pose) { return !same(pose[node], rest); });
}

/// The model's rest transform is the node's: both readers understood the file alike. Tolerance: 1e-4 of the
/// distance to the parent, and of a scaled axis.
bool stands_alike(const ModelTransform& model, const LocalTransform& rest) {
  constexpr double kNear = 1e-4;
  const Affine theirs = parent_from_model(model);
  const Affine ours = rest.affine();
  return (theirs.translation() - ours.translation()).norm() <= kNear * (1.0 + ours.translation().norm()) &&
         (theirs.linear() - ours.linear()).norm() <= kNear * std::max(1.0, ours.linear().norm());
}

ModelCurves curves_of(const NodesOfTree& nodes, int node, const FbxModel& model) {
  const Vec3 rest_scale = nodes.skeleton.nodes[node].rest.scale;
  ModelCurves curves{model.id, {}, {}, {}};
  Vec3 previous_deg = model.transform.rotation_deg;
  bool scales = false;
  for (const Pose& pose : nodes.frames) {
    const Vec3 factor = pose[node].scale.cwiseQuotient(rest_scale);
    scales = scales || !factor.isOnes(1e-9);
    const Vec3 scaling =
        factor.allFinite() ? Vec3(model.transform.scaling.cwiseProduct(factor)) : model.transform.scaling;
    const LocalValues values = local_values(model.transform, pose[node].affine(), scaling, previous_deg);
    previous_deg = values.rotation_deg;
    for (int i = 0; i < 3; ++i) {
      curves.translation[i].push_back(values.translation[i]);
      curves.rotation_deg[i].push_back(values.rotation_deg[i]);
      curves.scaling[i].push_back(values.scaling[i]);
    }
  }
  if (!scales) curves.scaling = {};
  return curves;
}

/// Moves `child` from its present parent to `parent`.
void move_below(FbxTree& tree, const FbxModels& all, std::int64_t child, std::int64_t parent) {
  const auto is_model = [&](std::int64_t id) {
    return id == 0 || std::any_of(all.models.begin(), all.models.end(),
                                  [id](const FbxModel& model) { return model.id == id; });
  };
  FbxRecord* connections = section(tree, "Connections");
  if (connections == nullptr) return;
  for (FbxRecord& record : connections->children)
    if (text_at(record, 0) == "OO" && integer_at(record, 1) == child &&
        is_model(integer_at(record, 2).value_or(-1)))
      record.properties[2] = fbx_long(parent);
}

/// The first few names.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kFew = 6;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kFew; ++i)
    text += (i > 0 ? ", " : "") + load::quoted(load::utf8_name(names[i]));
  return names.size() > kFew ? text + fmt::format(" and {} more", names.size() - kFew) : text;
}

/// A bone at its parent's origin, above `hips`.
void add_bone(FbxTree& tree, const std::string& name, std::int64_t parent, const FbxModel& hips) {
  FbxIds ids(tree);
  const std::int64_t id = ids.next();
  const std::int64_t attribute = ids.next();
  const FbxModels all = models_of(tree);
  FbxRecord* objects = section(tree, "Objects");
  FbxRecord* connections = section(tree, "Connections");
  if (objects == nullptr || connections == nullptr) return;
  objects->children.push_back(
      fbx_branch("NodeAttribute",
                 {fbx_long(attribute), fbx_text(object_name(name, "NodeAttribute")), fbx_text("LimbNode")},
                 {fbx_leaf("TypeFlags", {fbx_text("Skeleton")})}));
  objects->children.push_back(fbx_branch(
      "Model", {fbx_long(id), fbx_text(object_name(name, "Model")), fbx_text("LimbNode")},
      {fbx_leaf("Version", {fbx_int(232)}),
       fbx_branch("Properties70", {},
                  {property_record("InheritType", "enum", "", "", {fbx_int(1)}),
                   property_record("DefaultAttributeIndex", "int", "Integer", "", {fbx_int(0)})})}));
  move_below(tree, all, hips.id, id);
  connections->children.push_back(connection(attribute, id));
  connections->children.push_back(connection(id, parent));
  count_definitions(tree, {{"Model", 1}, {"NodeAttribute", 1}});
}

/// Adds the last node to the tree, between its parent and its only child, where the tree lacks it.
void add_root_joint(const NodesOfTree& nodes, FbxTree& tree) {
  const Skeleton& skeleton = nodes.skeleton;
  const int last = skeleton.size() - 1;
  const std::vector<int> below = skeleton.children()[last];
  const int above = skeleton.nodes[last].parent;
  if (below.size() != 1) return;
  NodesOfTree without{skeleton, {}, nodes.has_scene_node, {}};
  without.skeleton.nodes[below[0]].parent = above;
  without.skeleton.nodes[last].parent = -1;
  const FbxModels all = models_of(tree);
  const std::vector<int> with_it = models_of_nodes(nodes, all);
  if (with_it[last] != kNoModel) return;
  const std::vector<int> model_of = models_of_nodes(without, all);
  if (model_of[below[0]] == kNoModel) return;
  const bool in_scene = above < 0 || (nodes.has_scene_node && above == 0);
  if (!in_scene && model_of[above] == kNoModel) return;
  add_bone(tree, skeleton.nodes[last].name, in_scene ? 0 : all.models[model_of[above]].id,
           all.models[model_of[below[0]]]);
}

}  // namespace

Status add_clip(const NodesOfTree& nodes, const Clip& clip, const std::filesystem::path& path, FbxTree& tree,
                Diagnostics& diagnostics) {
  if (nodes.frames.empty()) return other_skeleton(path, "", "the clip is empty");
  add_root_joint(nodes, tree);
  const FbxModels all = models_of(tree);
  const std::vector<int> model_of = models_of_nodes(nodes, all);
  FbxTake take{clip.name, {}, {}};
  for (std::size_t i = 0; i < nodes.frames.size(); ++i)
    take.ticks.push_back(std::llround(static_cast<double>(i) / clip.fps * kTicksPerSecond));
  for (int node = 0; node < nodes.skeleton.size(); ++node) {
    const bool is_bone = std::binary_search(nodes.bones.begin(), nodes.bones.end(), node);
    const bool animated = moves(nodes, node);
    if (!is_bone && !animated) continue;
    const std::string label = nodes.skeleton.label(node);
    if (model_of[node] == kNoModel) {
      if (animated) return other_skeleton(path, label, "has no model of its own in the FBX");
      continue;
    }
    const FbxModel& model = all.models[model_of[node]];
    if (!animated && model.type != "LimbNode" && model.type != "Root") continue;
    if (!stands_alike(model.transform, nodes.skeleton.nodes[node].rest)) {
      if (animated) return other_skeleton(path, label, "stands elsewhere in the FBX than it was read");
      continue;
    }
    take.models.push_back(curves_of(nodes, node, model));
  }
  if (const std::vector<std::string> names = lift_limits(tree, take); !names.empty())
    diagnostics.warn(
        path.string(),
        fmt::format("limits of {} that the clip leaves are switched off in the FBX", listed(names)));
  add_take(tree, take);
  return Done{};
}

}  // namespace ukemi
