// What a file holds, after loading: the skeleton, its motion, its skin, and the document to write back.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/animation.h"
#include "base/skeleton.h"

namespace ukemi {

struct Image {
  std::string mime;                 // "image/png", "image/jpeg"
  std::vector<std::uint8_t> bytes;  // as in the file, still encoded
};

struct Material {
  std::string name;
  std::array<float, 4> base_color{1, 1, 1, 1};  // linear, with alpha
  int base_color_image = -1;
  enum class Alpha { opaque, mask, blend } alpha = Alpha::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
};

/// Joints of a skin and, for each, joint_from_mesh in the bind pose (the inverse-bind matrix).
struct Skin {
  std::vector<int> joints;  // nodes
  std::vector<Affine> inverse_bind;
};

/// Triangles of one material. Vertex arrays are either empty or as long as `positions`.
/// Contract: joints index skins[skin].joints; weights are >= 0 and sum to 1; indices are in range and a
/// multiple of three. Morph defaults are applied.
struct MeshPart {
  int node = -1;      // node that carries the mesh
  int skin = -1;      // -1: rigid on its node
  int material = -1;  // -1: default
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<std::array<float, 4>> colors;  // linear RGBA
  std::vector<std::array<std::uint16_t, 4>> joints;
  std::vector<std::array<float, 4>> weights;
  std::vector<std::uint32_t> indices;
};

/// A glTF document as it stood in the file: the JSON text and every buffer it names.
struct GltfDocument {
  std::string json;
  std::vector<std::vector<std::uint8_t>> buffers;  // buffer i of the JSON, resolved
  std::vector<std::uint8_t> extra_chunks;          // GLB chunks after BIN, kept as they are
  bool is_glb = false;
  std::filesystem::path folder;  // where relative URIs point to
};

enum class BvhChannel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

/// What a BVH needs to be written back as it was. Joint i is node i of the skeleton.
struct BvhSource {
  std::vector<std::vector<BvhChannel>> channels;  // per joint
  std::vector<std::optional<Vec3>> end_site;      // per joint: offset of its End Site
  double frame_time_s = 0.0;
  /// Positions below the root are added to the offsets, not put in their place.
  bool positions_add = false;
  std::vector<std::vector<double>> frames;  // raw rows, file units and degrees
};

enum class SourceFormat { gltf, bvh, assimp };

/// A loaded file. Everything is in the file's own units and axes.
struct Character {
  std::string name;            // file name without extension
  std::filesystem::path path;  // as the user wrote it
  SourceFormat format = SourceFormat::gltf;
  Skeleton skeleton;
  std::vector<Animation> animations;
  std::vector<MeshPart> parts;
  std::vector<Skin> skins;
  std::vector<Material> materials;
  std::vector<Image> images;
  GltfDocument document;                               // gltf: the file's; bvh, assimp: written by the loader
  std::optional<BvhSource> bvh;                        // where the file is a BVH
  std::vector<std::pair<std::string, int>> vrm_bones;  // VRM human bone name, node
  std::optional<double> metres_per_unit;               // where the file states its unit (FBX, DAE, our BVH)
  std::optional<Quat> yup_from_file;  // where the file states its up axis (FBX, DAE, our BVH)
};

}  // namespace ukemi
