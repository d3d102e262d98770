#include "fbx/mesh_records.h"

#include <algorithm>
#include <map>

#include "fbx/material_records.h"

namespace ukemi {
namespace {

/// The parts of one node with one skin: they become one geometry.
struct MeshGroup {
  int node = -1;
  int skin = -1;
  std::vector<const MeshPart*> parts;
  std::vector<int> materials;  // of the parts, each once

  std::int32_t slot_of(const MeshPart& part) const {
    const auto found = std::find(materials.begin(), materials.end(), part.material);
    return static_cast<std::int32_t>(found - materials.begin());
  }
};

std::vector<MeshGroup> groups_of(const FbxScene& scene) {
  std::vector<MeshGroup> groups;
  for (const MeshPart& part : scene.parts) {
    auto found = std::find_if(groups.begin(), groups.end(), [&](const MeshGroup& group) {
      return group.node == part.node && group.skin == part.skin;
    });
    if (found == groups.end()) found = groups.insert(found, {part.node, part.skin, {}, {}});
    if (found->slot_of(part) == static_cast<std::int32_t>(found->materials.size()))
      found->materials.push_back(part.material);
    found->parts.push_back(&part);
  }
  return groups;
}

/// A transform M of the file in centimetres: K M K^-1 with K the change of unit. Roots are turned as well.
Affine in_cm(const Affine& transform, double scale) {
  Affine result = transform;
  result.translation() *= scale;
  return result;
}

/// Transform of the mesh that puts its first bone in its bind pose: centimetres from (scaled) mesh space.
Affine world_from_mesh(const FbxScene& scene, const Skin& skin) {
  const std::vector<Affine> worlds = world_transforms(scene.skeleton, rest_pose(scene.skeleton));
  if (skin.joints.empty()) return Affine::Identity();
  const Affine placed = worlds[skin.joints[0]] * in_cm(skin.inverse_bind[0], scene.cm_from_file.scale);
  return placed.matrix().allFinite() ? placed : Affine::Identity();
}

class GeometryWriter {
 public:
  GeometryWriter(const MeshGroup& group, double scale, const Affine& placed) : group_(group) {
    const Mat3 normal_matrix = placed.linear().inverse().transpose();
    const bool mirrored = placed.linear().determinant() < 0.0;
    for (const MeshPart* part : group.parts) {
      const auto first = static_cast<std::int32_t>(vertices_.size() / 3);
      for (const Eigen::Vector3f& position : part->positions)
        append(vertices_, placed * (scale * position.cast<double>()));
      for (std::size_t i = 0; i + 2 < part->indices.size(); i += 3)
        add_triangle(*part, i, mirrored, first, normal_matrix);
      for (std::size_t v = 0; has_uvs() && v < part->positions.size(); ++v) {
        const Eigen::Vector2f uv = part->uvs.empty() ? Eigen::Vector2f(0, 1) : part->uvs[v];
        uvs_.push_back(static_cast<double>(uv.x()));
        uvs_.push_back(1.0 - static_cast<double>(uv.y()));
      }
    }
  }

  FbxRecord record(std::int64_t id, const std::string& name) {
    std::vector<FbxRecord> children;
    children.push_back(fbx_branch("Properties70", {}, {}));
    children.push_back(fbx_leaf("GeometryVersion", {fbx_int(124)}));
    children.push_back(fbx_leaf("Vertices", {fbx_array(vertices_)}));
    children.push_back(fbx_leaf("PolygonVertexIndex", {fbx_array(polygons_)}));
    std::vector<FbxRecord> layer{fbx_leaf("Version", {fbx_int(100)})};
    const auto add = [&](const char* element, std::vector<FbxRecord> content) {
      layer.push_back(fbx_branch(
          "LayerElement", {}, {fbx_leaf("Type", {fbx_text(element)}), fbx_leaf("TypedIndex", {fbx_int(0)})}));
      children.push_back(fbx_branch(element, {fbx_int(0)}, std::move(content)));
    };
    if (!normals_.empty())
      add("LayerElementNormal",
          element("ByPolygonVertex", "Direct", {fbx_leaf("Normals", {fbx_array(normals_)})}));
    if (!uvs_.empty())
      add("LayerElementUV",
          element("ByPolygonVertex", "IndexToDirect",
                  {fbx_leaf("UV", {fbx_array(uvs_)}), fbx_leaf("UVIndex", {fbx_array(corners_)})}));
    add("LayerElementMaterial",
        element("ByPolygon", "IndexToDirect", {fbx_leaf("Materials", {fbx_array(materials_)})}));
    children.push_back(fbx_branch("Layer", {fbx_int(0)}, std::move(layer)));
    return fbx_branch("Geometry", {fbx_long(id), fbx_text(object_name(name, "Geometry")), fbx_text("Mesh")},
                      std::move(children));
  }

 private:
  static void append(std::vector<double>& numbers, const Vec3& v) {
    numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  }
  bool has_uvs() const {
    return std::any_of(group_.parts.begin(), group_.parts.end(),
                       [](const MeshPart* part) { return !part->uvs.empty(); });
  }
  bool has_normals() const {
    return std::all_of(group_.parts.begin(), group_.parts.end(),
                       [](const MeshPart* part) { return !part->normals.empty(); });
  }

  /// The last corner of a polygon is written as -1 - index.
  void add_triangle(const MeshPart& part, std::size_t at, bool mirrored, std::int32_t first,
                    const Mat3& normal_matrix) {
    for (const std::size_t k :
         {std::size_t{0}, std::size_t{mirrored ? 2u : 1u}, std::size_t{mirrored ? 1u : 2u}}) {
      const std::uint32_t vertex = part.indices[at + k];
      corners_.push_back(first + static_cast<std::int32_t>(vertex));
      polygons_.push_back(corners_.back());
      if (has_normals()) append(normals_, (normal_matrix * part.normals[vertex].cast<double>()).normalized());
    }
    polygons_.back() = -1 - polygons_.back();
    materials_.push_back(group_.slot_of(part));
  }

  static std::vector<FbxRecord> element(const char* mapping, const char* reference,
                                        std::vector<FbxRecord> content) {
    std::vector<FbxRecord> records{fbx_leaf("Version", {fbx_int(101)}), fbx_leaf("Name", {fbx_text("")}),
                                   fbx_leaf("MappingInformationType", {fbx_text(mapping)}),
                                   fbx_leaf("ReferenceInformationType", {fbx_text(reference)})};
    std::move(content.begin(), content.end(), std::back_inserter(records));
    return records;
  }

  const MeshGroup& group_;
  std::vector<double> vertices_, normals_, uvs_;
  std::vector<std::int32_t> polygons_, corners_, materials_;
};

std::vector<double> matrix_of(const Affine& affine) {
  const Eigen::Matrix4d& m = affine.matrix();
  return {m.data(), m.data() + 16};  // by columns, the translation last
}

/// Vertices (of the merged geometry) and weights of one joint.
struct Influences {
  std::vector<std::int32_t> vertices;
  std::vector<double> weights;
};

std::map<int, Influences> influences_of(const MeshGroup& group) {
  std::map<int, Influences> of_joint;
  std::int32_t first = 0;
  for (const MeshPart* part : group.parts) {
    for (std::size_t v = 0; v < part->joints.size(); ++v)
      for (std::size_t k = 0; k < 4; ++k) {
        if (part->weights[v][k] <= 0.0f) continue;
        Influences& joint = of_joint[part->joints[v][k]];
        const auto vertex = first + static_cast<std::int32_t>(v);
        if (!joint.vertices.empty() && joint.vertices.back() == vertex) {
          joint.weights.back() += static_cast<double>(part->weights[v][k]);
          continue;
        }
        joint.vertices.push_back(vertex);
        joint.weights.push_back(static_cast<double>(part->weights[v][k]));
      }
    first += static_cast<std::int32_t>(part->positions.size());
  }
  return of_joint;
}

FbxRecord cluster_record(std::int64_t id, const std::string& name, const Influences& influences,
                         const Affine& bind) {
  std::vector<FbxRecord> children{fbx_leaf("Version", {fbx_int(100)}),
                                  fbx_leaf("UserData", {fbx_text(""), fbx_text("")})};
  if (!influences.vertices.empty()) {
    children.push_back(fbx_leaf("Indexes", {fbx_array(influences.vertices)}));
    children.push_back(fbx_leaf("Weights", {fbx_array(influences.weights)}));
  }
  children.push_back(fbx_leaf("Transform", {fbx_array(matrix_of(bind.inverse()))}));
  children.push_back(fbx_leaf("TransformLink", {fbx_array(matrix_of(bind))}));
  return fbx_branch("Deformer",
                    {fbx_long(id), fbx_text(object_name(name, "SubDeformer")), fbx_text("Cluster")},
                    std::move(children));
}

/// The skin of a geometry whose model stands in the scene without a transform.
void add_skin(const FbxScene& scene, const MeshGroup& group, const Affine& placed, std::int64_t geometry,
              const std::vector<std::int64_t>& model_ids, FbxRecords& records,
              std::vector<BoundNode>& bind_pose) {
  const Skin& skin = scene.skins[group.skin];
  std::map<int, Influences> influences = influences_of(group);
  const std::int64_t deformer = records.ids.next();
  records.objects.push_back(
      fbx_branch("Deformer", {fbx_long(deformer), fbx_text(object_name("", "Deformer")), fbx_text("Skin")},
                 {fbx_leaf("Version", {fbx_int(101)}), fbx_leaf("Link_DeformAcuracy", {fbx_double(50.0)})}));
  records.connections.push_back(connection(deformer, geometry));
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const int node = skin.joints[j];
    const Affine bind = placed * in_cm(skin.inverse_bind[j].inverse(), scene.cm_from_file.scale);
    if (model_ids[node] == 0 || !bind.matrix().allFinite()) continue;
    const std::int64_t cluster = records.ids.next();
    records.objects.push_back(
        cluster_record(cluster, scene.skeleton.nodes[node].name, influences[static_cast<int>(j)], bind));
    records.connections.push_back(connection(cluster, deformer));
    records.connections.push_back(connection(model_ids[node], cluster));
    bind_pose.push_back({node, bind});
  }
}

/// The model that carries the group's geometry.
std::int64_t carrier_of(const FbxScene& scene, const MeshGroup& group,
                        const std::vector<std::int64_t>& model_ids, FbxRecords& records) {
  const bool skinned = group.skin >= 0;
  const bool is_bone = std::binary_search(scene.bones.begin(), scene.bones.end(), group.node);
  if (!skinned && !is_bone) return model_ids[group.node];
  const std::int64_t id = records.ids.next();
  const std::string node = fbx_name(scene.skeleton.nodes[group.node].name, "mesh");
  const bool shell = is_shell(scene, group.node);
  records.objects.push_back(model_record(id, shell ? node : node + "_mesh", "Mesh", {}));
  records.connections.push_back(connection(id, skinned ? 0 : model_ids[group.node]));
  return id;
}

}  // namespace

FbxRecord model_record(std::int64_t id, const std::string& name, const char* type,
                       const LocalTransform& local) {
  const LocalValues values = local_values({}, local.affine(), local.scale, Vec3::Zero());
  const auto vector = [](const char* property, const Vec3& v) {
    return property_record(property, property, "", "A",
                           {fbx_double(v.x()), fbx_double(v.y()), fbx_double(v.z())});
  };
  return fbx_branch(
      "Model", {fbx_long(id), fbx_text(object_name(name, "Model")), fbx_text(type)},
      {fbx_leaf("Version", {fbx_int(232)}),
       fbx_branch("Properties70", {},
                  {property_record("RotationActive", "bool", "", "", {fbx_int(1)}),
                   property_record("InheritType", "enum", "", "", {fbx_int(1)}),
                   property_record("DefaultAttributeIndex", "int", "Integer", "", {fbx_int(0)}),
                   vector("Lcl Translation", values.translation), vector("Lcl Rotation", values.rotation_deg),
                   vector("Lcl Scaling", values.scaling)}),
       fbx_leaf("Shading", {FbxProperty{'C', {1}}}), fbx_leaf("Culling", {fbx_text("CullingOff")})});
}

bool is_shell(const FbxScene& scene, int node) {
  const auto carries = [&](const MeshPart& part) { return part.node == node; };
  const auto skinned = [&](const MeshPart& part) { return part.node != node || part.skin >= 0; };
  const bool has_children = std::any_of(scene.skeleton.nodes.begin(), scene.skeleton.nodes.end(),
                                        [&](const Node& other) { return other.parent == node; });
  return !has_children && !std::binary_search(scene.bones.begin(), scene.bones.end(), node) &&
         std::any_of(scene.parts.begin(), scene.parts.end(), carries) &&
         std::all_of(scene.parts.begin(), scene.parts.end(), skinned);
}

std::vector<BoundNode> add_meshes(const FbxScene& scene, const std::vector<std::int64_t>& model_ids,
                                  FbxRecords& records) {
  std::vector<BoundNode> bind_pose;
  std::map<int, std::int64_t> materials = add_materials(scene, records);
  for (const MeshGroup& group : groups_of(scene)) {
    const bool skinned = group.skin >= 0;
    const Affine placed = skinned ? world_from_mesh(scene, scene.skins[group.skin]) : Affine::Identity();
    const std::string name = fbx_name(scene.skeleton.nodes[group.node].name, "mesh");
    const std::int64_t geometry = records.ids.next();
    records.objects.push_back(GeometryWriter(group, scene.cm_from_file.scale, placed).record(geometry, name));
    const std::int64_t carrier = carrier_of(scene, group, model_ids, records);
    records.connections.push_back(connection(geometry, carrier));
    for (const int material : group.materials)
      records.connections.push_back(connection(materials[material], carrier));
    if (skinned) add_skin(scene, group, placed, geometry, model_ids, records, bind_pose);
  }
  return bind_pose;
}

}  // namespace ukemi
