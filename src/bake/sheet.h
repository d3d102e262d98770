// Pictures of a bake and of the clips in files: contact sheets, moving previews, thumbnails.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/baked.h"
#include "base/result.h"

namespace ukemi {

/// The contact sheet of a bake as a PNG.
Result<std::vector<std::uint8_t>> bake_sheet(const Character& character, const BakeSettings& settings,
                                             const BakedClip& outcome);

/// The bake in one small picture as a WebP of about 4 kB: the figure half-way through its motion, see-through
/// where it starts, and the blow; in the settings' theme.
Result<std::vector<std::uint8_t>> bake_thumbnail(const Character& character, const BakeSettings& settings,
                                                 const BakedClip& outcome, int width = 288, int height = 216);

/// The bake as an animated WebP, 640 x 360 at 30 frames a second.
Result<std::vector<std::uint8_t>> bake_preview(const Character& character, const BakeSettings& settings,
                                               const BakedClip& outcome);

struct RenderSettings {
  std::optional<std::string> clip;  // default: the last of the file; the rest pose of a file without clips
  HumanoidOptions humanoid;
  std::string region = "human";  // its ranges are drawn
  Overlays overlays;
  ThemeKind theme = ThemeKind::light;
  std::optional<ViewAngles> view;
  std::optional<std::array<int, 2>> size;  // pixels, width and height: of the sheet or the moving picture
  std::optional<int> cells;                // default: 12; 6 in a row where there are several clips
  std::optional<int> columns;
  double fps = 30.0;             // moving: pictures a second
  double speed = 1.0;            // moving: of the clip
  std::optional<double> turn_s;  // moving: the camera goes once round in that time
};

struct RenderedClip {
  std::string file, clip;
  double duration_s = 0.0;
};

struct Rendered {
  std::vector<RenderedClip> clips;
  std::vector<OutputFile> files;
};

enum class PictureKind {
  sheet,     // NAME.png
  sequence,  // NAME_####.png: a picture per frame, numbered in place of the hashes
  moving     // NAME.webp
};

/// Errors: usage for any other name.
Result<PictureKind> picture_kind(const std::filesystem::path& output);

/// A clip's sheet, several clips' sheet (a row each), or one clip as a moving picture, by the output's name.
/// `files` may hold "mannequin". Nothing is written. Errors: those of loading and rendering; usage (unknown
/// clip, several clips in a moving picture).
Result<Rendered> render_files(const std::vector<std::string>& files, const std::filesystem::path& output,
                              const RenderSettings& settings, Diagnostics& diagnostics);

/// front back left right above or AZIMUTH[,ELEVATION] in degrees: where the camera stands. Errors: usage.
Result<ViewAngles> parse_view(std::string_view text);
/// thumbnail screen a4 a3 or WIDTHxHEIGHT. Errors: usage.
Result<std::array<int, 2>> parse_picture_size(std::string_view text);

}  // namespace ukemi
