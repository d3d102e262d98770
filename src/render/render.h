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

/// Contact sheet: the same camera in every cell, each labelled with its time and phase.
/// Errors: output when no off-screen context can be made.
Result<Picture> render_sheet(const Shot& shot, const SheetOptions& options);

}  // namespace ukemi
