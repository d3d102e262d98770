#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/sheet_page.h"
#include "render/studio.h"

namespace ukemi {
namespace {

constexpr int kLongestPageSide = 32000;
constexpr int kShortestCell = 64, kLongestCell = 4096;
constexpr double kHole = 0.6;  // weight of empty places against that of an unusual aspect
constexpr double kCellAspect = 320.0 / 360.0;

Status check(const SheetOptions& options) {
  if (options.columns < 1 || options.columns > 100 || options.cells < 1 || options.cells > 1000)
    return usage_error(
        fmt::format("a sheet of {} cells in {} columns cannot be drawn", options.cells, options.columns),
        "ask for 1 to 1000 cells in 1 to 100 columns");
  if (std::min(options.cell_width, options.cell_height) < kShortestCell ||
      std::max(options.cell_width, options.cell_height) > kLongestCell)
    return usage_error(
        fmt::format("cells of {} x {} pixels cannot be drawn", options.cell_width, options.cell_height),
        "ask for sides of 64 to 4096 pixels");
  return Done{};
}

/// Everything but the cells grows with their width.
double zoom_for(int cell_width) { return std::clamp(cell_width / 320.0, 0.4, 4.0); }

/// Places on the page, pixels.
class Layout {
 public:
  Layout(const Pen& pen, const SheetOptions& options, int cells)
      : pen_(pen),
        options_(options),
        columns_(std::min(options.columns, cells)),
        rows_((cells + columns_ - 1) / columns_) {}

  int margin() const { return pen_.scaled(36); }
  int gap() const { return pen_.scaled(14); }
  int room() const { return columns_ * options_.cell_width + (columns_ - 1) * gap(); }
  int width() const { return 2 * margin() + room(); }
  int grid_top(int heading) const { return margin() + heading; }
  int grid_bottom(int heading) const {
    return grid_top(heading) + rows_ * (options_.cell_height + gap()) - gap();
  }
  int height(int heading, bool timeline) const {
    return grid_bottom(heading) + pen_.scaled(16) + (timeline ? timeline_height(pen_) : 0) + pen_.scaled(48);
  }
  Box cell(int heading, int i) const {
    return {margin() + i % columns_ * (options_.cell_width + gap()),
            grid_top(heading) + i / columns_ * (options_.cell_height + gap()), options_.cell_width,
            options_.cell_height};
  }

 private:
  const Pen& pen_;
  const SheetOptions& options_;
  int columns_, rows_;
};

Heading heading_of(const Shot& shot) {
  const std::string fallback =
      shot.clip->name.empty() ? shot.character->name : shot.character->name + " · " + shot.clip->name;
  return {shot.title.empty() ? fallback : shot.title, shot.facts, shot.notes};
}

void draw_cells(Picture& page, const Pen& pen, const Layout& layout, int heading, const Studio& studio,
                const std::vector<Moment>& moments, const Staging& staging) {
  const double radius = pen.size(8);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const int frame = moments[i].frame;
    const Box cell = layout.cell(heading, static_cast<int>(i));
    paste(page, studio.painter->draw(studio.geometry(frame), staging.at(frame)), cell.x, cell.y, radius);
    outline(page, cell, radius, pen.theme.border);
    if (studio.joints.size() > 1)
      draw_label(page, pen, cell, fmt::format("{:.2f} s", frame / studio.shot.clip->fps), moments[i].phase);
  }
}

void draw_footer(Picture& page, const Pen& pen, const Layout& layout, const Shot& shot,
                 const Staging& staging, int cell_height) {
  const int baseline = page.height - pen.scaled(24);
  const double scale_end =
      draw_scale(page, pen, staging.stage, cell_height, layout.margin(), baseline,
                 staging.follows() ? "grid 1 m and 0.25 m  ·  the camera follows" : "grid 1 m and 0.25 m");
  const std::size_t frames = shot.clip->frames.size();
  const std::string text = fmt::format("{:.2f} s  ·  {} frame{} at {:.4g} fps", shot.clip->duration_s(),
                                       frames, frames == 1 ? "" : "s", shot.clip->fps);
  const double size = pen.size(13);
  const double left = layout.width() - layout.margin() - pen.fonts.regular.width(text, size);
  if (frames > 1 && left > scale_end + pen.size(20))
    pen.fonts.regular.draw(page, left, baseline, text, size, pen.theme.soft_ink);
}

/// Options whose cells fill the page in `columns` columns; cells that cannot fit come out too small.
SheetOptions in_columns(SheetOptions options, int columns, int page_width, int page_height) {
  const int rows = (options.cells + columns - 1) / columns;
  double zoom = 1.0;
  for (int pass = 0; pass < 4; ++pass) {
    options.cell_width = static_cast<int>((page_width - zoom * (72.0 + 14.0 * (columns - 1))) / columns);
    zoom = zoom_for(options.cell_width);
  }
  const double around = zoom * (36.0 + 34.0 + 48.0 + 14.0 + 16.0 + 82.0 + 48.0 + 14.0 * (rows - 1));
  options.columns = columns;
  options.cell_height = static_cast<int>((page_height - around) / rows);
  return options;
}

}  // namespace

Result<SheetOptions> fit_sheet(SheetOptions options, int page_width, int page_height) {
  if (page_width < 240 || page_height < 180 || std::max(page_width, page_height) > 10000)
    return usage_error(fmt::format("a sheet of {} x {} pixels cannot be drawn", page_width, page_height),
                       "ask for 240 x 180 to 10000 x 10000 pixels");
  std::optional<SheetOptions> best;
  double best_error = 0.0;
  for (int columns = 1; columns <= options.cells; ++columns) {
    const SheetOptions tried = in_columns(options, columns, page_width, page_height);
    if (!check(tried)) continue;
    const int holes = (columns - options.cells % columns) % columns;
    const double error = std::abs(std::log(tried.cell_width / (kCellAspect * tried.cell_height))) +
                         kHole * holes / options.cells;
    if (best && error >= best_error) continue;
    best = tried;
    best_error = error;
  }
  if (!best)
    return usage_error(
        fmt::format("{} cells do not fit {} x {} pixels", options.cells, page_width, page_height),
        "ask for fewer cells or a larger sheet");
  return *best;
}

Result<Picture> render_sheet(const Shot& shot, const SheetOptions& options) {
  if (const Status status = check(options); !status) return status.error();
  auto studio = study(shot, options.overlays);
  if (!studio) return studio.error();
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();

  const std::vector<Moment> moments = choose_moments(*shot.clip, studio->joints, options.cells);
  const Pen pen{*fonts, theme(options.theme), zoom_for(options.cell_width)};
  const Layout layout(pen, options, static_cast<int>(moments.size()));
  const Heading heading = heading_of(shot);
  const int top = heading_height(pen, heading, layout.room());
  const SpeedCurve timeline{mean_speeds(*shot.clip, studio->joints), shot.clip->fps, moments};
  const int height = layout.height(top, timeline.speeds.size() > 1);
  if (std::max(layout.width(), height) > kLongestPageSide)
    return usage_error(fmt::format("a sheet of {} x {} pixels is too large", layout.width(), height),
                       "ask for fewer or smaller cells");
  if (const Status status = equip(*studio, options.cell_width, options.cell_height); !status)
    return status.error();

  const Staging staging = set_stage(studio->figure, shot, studio->joints, moments,
                                    static_cast<double>(options.cell_width) / options.cell_height,
                                    static_cast<double>(label_height(pen)) / options.cell_height,
                                    {.view = options.view, .theme = options.theme});
  Picture page = blank(layout.width(), height, pen.theme.page);
  draw_heading(page, pen, heading, layout.margin(), layout.margin(), layout.room());
  draw_cells(page, pen, layout, top, *studio, moments, staging);
  draw_timeline(
      page, pen, timeline,
      {layout.margin(), layout.grid_bottom(top) + pen.scaled(16), layout.room(), timeline_height(pen)});
  draw_footer(page, pen, layout, shot, staging, options.cell_height);
  return page;
}

}  // namespace ukemi
