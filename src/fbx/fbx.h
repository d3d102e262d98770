// Writes a clip as binary FBX: into the character's own file as one more take, or into a new document.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

struct FbxOptions {
  /// The file that gets the take: the character's own, or an earlier output for it. Empty: a document is
  /// made.
  std::span<const std::uint8_t> source{};
  std::filesystem::path source_path{};  // names it in errors
  /// Without meshes, materials and skins, and without earlier takes.
  bool clip_only = false;
};

/// Whether the character comes from an FBX.
bool is_fbx(const Character& character);

/// With a source, the result is its document, every record as it was, plus one animation stack. Local
/// translations and Euler angles of the nodes that move and of all bones reproduce the clip at every frame to
/// float precision: each model's rotation order, pre- and post-rotation, offsets and pivots are in force; the
/// angles do not jump. Scalings get curves where the clip scales. Records are byte for byte those of the
/// source, but for the counts of the definitions, the offsets, and limits of rotation and translation that
/// the clip leaves: those are switched off, with a warning.
///
/// Without a source, the result is binary FBX 7.4 in centimetres, y up: models, bones, skinned meshes with
/// normals, texture coordinates, colours and embedded textures, bind pose, the take. The character's earlier
/// takes are left out.
///
/// Errors: input (source is ASCII, older than 7.0, broken, or its models are not the character's nodes).
Result<std::vector<std::uint8_t>> write_fbx(const Character& character, const Humanoid& humanoid,
                                            const Clip& clip, const FbxOptions& options,
                                            Diagnostics& diagnostics);

}  // namespace ukemi
