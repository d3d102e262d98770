// Several runs of one scene under each other, at the same times and from the same camera, with spots marked
// in red.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/render.h"

namespace ukemi {

/// A spot that is drawn over everything else, its label beside it.
struct Marker {
  Vec3 place = Vec3::Zero();  // world, metres
  std::string label;
};

/// The shot's title and first note head its row.
struct MarkedShot {
  Shot shot;
  std::vector<std::vector<Marker>> markers;  // per frame of the clip; the first ones are labelled
};

struct RowsOptions {
  std::string title;
  std::vector<std::string> notes;
  std::optional<std::size_t> only;  // this row alone, as the sheet of all rows shows it
  int columns = 8;
  int cell_width = 240;
  int cell_height = 290;
};

/// Contract: every clip has as many frames, at the same rate. The camera holds all rows whose figures stay
/// within 15 m of where they started. Errors: output when no off-screen context can be made.
Result<Picture> render_rows(const std::vector<MarkedShot>& rows, const RowsOptions& options);

struct CloseUpOptions {
  std::string title;
  std::vector<std::string> notes;
  int frame = 0;
  Vec3 focus = Vec3::Zero();  // world, metres
  double radius_m = 0.36;     // about the focus, that the close views hold
  int cell_width = 420;
  int cell_height = 480;
};

/// One frame: the whole figure, and its surroundings of the focus from two sides. Errors: as render_rows.
Result<Picture> render_close_up(const MarkedShot& marked, const CloseUpOptions& options);

}  // namespace ukemi
