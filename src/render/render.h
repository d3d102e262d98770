// Clips to pictures, off-screen.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "body/body.h"
#include "body/trajectory.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// 8-bit RGBA, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

Result<std::vector<std::uint8_t>> encode_png(const Picture& picture);

/// Quick: more bytes in less time.
enum class Effort { quick, thorough };

/// Lossy, `quality` 0 to 100.
Result<std::vector<std::uint8_t>> encode_webp(const Picture& picture, double quality,
                                              Effort effort = Effort::thorough);

enum class ThemeKind { light, dark };

/// A figure of a report, as it stands under a title.
struct Fact {
  std::string label, value;
};

/// What is drawn: a clip of a character, with what surrounds it. Pointers may be null and are not owned.
struct Shot {
  const Character* character = nullptr;
  const Humanoid* humanoid = nullptr;
  const Clip* clip = nullptr;
  const ArticulatedBody* body = nullptr;  // segment shapes: drawn with `shapes`, or where there is no mesh
  const std::vector<BodyPose>* segments = nullptr;  // one per frame, where shapes, axes or ranges are drawn
  const RangeOfMotion* range = nullptr;             // drawn with `ranges`
  const std::vector<Prop>* props = nullptr;
  Vec3 impact_point = Vec3::Zero();
  Vec3 impact_direction = Vec3::Zero();  // zero: no arrow
  std::string title;
  std::vector<Fact> facts;
  std::vector<std::string> notes;  // lines under them
};

/// What is drawn over the figure. Shapes, axes, ranges and prints need the shot's segments.
struct Overlays {
  bool shapes =
      false;  // the simulated segments, see-through; support, centre of mass and capture point on the floor
  bool axes = false;    // of every joint's segment: x forward red, y up green, z to the right blue
  bool ranges = false;  // each joint's range of motion as a cone: amber near its edge, red outside
  bool trail = false;   // the way of the hips
  bool prints = false;  // where feet have stood
};

/// Where the camera stands, seen from the figure's first frame, radians.
struct ViewAngles {
  double azimuth = 0.0;    // 0: in front, pi/2: to the figure's left
  double elevation = 0.0;  // above its horizon
};

struct SheetOptions {
  int columns = 4;
  int cells = 12;
  int cell_width = 320;
  int cell_height = 360;
  Overlays overlays{};
  ThemeKind theme = ThemeKind::light;
  std::optional<ViewAngles> view{};  // default: across the blow, or across the way of the figure
};

/// Columns and cells that fill a page of about that size best. Errors: usage (less than 240 x 180 or more
/// than 10000 pixels a side).
Result<SheetOptions> fit_sheet(SheetOptions options, int page_width, int page_height);

struct Thumbnails {
  Picture light, dark;
};

/// A reaction in one small picture, in both themes: the figure half-way through its motion, see-through where
/// it starts, and the blow. Errors: input, as render_sheet.
Result<Thumbnails> render_thumbnails(const Shot& shot, int width, int height);

/// Contact sheet: the same camera in every cell, each labelled with its time and phase; below them the speed
/// of the motion over time and a scale.
/// Errors: output when no off-screen context can be made.
Result<Picture> render_sheet(const Shot& shot, const SheetOptions& options);

struct StripsOptions {
  std::string title;
  SheetOptions sheet{};  // cells: columns of every row
};

/// Cells of `rows` clips that fill a page. Errors: as fit_sheet.
Result<SheetOptions> fit_strips(SheetOptions options, int rows, int page_width, int page_height);

/// Several clips under each other, each a row with its shot's title and facts, at the same times, to the same
/// scale and from the same side of the figure. Errors: as render_sheet; internal for clips of different
/// rates.
Result<Picture> render_strips(const std::vector<Shot>& shots, const StripsOptions& options);

struct MovingOptions {
  int width = 640;
  int height = 360;
  double fps = 30.0;
  double speed = 1.0;              // of the clip: 0.25 shows it four times as slow
  std::optional<double> turn_s{};  // the camera goes once round in that time
  Overlays overlays{};
  ThemeKind theme = ThemeKind::light;
  std::optional<ViewAngles> view{};
};

/// Frame by frame with time and phase; a clip of one frame lasts one turn of the camera. `take` is called for
/// every frame and ends it all with an error of its own. Errors: as render_sheet; usage (size, rate, a single
/// frame without a turn, longer than 3600 frames).
Status render_moving(const Shot& shot, const MovingOptions& options,
                     const std::function<Status(const Picture&)>& take);
/// The same as an animated WebP. Errors: as render_moving; output.
Result<std::vector<std::uint8_t>> render_webp(const Shot& shot, const MovingOptions& options);

}  // namespace ukemi
