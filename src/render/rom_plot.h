// A joint's range of motion as a figure: its polygon in the (a_y, a_z) plane, its twist, and paths through
// them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/render.h"
#include "restrict/limit_rows.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// A joint over time: frame i at i / fps seconds.
struct RomPath {
  std::vector<SwingTwist> charts;
  std::vector<double> excess_deg;  // of each chart
  double fps = 60.0;
};

struct RomPanel {
  std::string title;
  std::vector<std::string> notes;
  const JointRange* range = nullptr;
  const RomPath* path = nullptr;  // may be null
  struct State {
    Vec2 swing = Vec2::Zero();
    ChordStops stops;
  };
  std::optional<State> state;  // drawn with its chords, as in Figure 4
};

struct RomFigure {
  std::string title;
  std::vector<std::string> notes;
  std::vector<RomPanel> panels;
};

/// One large panel with scales and words; below it the excess over time where there is a path.
/// Errors: output (the font is missing).
Result<Picture> draw_rom_joint(const RomFigure& figure);
/// Small panels on a common scale in `columns` columns; a panel without a range leaves its place empty. In
/// the empty places of the first row: the excess over time of the paths that leave their range furthest, or
/// how to read the panels.
Result<Picture> draw_rom_overview(const RomFigure& figure, int columns);
/// Large panels side by side on a common scale, to compare paths in one range.
Result<Picture> draw_rom_comparison(const RomFigure& figure);

}  // namespace ukemi
