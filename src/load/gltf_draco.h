// KHR_draco_mesh_compression.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "load/gltf_accessors.h"
#include "load/json_view.h"

namespace ukemi::load {

/// A decompressed primitive: triangles and, per attribute, the components of every vertex.
struct DracoMesh {
  std::size_t vertex_count = 0;
  std::vector<std::uint32_t> indices;
  std::map<std::string, std::vector<float>> attributes;
};

/// Decodes a primitive's extension; `primitive` says which accessor describes each attribute. Throws Refusal.
DracoMesh decode_draco(const JsonView& extension, const JsonView& primitive, Accessors& accessors);

}  // namespace ukemi::load
