#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/sheet_page.h"
#include "render/studio.h"

namespace ukemi {
namespace {

constexpr int kLongestPageSide = 32000;
constexpr double kCaption = 38;  // height of a row's heading

int last_frame(const Studio& studio) { return static_cast<int>(studio.joints.size()) - 1; }

/// The same times for all rows; a row that has ended is held at its last frame.
std::vector<Moment> common_moments(const std::vector<Studio>& rows, int count) {
  int last = 0;
  for (const Studio& row : rows) last = std::max(last, last_frame(row));
  const Clip& first = *rows.front().shot.clip;
  const Clip longest{first.name, first.fps, std::vector<Pose>(static_cast<std::size_t>(last) + 1), {}};
  JointPaths together(longest.frames.size());
  for (const Studio& row : rows)
    for (int frame = 0; frame <= last; ++frame) {
      const std::vector<Vec3>& joints = row.joints[std::min(frame, last_frame(row))];
      together[frame].insert(together[frame].end(), joints.begin(), joints.end());
    }
  return choose_moments(longest, together, count);
}

/// The view of the first row, seen from each figure's own front.
ViewAngles common_view(const Studio& first, const std::optional<ViewAngles>& view) {
  if (view) return *view;
  const Vec3 back = telling_side(first.figure, first.shot, first.joints) * Vec3::UnitZ();
  const Vec3 facing = first.figure.facing(0);
  const double front = facing.isZero() ? 0.0 : std::atan2(facing.x(), facing.z());
  return {std::atan2(back.x(), back.z()) - front, std::asin(std::clamp(back.y(), -1.0, 1.0))};
}

double distance_of(const StageView& stage) {
  return (stage.camera.eye - stage.focus).dot(stage.camera.world_from_camera * Vec3::UnitZ());
}

/// All cameras as far from their figures as the farthest: one scale.
void equalize(std::vector<Staging>& stagings) {
  double farthest = 0.0;
  for (const Staging& staging : stagings) farthest = std::max(farthest, distance_of(staging.stage));
  for (Staging& staging : stagings) {
    Camera& camera = staging.stage.camera;
    camera.eye += (farthest - distance_of(staging.stage)) * (camera.world_from_camera * Vec3::UnitZ());
  }
}

std::string caption_of(const Shot& shot) {
  std::string text;
  for (const Fact& fact : shot.facts) text += (text.empty() ? "" : "  ·  ") + fact.label + " " + fact.value;
  return text;
}

std::string phase_of(const Studio& row, int frame) {
  const int last = last_frame(row);
  return frame > last ? fmt::format("ended at {:.2f} s", last / row.shot.clip->fps) : "";
}

void draw_caption(Picture& page, const Pen& pen, const Shot& shot, const Box& place) {
  const std::string title = pen.fonts.bold.fitted(shot.title, pen.size(17), place.width);
  const double after =
      pen.fonts.bold.draw(page, place.x, place.y + pen.scaled(24), title, pen.size(17), pen.theme.ink);
  const double left = after + pen.size(16);
  const double room = place.x + place.width - left;
  if (room <= 0.0) return;
  const std::string text = pen.fonts.regular.fitted(caption_of(shot), pen.size(13.5), room);
  pen.fonts.regular.draw(page, left, place.y + pen.scaled(24), text, pen.size(13.5), pen.theme.soft_ink);
}

class Strips {
 public:
  Strips(const Pen& pen, const SheetOptions& options, int columns, int rows)
      : pen_(pen), options_(options), columns_(columns), rows_(rows) {}

  int margin() const { return pen_.scaled(36); }
  int gap() const { return pen_.scaled(10); }
  int room() const { return columns_ * (options_.cell_width + gap()) - gap(); }
  int width() const { return 2 * margin() + room(); }
  int row_height() const { return pen_.scaled(kCaption) + options_.cell_height + pen_.scaled(14); }
  int top() const { return margin() + pen_.scaled(44); }
  int height() const { return top() + rows_ * row_height() + pen_.scaled(48); }
  Box caption(int row) const { return {margin(), top() + row * row_height(), room(), pen_.scaled(kCaption)}; }
  Box cell(int row, int column) const {
    return {margin() + column * (options_.cell_width + gap()),
            top() + row * row_height() + pen_.scaled(kCaption), options_.cell_width, options_.cell_height};
  }

 private:
  const Pen& pen_;
  const SheetOptions& options_;
  int columns_, rows_;
};

double zoom_for(int cell_width) { return std::clamp(cell_width / 280.0, 0.4, 4.0); }

Error size_error(int width, int height, std::string fix) {
  return usage_error(fmt::format("a sheet of {} x {} pixels cannot be drawn", width, height), std::move(fix));
}

Status check(const std::vector<Shot>& shots) {
  if (shots.empty()) return internal_error("no clip to draw", "report this");
  for (const Shot& shot : shots)
    if (shot.clip == nullptr || shot.clip->fps != shots.front().clip->fps)
      return internal_error("clips of different rates", "report this");
  return Done{};
}

Result<std::vector<Studio>> study_all(const std::vector<Shot>& shots, const Overlays& overlays) {
  std::vector<Studio> rows;
  for (const Shot& shot : shots) {
    auto studio = study(shot, overlays);
    if (!studio) return studio.error();
    rows.push_back(std::move(*studio));
  }
  return rows;
}

std::vector<Staging> set_stages(const std::vector<Studio>& rows, const std::vector<Moment>& moments,
                                const Pen& pen, const SheetOptions& options) {
  const ViewAngles view = common_view(rows.front(), options.view);
  std::vector<Staging> stagings;
  for (const Studio& row : rows) {
    std::vector<Moment> own = moments;
    for (Moment& moment : own) moment.frame = std::min(moment.frame, last_frame(row));
    stagings.push_back(set_stage(row.figure, row.shot, row.joints, own,
                                 static_cast<double>(options.cell_width) / options.cell_height,
                                 static_cast<double>(label_height(pen)) / options.cell_height,
                                 {.view = view, .theme = options.theme}));
  }
  equalize(stagings);
  return stagings;
}

/// The painter lives no longer than its row: one context at a time.
Status draw_row(Picture& page, const Pen& pen, const Strips& places, int r, Studio& row,
                const std::vector<Moment>& moments, const Staging& staging, const SheetOptions& options) {
  if (const Status status = equip(row, options.cell_width, options.cell_height); !status) return status;
  draw_caption(page, pen, row.shot, places.caption(r));
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const int frame = std::min(moments[i].frame, last_frame(row));
    const Box cell = places.cell(r, static_cast<int>(i));
    paste(page, row.painter->draw(row.geometry(frame), staging.at(frame)), cell.x, cell.y, pen.size(7));
    outline(page, cell, pen.size(7), pen.theme.border);
    draw_label(page, pen, cell, fmt::format("{:.2f} s", moments[i].frame / row.shot.clip->fps),
               phase_of(row, moments[i].frame));
  }
  row.painter.reset();
  return Done{};
}

}  // namespace

Result<SheetOptions> fit_strips(SheetOptions options, int rows, int page_width, int page_height) {
  if (page_width < 240 || page_height < 180 || std::max(page_width, page_height) > 10000)
    return size_error(page_width, page_height, "ask for 240 x 180 to 10000 x 10000 pixels");
  double zoom = 1.0;
  for (int pass = 0; pass < 4; ++pass) {
    options.cell_width =
        static_cast<int>((page_width - zoom * (72.0 + 10.0 * (options.cells - 1))) / options.cells);
    zoom = zoom_for(options.cell_width);
  }
  options.cell_height =
      static_cast<int>((page_height - zoom * (36.0 + 44.0 + 48.0)) / rows - zoom * (kCaption + 14.0));
  if (std::min(options.cell_width, options.cell_height) < 64)
    return size_error(page_width, page_height, "ask for fewer cells or a larger sheet");
  return options;
}

Result<Picture> render_strips(const std::vector<Shot>& shots, const StripsOptions& options) {
  if (const Status status = check(shots); !status) return status.error();
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  const SheetOptions& sheet = options.sheet;
  auto rows = study_all(shots, sheet.overlays);
  if (!rows) return rows.error();
  const std::vector<Moment> moments = common_moments(*rows, sheet.cells);
  const Pen pen{*fonts, theme(sheet.theme), zoom_for(sheet.cell_width)};
  const Strips places(pen, sheet, static_cast<int>(moments.size()), static_cast<int>(rows->size()));
  if (std::max(places.width(), places.height()) > kLongestPageSide)
    return usage_error(fmt::format("a sheet of {} x {} pixels is too large", places.width(), places.height()),
                       "ask for fewer or smaller cells");

  const std::vector<Staging> stagings = set_stages(*rows, moments, pen, sheet);
  Picture page = blank(places.width(), places.height(), pen.theme.page);
  draw_heading(page, pen, {options.title, {}, {}}, places.margin(), places.margin(), places.room());
  for (std::size_t r = 0; r < rows->size(); ++r) {
    const Status drawn =
        draw_row(page, pen, places, static_cast<int>(r), (*rows)[r], moments, stagings[r], sheet);
    if (!drawn) return drawn.error();
  }
  draw_scale(page, pen, stagings.front().stage, sheet.cell_height, places.margin(),
             page.height - pen.scaled(24), "grid 1 m and 0.25 m");
  return page;
}

}  // namespace ukemi
