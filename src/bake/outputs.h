// Where a bake writes to: formats by extension, and whether writing there can work at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"

namespace ukemi {

struct BakeSettings;

enum class OutputFormat { glb, gltf, vrm, bvh, fbx, vrma };

/// By the extension, case ignored; nothing for any other.
std::optional<OutputFormat> output_format(const std::filesystem::path& path);

/// Names the outputs that are given as a folder, one that exists or a name that ends in '/':
/// FOLDER/CHARACTER_HIT_FROM_PRESET.glb (.bvh for a BVH, .fbx for an FBX), and likewise sheet, preview and
/// report.
void name_outputs(const std::string& character, BakeSettings& settings);

/// Whether a file can be made at `path`: its folder exists and may be written to, and no directory is in the
/// way. Errors: output.
Status check_writable(const std::filesystem::path& path);

/// Every output of a bake: extension, writable, no two the same, none the character itself. Errors: usage,
/// output.
Status check_outputs(const std::string& character, const BakeSettings& settings);

/// Usage error unless the picture's name ends in .png.
Status check_picture_name(const std::filesystem::path& path);

}  // namespace ukemi
