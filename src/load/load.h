// Reads files: .glb .gltf .vrm and .bvh directly, everything else through assimp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

struct LoadOptions {
  std::size_t max_file_bytes = 512u << 20;  // larger files are refused
};

/// The character or clip in a file, chosen by its extension (and content for .glb/.gltf/.vrm).
/// Units and axes are the file's own. Errors: input (missing, directory, empty, unknown extension,
/// malformed; with line for BVH and JSON pointer or byte offset in `what` for glTF).
Result<Character> load_character(const std::filesystem::path& path, const LoadOptions& options,
                                 Diagnostics& diagnostics);

/// The readers on bytes; `path` names the file in errors and resolves relative URIs.
Result<Character> read_bvh(std::string_view text, const std::filesystem::path& path,
                           Diagnostics& diagnostics);
Result<Character> read_gltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                            Diagnostics& diagnostics);
/// Reads FBX, DAE and whatever else assimp reads, by way of a glTF document that is made of assimp's scene.
Result<Character> read_with_assimp(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                                   Diagnostics& diagnostics);

}  // namespace ukemi
