// Contact sheets: of a bake, and of any clip in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/bake.h"
#include "base/result.h"

namespace ukemi {

/// The contact sheet of a bake as a PNG.
Result<std::vector<std::uint8_t>> bake_sheet(const Character& character, const BakeSettings& settings,
                                             const BakeOutcome& outcome);

/// The bake in one small picture as a WebP of about 4 kB: the figure half-way through its motion, see-through
/// where it starts, and the blow.
Result<std::vector<std::uint8_t>> bake_thumbnail(const Character& character, const BakeSettings& settings,
                                                 const BakeOutcome& outcome,
                                                 const ThumbnailOptions& options = {});

struct RenderSettings {
  std::optional<std::string> clip;  // default: the last of the file; the rest pose of a file without clips
  bool shapes = false;              // segment shapes in place of the mesh
  HumanoidOptions humanoid;
};

struct RenderedClip {
  std::string clip;
  double duration_s = 0.0;
  std::vector<std::uint8_t> png;
};

/// The contact sheet of a clip. `file` may be "mannequin". Errors: those of loading and rendering; usage
/// (unknown clip).
Result<RenderedClip> render_clip(const std::string& file, const RenderSettings& settings,
                                 Diagnostics& diagnostics);

}  // namespace ukemi
