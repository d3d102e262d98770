// What the review page's player is given of one clip: its keys, its path through the ranges of motion, its
// mesh and a thumbnail.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "review/mesh.h"
#include "review/sources.h"

namespace ukemi {

/// JSON in ASCII without "<", so that it may stand in any script. Arrays of numbers are base64 of
/// little-endian values.
struct ReviewClip {
  std::string clip_json;                                      // without the key "character"
  std::shared_ptr<const ReviewMesh> mesh;                     // skeleton and meshes
  std::vector<std::uint8_t> thumbnail_light, thumbnail_dark;  // WebP
  double duration_s = 0.0;
  double travel_m = 0.0;           // of the hips over the ground, from first to last frame
  double clip_excess_max_deg = 0;  // of the clip as it is stored
};

/// Loads the clip of a reaction. Errors: those of loading and drawing; input (a file without clips).
Result<ReviewClip> review_clip(const std::filesystem::path& folder, const ReviewSource& source,
                               Diagnostics& diagnostics);

}  // namespace ukemi
