// Meshes, materials and images of a glTF document.
#pragma once

#include <filesystem>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "load/gltf_accessors.h"
#include "load/json_view.h"

namespace ukemi::load {

/// A material and how its base colour texture is looked up.
struct TexturedMaterial {
  Material material;
  int uv_set = 0;  // TEXCOORD_n
  Eigen::Affine2f uv_transform = Eigen::Affine2f::Identity();
};

/// An image whose file is missing is left empty, with a warning. Throws Refusal.
std::vector<Image> read_images(const JsonView& root, Accessors& accessors,
                               const std::filesystem::path& folder, const std::filesystem::path& path,
                               Diagnostics& diagnostics);
std::vector<TexturedMaterial> read_materials(const JsonView& root, std::size_t image_count);

/// What a primitive is read for.
struct PrimitiveUse {
  int node = -1;
  int skin = -1;
  std::size_t joint_count = 0;        // of the skin
  std::vector<double> morph_weights;  // of node or mesh; may be empty
};
/// The triangles of one primitive; no indices for points and lines. Throws Refusal.
MeshPart read_primitive(const JsonView& primitive, const PrimitiveUse& use,
                        const std::vector<TexturedMaterial>& materials, Accessors& accessors);

}  // namespace ukemi::load
