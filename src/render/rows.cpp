#include "render/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/page.h"
#include "render/staging.h"

namespace ukemi {
namespace {

constexpr int kMargin = 32;
constexpr int kGap = 10;
constexpr int kCaption = 34;    // height of a row's heading
constexpr int kCellLabel = 30;  // height kept free for the time
constexpr double kFarthest_m = 15.0;
constexpr double kMarkerRadius = 0.035;  // m
constexpr std::size_t kMostLabels = 3;   // in a cell
constexpr double kTitleSize = 23, kRowSize = 16, kTextSize = 14, kSmallSize = 12;
const Rgba kMarkerColor = srgb(0xE0201B, 0.92f);
constexpr Color kMarkerInk = hex(0xC81410);

Error internal(std::string what) { return internal_error(std::move(what), "report this"); }

Status check(const std::vector<MarkedShot>& rows) {
  if (rows.empty()) return internal("no row to draw");
  for (const MarkedShot& row : rows) {
    if (row.shot.character == nullptr || row.shot.clip == nullptr || row.shot.clip->frames.empty())
      return internal("a row without character or clip");
    if (row.shot.clip->frames.size() != rows.front().shot.clip->frames.size())
      return internal("rows of different lengths");
  }
  return Done{};
}

JointPaths joint_paths(const DrawnCharacter& figure, const Shot& shot) {
  JointPaths paths;
  for (std::size_t frame = 0; frame < shot.clip->frames.size(); ++frame)
    paths.push_back(figure.joints(static_cast<int>(frame)));
  return paths;
}

bool stays_near(const JointPaths& paths) {
  for (const std::vector<Vec3>& frame : paths)
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (!((frame[i] - paths.front()[i]).norm() < kFarthest_m)) return false;
  return true;
}

/// The pose's red spots, over everything else.
void add_markers(FrameGeometry& geometry, const std::vector<Marker>& markers) {
  if (markers.empty()) return;
  Surface surface;
  surface.alpha = Material::Alpha::blend;
  surface.takes_shadow = false;
  surface.casts_shadow = false;
  geometry.overlay.begin(surface);
  for (const Marker& marker : markers)
    add_capsule(geometry.overlay, {Quat::Identity(), marker.place}, kMarkerRadius, 0.0, kMarkerColor);
}

struct Place {
  int x, y;
};

/// Labels beside their spots, one under the other where they would meet.
void draw_marker_labels(Picture& page, const Fonts& fonts, const Box& cell, const Camera& camera,
                        const std::vector<Marker>& markers, double size) {
  std::vector<Place> taken;
  for (std::size_t i = 0; i < std::min(markers.size(), kMostLabels); ++i) {
    const Vec3 seen = camera.project(markers[i].place);
    if (seen.z() <= 0.0 || std::abs(seen.x()) > 1.0 || std::abs(seen.y()) > 1.0) continue;
    const int width = static_cast<int>(std::ceil(fonts.bold.width(markers[i].label, size)));
    const int offset = static_cast<int>(size);
    int x = cell.x + static_cast<int>(0.5 * (1.0 + seen.x()) * cell.width) + offset;
    int y = cell.y + static_cast<int>(0.5 * (1.0 - seen.y()) * cell.height) + offset / 3;
    if (x + width > cell.x + cell.width - 4) x -= width + 2 * offset;
    x = std::max(x, cell.x + 4);
    const int line = static_cast<int>(1.3 * size);
    for (const Place& other : taken)
      if (std::abs(other.y - y) < line && std::abs(other.x - x) < width) y = other.y + line;
    taken.push_back({x, y});
    fill(page, {x - 3, y - offset, width + 6, line + 2}, 3.0, kPage, 0.72);
    fonts.bold.draw(page, x, y, markers[i].label, size, kMarkerInk);
  }
}

/// Title and notes; returns the y below them.
int draw_heading(Picture& page, const Fonts& fonts, const std::string& title,
                 const std::vector<std::string>& notes) {
  const double room = page.width - 2.0 * kMargin;
  int baseline = kMargin + 22;
  fonts.bold.draw(page, kMargin, baseline, fonts.bold.fitted(title, kTitleSize, room), kTitleSize, kInk);
  for (const std::string& note : notes) {
    baseline += 23;
    fonts.regular.draw(page, kMargin, baseline, fonts.regular.fitted(note, kTextSize, room), kTextSize,
                       kSoftInk);
  }
  return baseline + 16;
}

int heading_height(const std::vector<std::string>& notes) {
  return kMargin + 38 + 23 * static_cast<int>(notes.size());
}

FrameGeometry cell_geometry(const DrawnCharacter& figure, const MarkedShot& row, int frame) {
  FrameGeometry geometry = figure.geometry(frame);
  if (shows_arrow(row.shot, frame)) add_blow_arrow(geometry.solid, row.shot, frame);
  if (static_cast<std::size_t>(frame) < row.markers.size()) add_markers(geometry, row.markers[frame]);
  return geometry;
}

/// One view of one frame, its red spots labelled.
void draw_cell(Picture& page, const Fonts& fonts, Painter& painter, const DrawnCharacter& figure,
               const MarkedShot& row, int frame, const StageView& stage, const Box& cell,
               const std::string& label, double label_size) {
  paste(page, painter.draw(cell_geometry(figure, row, frame), stage), cell.x, cell.y, 6.0);
  outline(page, cell, 6.0, kCellBorder);
  if (static_cast<std::size_t>(frame) < row.markers.size())
    draw_marker_labels(page, fonts, cell, stage.camera, row.markers[frame], label_size);
  fonts.bold.draw(page, cell.x + 10, cell.y + 21, label, kTextSize, kInk);
}

/// Caption and cells; `first`: upper left corner of the row, size of a cell.
void draw_row(Picture& page, const Fonts& fonts, Painter& painter, const DrawnCharacter& figure,
              const MarkedShot& row, const std::vector<Moment>& moments, const Staging& staging,
              const Box& first) {
  const double after = fonts.bold.draw(page, first.x, first.y + 22, row.shot.title, kRowSize, kInk);
  if (!row.shot.notes.empty())
    fonts.regular.draw(page, after + 14, first.y + 22, row.shot.notes.front(), kTextSize, kSoftInk);
  for (std::size_t c = 0; c < moments.size(); ++c) {
    const int frame = moments[c].frame;
    const Box cell{first.x + static_cast<int>(c) * (first.width + kGap), first.y + kCaption, first.width,
                   first.height};
    draw_cell(page, fonts, painter, figure, row, frame, staging.at(frame), cell,
              fmt::format("{:.2f} s", frame / row.shot.clip->fps), kSmallSize);
  }
}

}  // namespace

Result<Picture> render_rows(const std::vector<MarkedShot>& rows, const RowsOptions& options) {
  if (const Status status = check(rows); !status) return status.error();
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  auto painter =
      Painter::make(options.cell_width, options.cell_height, decode_textures(*rows.front().shot.character));
  if (!painter) return painter.error();

  std::vector<DrawnCharacter> figures;
  JointPaths together(rows.front().shot.clip->frames.size());
  std::size_t steady = rows.size();  // first row that stays in view
  for (std::size_t r = 0; r < rows.size(); ++r) {
    figures.emplace_back(rows[r].shot, Overlays{});
    const JointPaths paths = joint_paths(figures.back(), rows[r].shot);
    if (!stays_near(paths)) continue;
    steady = std::min(steady, r);
    for (std::size_t f = 0; f < paths.size(); ++f)
      together[f].insert(together[f].end(), paths[f].begin(), paths[f].end());
  }
  if (steady == rows.size()) return internal("no row stays near enough to be seen");

  const Shot& shot = rows[steady].shot;
  const std::vector<Moment> moments = choose_moments(*shot.clip, together, options.columns);
  const Staging staging = set_stage(figures[steady], shot, together, moments,
                                    static_cast<double>(options.cell_width) / options.cell_height,
                                    static_cast<double>(kCellLabel) / options.cell_height);
  const int columns = static_cast<int>(moments.size());
  const int row_height = kCaption + options.cell_height + kGap;
  const int drawn = options.only ? 1 : static_cast<int>(rows.size());
  Picture page = blank(2 * kMargin + columns * (options.cell_width + kGap) - kGap,
                       heading_height(options.notes) + drawn * row_height + kMargin, kPage);
  int y = draw_heading(page, *fonts, options.title, options.notes);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (options.only && *options.only != r) continue;
    draw_row(page, *fonts, **painter, figures[r], rows[r], moments, staging,
             {kMargin, y, options.cell_width, options.cell_height});
    y += row_height;
  }
  return page;
}

Result<Picture> render_close_up(const MarkedShot& marked, const CloseUpOptions& options) {
  if (const Status status = check({marked}); !status) return status.error();
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  auto painter =
      Painter::make(options.cell_width, options.cell_height, decode_textures(*marked.shot.character));
  if (!painter) return painter.error();

  const DrawnCharacter figure(marked.shot, {});
  const double aspect = static_cast<double>(options.cell_width) / options.cell_height;
  const JointPaths still(static_cast<std::size_t>(options.frame) + 1, figure.joints(options.frame));
  const Staging whole = set_stage(figure, marked.shot, still, {{options.frame, ""}}, aspect, 0.06);
  std::vector<StageView> views = {whole.stage};
  for (const double azimuth : {radians(0.0), radians(90.0)}) {
    StageView stage = whole.stage;
    const Vec3 back = whole.stage.camera.world_from_camera * Vec3::UnitZ();
    stage.camera.world_from_camera = look(std::atan2(back.x(), back.z()) + azimuth, radians(18.0));
    Framing framing(stage.camera, {0.05, 0.05, 0.05, 0.1});
    framing.add(options.focus, options.radius_m);
    stage.camera = framing.fit();
    views.push_back(stage);
  }
  const int count = static_cast<int>(views.size());
  Picture page = blank(2 * kMargin + count * (options.cell_width + kGap) - kGap,
                       heading_height(options.notes) + options.cell_height + kMargin, kPage);
  const int y = draw_heading(page, *fonts, options.title, options.notes);
  for (int i = 0; i < count; ++i)
    draw_cell(page, *fonts, **painter, figure, marked, options.frame, views[i],
              {kMargin + i * (options.cell_width + kGap), y, options.cell_width, options.cell_height},
              i == 0 ? fmt::format("{:.2f} s", options.frame / marked.shot.clip->fps) : std::string(), 14.0);
  return page;
}

}  // namespace ukemi
