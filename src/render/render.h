// Clips to pictures, off-screen.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "body/body.h"
#include "humanoid/humanoid.h"
#include "simulate/trajectory.h"

namespace ukemi {

/// 8-bit RGBA, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

Result<std::vector<std::uint8_t>> encode_png(const Picture& picture);

/// Lossy, `quality` 0 to 100.
Result<std::vector<std::uint8_t>> encode_webp(const Picture& picture, double quality);

enum class ThemeKind { light, dark };

/// What is drawn: a clip of a character, with what surrounds it. Pointers may be null and are not owned.
struct Shot {
  const Character* character = nullptr;
  const Humanoid* humanoid = nullptr;
  const Clip* clip = nullptr;
  const ArticulatedBody* body = nullptr;  // segment shapes: drawn with `shapes`, or where there is no mesh
  const std::vector<BodyPose>* segments = nullptr;  // one per frame, where shapes are drawn
  const std::vector<Prop>* props = nullptr;
  Vec3 impact_point = Vec3::Zero();
  Vec3 impact_direction = Vec3::Zero();  // zero: no arrow
  std::string title;
  std::vector<std::string> notes;  // lines of figures under the title
};

struct SheetOptions {
  int columns = 4;
  int cells = 12;
  int cell_width = 320;
  int cell_height = 360;
  bool shapes = false;
};

struct ThumbnailOptions {
  int width = 288;
  int height = 216;
  ThemeKind theme = ThemeKind::light;
};

/// A reaction in one small picture: the figure half-way through its motion, see-through where it starts, and
/// the blow. Errors: as render_sheet.
Result<Picture> render_thumbnail(const Shot& shot, const ThumbnailOptions& options);

/// Contact sheet: the same camera in every cell, each labelled with its time and phase.
/// Errors: output when no off-screen context can be made.
Result<Picture> render_sheet(const Shot& shot, const SheetOptions& options);

}  // namespace ukemi
