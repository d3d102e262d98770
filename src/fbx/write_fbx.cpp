#include <algorithm>
#include <set>

#include "base/errors.h"
#include "export/stick_mesh.h"
#include "fbx/clip_into.h"
#include "fbx/document.h"
#include "fbx/fbx.h"
#include "fbx/models.h"
#include "load/text.h"

namespace ukemi {
namespace {

constexpr double kCentimetresPerMetre = 100.0;

std::set<int> skin_joints(const Character& character) {
  std::set<int> joints;
  for (const Skin& skin : character.skins) joints.insert(skin.joints.begin(), skin.joints.end());
  return joints;
}

/// Skin joints and the nodes between them. Without a skin every node but a scaled root is a bone, since
/// Blender ignores the scale of bones.
std::vector<int> bones_of(const Character& character, const Skeleton& skeleton) {
  std::set<int> bones = skin_joints(character);
  if (bones.empty())
    for (const int node : skeleton.order) {
      const Node& source = skeleton.nodes[node];
      if (source.parent >= 0 || source.rest.scale.isOnes(1e-6)) bones.insert(node);
    }
  const std::set<int> joints = bones;
  for (const int joint : joints) {
    std::vector<int> between;
    for (int node = skeleton.nodes[joint].parent; node >= 0; node = skeleton.nodes[node].parent) {
      between.push_back(node);
      if (joints.contains(node)) bones.insert(between.begin(), between.end());
    }
  }
  return {bones.begin(), bones.end()};
}

/// Bones, and a root joint that was put above them.
std::vector<int> with_root_joint_of(std::vector<int> bones, const Character& character) {
  const int last = character.skeleton.size() - 1;
  const bool above_bone = std::any_of(bones.begin(), bones.end(),
                                      [&](int b) { return character.skeleton.nodes[b].parent == last; });
  if (above_bone && bones.back() != last) bones.push_back(last);
  return bones;
}

LocalTransform converted(const LocalTransform& local, bool is_root, const Similarity& cm_from_file) {
  LocalTransform result = local;
  result.translation *= cm_from_file.scale;
  if (!is_root) return result;
  result.translation = cm_from_file.rotation * result.translation;
  result.rotation = cm_from_file.rotation * result.rotation;
  return result;
}

/// Blender's importer connects a bone to its parent where it stands on the parent's tip, straight along its y
/// axis, and lets a connected bone only turn. So bones that move are put a micrometre aside.
void untie(NodesOfTree& nodes) {
  const Vec3 aside(1e-4, 0.0, 1e-4);  // cm
  for (const int bone : nodes.bones) {
    Node& node = nodes.skeleton.nodes[bone];
    const bool moves = std::any_of(nodes.frames.begin(), nodes.frames.end(), [&](const Pose& pose) {
      return (pose[bone].translation - node.rest.translation).norm() > 1e-3;
    });
    if (!moves || !std::binary_search(nodes.bones.begin(), nodes.bones.end(), node.parent)) continue;
    node.rest.translation += aside;
    for (Pose& pose : nodes.frames) pose[bone].translation += aside;
  }
}

NodesOfTree in_centimetres(const Character& character, const Clip& clip, const Similarity& cm_from_file) {
  NodesOfTree nodes{character.skeleton, clip.frames, false,
                    with_root_joint_of(bones_of(character, character.skeleton), character)};
  for (int i = 0; i < nodes.skeleton.size(); ++i) {
    Node& node = nodes.skeleton.nodes[i];
    node.rest = converted(node.rest, node.parent < 0, cm_from_file);
    for (Pose& pose : nodes.frames) pose[i] = converted(pose[i], node.parent < 0, cm_from_file);
    node.name = fbx_name(node.name, "node_" + std::to_string(i));
  }
  untie(nodes);
  return nodes;
}

bool carries_skin(const Character& character, int node) {
  return std::any_of(character.parts.begin(), character.parts.end(),
                     [node](const MeshPart& part) { return part.node == node && part.skin >= 0; });
}

/// The scene is no model and cannot move, so its motion goes to its children. Skinned meshes follow their
/// bones and stay.
void pass_on_motion_of_scene(const Character& character, NodesOfTree& nodes) {
  const std::vector<int> children = nodes.skeleton.children()[0];
  const LocalTransform rest = nodes.skeleton.nodes[0].rest;
  for (Pose& pose : nodes.frames) {
    const LocalTransform scene = pose[0];
    pose[0] = rest;
    for (const int child : children) {
      if (carries_skin(character, child)) continue;
      pose[child].translation =
          scene.translation + scene.rotation * scene.scale.cwiseProduct(pose[child].translation);
      pose[child].rotation = scene.rotation * pose[child].rotation;
    }
  }
}

/// Nodes of a character that assimp read from an FBX.
NodesOfTree as_in_source(const Character& character, const Clip& clip) {
  NodesOfTree nodes{character.skeleton, clip.frames, true,
                    with_root_joint_of(bones_of(character, character.skeleton), character)};
  pass_on_motion_of_scene(character, nodes);
  return nodes;
}

/// The figure of a skeleton without a mesh, as a part with a skin of its own.
void add_figure(const Character& character, const Humanoid& humanoid, FbxScene& scene) {
  const StickMesh figure = make_stick_mesh(character, humanoid);
  if (figure.positions.empty() || character.skeleton.size() > 0xFFFF) return;
  MeshPart part;
  part.node = character.skeleton.order.front();
  part.skin = 0;
  part.positions = figure.positions;
  part.normals = figure.normals;
  Skin skin;
  for (int i = 0; i < character.skeleton.size(); ++i) skin.joints.push_back(i);
  skin.inverse_bind = figure.inverse_bind;
  for (std::size_t i = 0; i < figure.nodes.size(); ++i) {
    part.joints.push_back({static_cast<std::uint16_t>(figure.nodes[i]), 0, 0, 0});
    part.weights.push_back({1, 0, 0, 0});
    part.indices.push_back(static_cast<std::uint32_t>(i));
  }
  scene.parts = {std::move(part)};
  scene.skins = {std::move(skin)};
}

FbxTree made_document(const Character& character, const Humanoid& humanoid, const NodesOfTree& nodes,
                      const Similarity& cm_from_file, const Clip& clip, bool clip_only) {
  FbxScene scene{character,       nodes.skeleton,  cm_from_file, nodes.bones,
                 character.parts, character.skins, clip.fps,     clip_only};
  if (clip_only) scene.parts.clear();
  if (scene.parts.empty() && !clip_only) add_figure(character, humanoid, scene);
  return make_fbx_document(scene);
}

/// Removes objects that a clip alone does not need, with everything connected to them.
void keep_skeleton_only(FbxTree& tree) {
  const std::set<std::string> kept{"Model", "NodeAttribute"};
  FbxRecord* objects = section(tree, "Objects");
  FbxRecord* connections = section(tree, "Connections");
  if (objects == nullptr || connections == nullptr) return;
  std::set<std::int64_t> ids{0};
  std::map<std::string, std::int32_t> removed;
  std::vector<FbxRecord> objects_kept;
  for (FbxRecord& object : objects->children) {
    const bool keep = kept.contains(object.name) && text_at(object, 2) != "Mesh";
    if (!keep) {
      --removed[object.name];
      continue;
    }
    ids.insert(integer_at(object, 0).value_or(0));
    objects_kept.push_back(std::move(object));
  }
  objects->children = std::move(objects_kept);
  std::erase_if(connections->children, [&](const FbxRecord& record) {
    return !ids.contains(integer_at(record, 1).value_or(-1)) ||
           !ids.contains(integer_at(record, 2).value_or(-1));
  });
  if (FbxRecord* takes = section(tree, "Takes"))
    std::erase_if(takes->children, [](const FbxRecord& record) { return record.name == "Take"; });
  count_definitions(tree, std::move(removed));
}

}  // namespace

bool is_fbx(const Character& character) {
  return character.format == SourceFormat::assimp &&
         load::same_word(character.path.extension().string(), ".fbx");
}

Result<std::vector<std::uint8_t>> write_fbx(const Character& character, const Humanoid& humanoid,
                                            const Clip& clip, const FbxOptions& options,
                                            Diagnostics& diagnostics) {
  const auto& path = options.source_path.empty() ? character.path : options.source_path;
  if (clip.frames.empty() || clip.frames.front().size() != character.skeleton.nodes.size())
    return input_error(path, "the clip is empty or of another skeleton", "bake at least one frame");
  Similarity cm_from_file = humanoid.world_from_file;
  cm_from_file.scale *= kCentimetresPerMetre;
  const NodesOfTree nodes =
      is_fbx(character) ? as_in_source(character, clip) : in_centimetres(character, clip, cm_from_file);
  Result<FbxTree> tree = options.source.empty() ? made_document(character, humanoid, nodes, cm_from_file,
                                                                clip, options.clip_only)
                                                : read_fbx_tree(options.source, path);
  if (!tree) return tree.error();
  if (options.clip_only && !options.source.empty()) keep_skeleton_only(*tree);
  if (const Status status = add_clip(nodes, clip, path, *tree, diagnostics); !status) return status.error();
  return write_fbx_tree(*tree, path);
}

}  // namespace ukemi
