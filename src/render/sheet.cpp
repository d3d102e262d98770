#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/page.h"
#include "render/staging.h"
#include "render/studio.h"

namespace ukemi {
namespace {

constexpr int kLongestPageSide = 32000;

Error usage_error(std::string what, std::string fix) {
  return {ErrorKind::usage, "", 0, 0, "", std::move(what), std::move(fix)};
}

Status check(const SheetOptions& options) {
  if (options.columns < 1 || options.columns > 100 || options.cells < 1 || options.cells > 1000)
    return usage_error(
        fmt::format("a sheet of {} cells in {} columns cannot be drawn", options.cells, options.columns),
        "ask for 1 to 1000 cells in 1 to 100 columns");
  if (std::min(options.cell_width, options.cell_height) < 64 ||
      std::max(options.cell_width, options.cell_height) > 4096)
    return usage_error(
        fmt::format("cells of {} x {} pixels cannot be drawn", options.cell_width, options.cell_height),
        "ask for sides of 64 to 4096 pixels");
  return Done{};
}

/// Places on the page, pixels. Everything but the cells grows with their width.
class Layout {
 public:
  Layout(const SheetOptions& options, int cells, std::size_t notes)
      : options_(options),
        zoom_(std::clamp(options.cell_width / 320.0, 0.5, 4.0)),
        columns_(std::min(options.columns, cells)),
        rows_((cells + columns_ - 1) / columns_),
        header_(scaled(58) + static_cast<int>(notes) * note_line() + scaled(14)) {}

  int scaled(double pixels) const { return static_cast<int>(std::lround(pixels * zoom_)); }
  double size(double pixels) const { return pixels * zoom_; }
  int margin() const { return scaled(36); }
  int gap() const { return scaled(14); }
  int label_height() const { return scaled(38); }
  int note_line() const { return scaled(22); }
  int width() const { return 2 * margin() + columns_ * options_.cell_width + (columns_ - 1) * gap(); }
  int height() const { return grid_top() + rows_ * (options_.cell_height + gap()) + scaled(44); }
  int grid_top() const { return scaled(26) + header_; }
  int footer_baseline() const { return height() - scaled(26); }
  Box cell(int i) const {
    return {margin() + i % columns_ * (options_.cell_width + gap()),
            grid_top() + i / columns_ * (options_.cell_height + gap()), options_.cell_width,
            options_.cell_height};
  }

 private:
  SheetOptions options_;
  double zoom_;
  int columns_, rows_, header_;
};

void draw_header(Picture& page, const Layout& layout, const Fonts& fonts, const Shot& shot) {
  const double room = layout.width() - 2.0 * layout.margin();
  const std::string fallback =
      shot.clip->name.empty() ? shot.character->name : shot.character->name + " · " + shot.clip->name;
  const std::string& title = shot.title.empty() ? fallback : shot.title;
  int baseline = layout.scaled(58);
  fonts.bold.draw(page, layout.margin(), baseline, fonts.bold.fitted(title, layout.size(25), room),
                  layout.size(25), kInk);
  baseline += layout.scaled(8);
  for (const std::string& note : shot.notes) {
    baseline += layout.note_line();
    fonts.regular.draw(page, layout.margin(), baseline, fonts.regular.fitted(note, layout.size(14), room),
                       layout.size(14), kSoftInk);
  }
}

void draw_footer(Picture& page, const Layout& layout, const Fonts& fonts, const Shot& shot, bool follows) {
  const double size = layout.size(13);
  const int baseline = layout.footer_baseline();
  const int square = layout.scaled(12);
  const Box icon{layout.margin(), baseline - square + layout.scaled(1), square, square};
  outline(page, icon, 0.0, kSoftInk);
  fonts.regular.draw(page, layout.margin() + square + layout.scaled(8), baseline,
                     follows ? "grid 1 m  ·  the camera follows" : "grid 1 m", size, kSoftInk);
  const std::size_t frames = shot.clip->frames.size();
  const std::string figures = fmt::format("{:.2f} s  ·  {} frame{} at {:.4g} fps", shot.clip->duration_s(),
                                          frames, frames == 1 ? "" : "s", shot.clip->fps);
  fonts.regular.draw(page, layout.width() - layout.margin() - fonts.regular.width(figures, size), baseline,
                     figures, size, kSoftInk);
}

void draw_label(Picture& page, const Layout& layout, const Fonts& fonts, const Box& cell, double time_s,
                const std::string& phase) {
  const int left = cell.x + layout.scaled(14);
  const int baseline = cell.y + layout.scaled(27);
  const double after =
      fonts.bold.draw(page, left, baseline, fmt::format("{:.2f} s", time_s), layout.size(15), kInk);
  if (phase.empty()) return;
  const double size = layout.size(12);
  const int pad = layout.scaled(8);
  const int tag_left = static_cast<int>(std::lround(after)) + layout.scaled(10);
  const std::string text = fonts.regular.fitted(phase, size, cell.x + cell.width - tag_left - 3.0 * pad);
  const Box tag{tag_left, baseline - layout.scaled(15),
                static_cast<int>(std::ceil(fonts.regular.width(text, size))) + 2 * pad, layout.scaled(21)};
  const bool impact = phase.find("impact") != std::string::npos;
  fill(page, tag, 0.5 * tag.height, impact ? kAccent : kSoftInk);
  fonts.regular.draw(page, tag.x + pad, baseline, text, size, kPaper);
}

}  // namespace

Result<Picture> render_sheet(const Shot& shot, const SheetOptions& options) {
  if (const Status status = check(options); !status) return status.error();
  auto studio = open_studio(shot, options.shapes, options.cell_width, options.cell_height);
  if (!studio) return studio.error();

  const std::vector<Moment> moments = choose_moments(*shot.clip, studio->joints, options.cells);
  const Layout layout(options, static_cast<int>(moments.size()), shot.notes.size());
  if (std::max(layout.width(), layout.height()) > kLongestPageSide)
    return usage_error(fmt::format("a sheet of {} x {} pixels is too large", layout.width(), layout.height()),
                       "ask for fewer or smaller cells");
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();

  const Staging staging = set_stage(studio->figure, shot, studio->joints, moments,
                                    static_cast<double>(options.cell_width) / options.cell_height,
                                    static_cast<double>(layout.label_height()) / options.cell_height);
  Picture page = blank(layout.width(), layout.height(), kPage);
  draw_header(page, layout, *fonts, shot);
  draw_footer(page, layout, *fonts, shot, staging.follows());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const int frame = moments[i].frame;
    const Box cell = layout.cell(static_cast<int>(i));
    const double radius = layout.size(8);
    paste(page, studio->painter->draw(studio->geometry(frame), staging.at(frame)), cell.x, cell.y, radius);
    outline(page, cell, radius, kCellBorder);
    draw_label(page, layout, *fonts, cell, frame / shot.clip->fps, moments[i].phase);
  }
  return page;
}

}  // namespace ukemi
