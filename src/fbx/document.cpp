#include "fbx/document.h"

#include <algorithm>
#include <array>
#include <map>

#include "fbx/mesh_records.h"
#include "fbx/models.h"

namespace ukemi {
namespace {

// The code at the end of the file depends on the time of creation; these three values belong together (as
// Blender writes them).
constexpr std::array<std::uint8_t, 16> kFileId{0x28, 0xb3, 0x2a, 0xeb, 0xb6, 0x24, 0xcc, 0xc2,
                                               0xbf, 0xc8, 0xb0, 0x2a, 0xa9, 0x2b, 0xfc, 0xf1};
constexpr std::array<std::uint8_t, 16> kFileCode{0xfa, 0xbc, 0xab, 0x09, 0xd0, 0xc8, 0xd4, 0x66,
                                                 0xb1, 0x76, 0xfb, 0x83, 0x1c, 0xf7, 0x26, 0x7e};
constexpr const char* kCreationTime = "1970-01-01 10:00:00:000";
constexpr std::array<std::uint8_t, 16> kEndMark{0xf8, 0x5a, 0x8c, 0x6a, 0xde, 0xf5, 0xd9, 0x7e,
                                                0xec, 0xe9, 0x0c, 0xe3, 0x75, 0x8f, 0x29, 0x0b};
constexpr std::int32_t kVersion = 7400;

std::vector<std::uint8_t> tail() {
  std::vector<std::uint8_t> bytes(kFileCode.begin(), kFileCode.end());
  bytes.resize(bytes.size() + 4);
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(kVersion >> (8 * i)));
  bytes.resize(bytes.size() + 120);
  bytes.insert(bytes.end(), kEndMark.begin(), kEndMark.end());
  return bytes;
}

/// FBX's TimeMode of a frame rate; 14 has a rate of its own.
std::int32_t time_mode(double fps) {
  const std::pair<double, std::int32_t> modes[] = {{120, 1}, {100, 2}, {60, 3},  {50, 4},
                                                   {48, 5},  {30, 6},  {25, 10}, {24, 11}};
  for (const auto& [rate, mode] : modes)
    if (fps == rate) return mode;
  return 14;
}

FbxRecord header() {
  const auto number = [](const char* name, std::int32_t value) { return fbx_leaf(name, {fbx_int(value)}); };
  const std::vector<FbxRecord> stamp{number("Version", 1000), number("Year", 1970),    number("Month", 1),
                                     number("Day", 1),        number("Hour", 10),      number("Minute", 0),
                                     number("Second", 0),     number("Millisecond", 0)};
  return fbx_branch(
      "FBXHeaderExtension", {},
      {number("FBXHeaderVersion", 1003), number("FBXVersion", kVersion), number("EncryptionType", 0),
       fbx_branch("CreationTimeStamp", {}, stamp), fbx_leaf("Creator", {fbx_text("ukemi")})});
}

FbxRecord global_settings(double fps) {
  std::vector<FbxRecord> properties;
  const auto integer = [&](const char* name, std::int32_t value) {
    properties.push_back(property_record(name, "int", "Integer", "", {fbx_int(value)}));
  };
  const auto number = [&](const char* name, double value) {
    properties.push_back(property_record(name, "double", "Number", "", {fbx_double(value)}));
  };
  integer("UpAxis", 1), integer("UpAxisSign", 1);
  integer("FrontAxis", 2), integer("FrontAxisSign", 1);
  integer("CoordAxis", 0), integer("CoordAxisSign", 1);
  integer("OriginalUpAxis", -1), integer("OriginalUpAxisSign", 1);
  number("UnitScaleFactor", 1.0), number("OriginalUnitScaleFactor", 1.0);
  properties.push_back(property_record("TimeMode", "enum", "", "", {fbx_int(time_mode(fps))}));
  number("CustomFrameRate", fps);
  return fbx_branch(
      "GlobalSettings", {},
      {fbx_leaf("Version", {fbx_int(1000)}), fbx_branch("Properties70", {}, std::move(properties))});
}

FbxRecord documents(std::int64_t id) {
  return fbx_branch(
      "Documents", {},
      {fbx_leaf("Count", {fbx_int(1)}),
       fbx_branch("Document", {fbx_long(id), fbx_text("Scene"), fbx_text("Scene")},
                  {fbx_branch("Properties70", {},
                              {property_record("ActiveAnimStackName", "KString", "", "", {fbx_text("")})}),
                   fbx_leaf("RootNode", {fbx_long(0)})})});
}

bool is_bone(const FbxScene& scene, int node) {
  return std::binary_search(scene.bones.begin(), scene.bones.end(), node);
}

void add_attribute(const std::string& name, bool bone, std::int64_t model, FbxRecords& records) {
  const std::int64_t id = records.ids.next();
  const char* type = bone ? "LimbNode" : "Null";
  FbxRecord flags = fbx_leaf("TypeFlags", {fbx_text(bone ? "Skeleton" : "Null")});
  records.objects.push_back(fbx_branch(
      "NodeAttribute", {fbx_long(id), fbx_text(object_name(name, "NodeAttribute")), fbx_text(type)},
      {std::move(flags)}));
  records.connections.push_back(connection(id, model));
}

/// Nodes with a rigid mesh of their own are models of type Mesh.
bool carries_rigid_mesh(const FbxScene& scene, int node) {
  return !is_bone(scene, node) &&
         std::any_of(scene.parts.begin(), scene.parts.end(),
                     [node](const MeshPart& part) { return part.node == node && part.skin < 0; });
}

/// Models of the nodes, parents before children and siblings in their order. Ids by node, 0 for none.
std::vector<std::int64_t> add_nodes(const FbxScene& scene, FbxRecords& records) {
  std::vector<std::int64_t> ids(scene.skeleton.nodes.size(), 0);
  for (int node = 0; node < scene.skeleton.size(); ++node)
    if (!is_shell(scene, node)) ids[node] = records.ids.next();
  for (int node = 0; node < scene.skeleton.size(); ++node) {
    if (ids[node] == 0) continue;
    const Node& source = scene.skeleton.nodes[node];
    const std::string name = fbx_name(source.name, "node_" + std::to_string(node));
    const bool mesh = carries_rigid_mesh(scene, node);
    const char* type = mesh ? "Mesh" : is_bone(scene, node) ? "LimbNode" : "Null";
    records.objects.push_back(model_record(ids[node], name, type, source.rest));
    records.connections.push_back(connection(ids[node], source.parent < 0 ? 0 : ids[source.parent]));
    if (!mesh) add_attribute(name, is_bone(scene, node), ids[node], records);
  }
  return ids;
}

void add_bind_pose(const std::vector<BoundNode>& bound, const std::vector<std::int64_t>& ids,
                   FbxRecords& records) {
  std::map<int, Affine> once;
  for (const BoundNode& entry : bound) once.try_emplace(entry.node, entry.world_from_node);
  if (once.empty()) return;
  std::vector<FbxRecord> children{fbx_leaf("Type", {fbx_text("BindPose")}),
                                  fbx_leaf("Version", {fbx_int(100)}),
                                  fbx_leaf("NbPoseNodes", {fbx_int(static_cast<std::int32_t>(once.size()))})};
  for (const auto& [node, world] : once) {
    const Eigen::Matrix4d& m = world.matrix();
    children.push_back(
        fbx_branch("PoseNode", {},
                   {fbx_leaf("Node", {fbx_long(ids[node])}),
                    fbx_leaf("Matrix", {fbx_array(std::vector<double>(m.data(), m.data() + 16))})}));
  }
  records.objects.push_back(fbx_branch(
      "Pose", {fbx_long(records.ids.next()), fbx_text(object_name("", "Pose")), fbx_text("BindPose")},
      std::move(children)));
}

}  // namespace

FbxTree make_fbx_document(const FbxScene& scene) {
  FbxTree tree;
  tree.version = kVersion;
  tree.tail = tail();
  FbxIds ids(tree);
  FbxRecords records{ids, {}, {}};
  const std::int64_t document = ids.next();
  const std::vector<std::int64_t> models = add_nodes(scene, records);
  if (!scene.clip_only) add_bind_pose(add_meshes(scene, models, records), models, records);
  std::map<std::string, std::int32_t> counts{{"GlobalSettings", 1}};
  for (const FbxRecord& object : records.objects) ++counts[object.name];
  tree.records = {
      header(),
      fbx_leaf("FileId", {fbx_bytes(kFileId)}),
      fbx_leaf("CreationTime", {fbx_text(kCreationTime)}),
      fbx_leaf("Creator", {fbx_text("ukemi")}),
      global_settings(scene.fps),
      documents(document),
      fbx_branch("References", {}, {}),
      fbx_branch("Definitions", {}, {fbx_leaf("Version", {fbx_int(100)}), fbx_leaf("Count", {fbx_int(0)})}),
      fbx_branch("Objects", {}, std::move(records.objects)),
      fbx_branch("Connections", {}, std::move(records.connections)),
      fbx_branch("Takes", {}, {fbx_leaf("Current", {fbx_text("")})})};
  count_definitions(tree, std::move(counts));
  return tree;
}

}  // namespace ukemi
