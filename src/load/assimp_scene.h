// Converts what assimp reads to a glTF document.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "base/math.h"
#include "base/result.h"
#include "load/gltf_container.h"

namespace ukemi::load {

/// A document written from a scene, and what the file says of its unit and axes.
struct SceneDocument {
  GltfContainer container;
  std::optional<double> metres_per_unit;
  std::optional<Quat> yup_from_file;
};

/// The only call into assimp, with the importer of the path's extension. Call it in a process of its own:
/// assimp has open memory bugs. Errors: input (unknown extension, unreadable). Throws what assimp throws.
Result<SceneDocument> document_from_scene(std::span<const std::uint8_t> bytes,
                                          const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace ukemi::load
