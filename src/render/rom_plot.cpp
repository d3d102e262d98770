#include "render/rom_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/page.h"
#include "render/plot.h"

namespace ukemi {
namespace {

constexpr Color kGrid = hex(0xEFEAE2);
constexpr Color kZero = hex(0xCFC6B8);
constexpr Color kRegion = hex(0x4F7F8C);
constexpr Color kEarly = hex(0xE3A857);
constexpr Color kLate = hex(0x2B3A67);
constexpr std::array kSeries = {hex(0xC23B22), hex(0x2B3A67), hex(0x8A6FA8), hex(0x4F7F8C), hex(0xD08B2C)};

constexpr int kMargin = 36;
constexpr int kGap = 14;
constexpr double kCorner = 8.0;
constexpr double kOutside_deg = 0.1;  // what a file's reduced keys leave is not seen as outside

enum class Align { left, centre, right };

void write(Picture& page, const Font& font, const Vec2& at, Align align, const std::string& text, double size,
           Color color) {
  const double width = align == Align::left ? 0.0 : font.width(text, size);
  const double x = at.x() - (align == Align::centre ? 0.5 * width : width);
  font.draw(page, x, static_cast<int>(std::lround(at.y())), text, size, color);
}

/// The same on a pale ground that keeps it readable over lines.
void write_label(Picture& page, const Font& font, const Vec2& at, Align align, const std::string& text,
                 double size, Color color) {
  const double width = font.width(text, size);
  const double left = at.x() - (align == Align::left ? 0.0 : align == Align::centre ? 0.5 * width : width);
  const auto pixel = [](double v) { return static_cast<int>(std::lround(v)); };
  fill(page, {pixel(left - 4), pixel(at.y() - size), pixel(width + 8), pixel(1.3 * size)}, 4.0, kPaper, 0.85);
  write(page, font, {left, at.y()}, Align::left, text, size, color);
}

std::string number(double value) {
  const std::string text = fmt::format("{:g}", std::abs(value) < 1e-9 ? 0.0 : std::abs(value));
  return (value < -1e-9 ? "\u2212" : "") + text;
}

void draw_card(Picture& page, const Box& box) {
  fill(page, box, kCorner, kPaper);
  outline(page, box, kCorner, kCellBorder);
}

int header_height(const RomFigure& figure) { return 84 + 22 * static_cast<int>(figure.notes.size()); }

void draw_header(Picture& page, const Fonts& fonts, const RomFigure& figure) {
  const double room = page.width - 2.0 * kMargin;
  fonts.bold.draw(page, kMargin, 58, fonts.bold.fitted(figure.title, 25, room), 25, kInk);
  int baseline = 66;
  for (const std::string& note : figure.notes)
    fonts.regular.draw(page, kMargin, baseline += 22, fonts.regular.fitted(note, 14, room), 14, kSoftInk);
}

/// Corners of what a panel shows, degrees.
struct Extent {
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();

  void hold(const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

Vec2 in_degrees(const Vec2& swing) { return swing * degrees(1.0); }

Extent extent_of(const std::vector<RomPanel>& panels) {
  Extent extent;
  for (const RomPanel& panel : panels) {
    if (panel.range == nullptr) continue;
    for (const Vec2& corner : panel.range->polygon) extent.hold(in_degrees(corner));
    if (panel.path != nullptr)
      for (const SwingTwist& chart : panel.path->charts) extent.hold(in_degrees(chart.swing));
    if (panel.state) extent.hold(in_degrees(panel.state->swing));
  }
  return extent;
}

/// Both axes at the same pixels per degree, the extent in the middle with some air.
PlotScale scale_for(const Box& box, const Extent& extent) {
  const Vec2 size = 1.12 * (extent.high - extent.low) + Vec2::Constant(4.0);
  const double per_pixel = std::max(size.x() / box.width, size.y() / box.height);
  const Vec2 middle = 0.5 * (extent.low + extent.high);
  const Vec2 half = 0.5 * per_pixel * Vec2(box.width, box.height);
  return {box, middle - half, middle + half};
}

void draw_grid(Picture& page, const Fonts& fonts, const PlotScale& scale, bool numbers) {
  const Box& box = scale.box();
  const double step = tick_step(std::max((scale.high() - scale.low()).x(), (scale.high() - scale.low()).y()),
                                numbers ? 10 : 5);
  for (const double value : ticks(scale.low().x(), scale.high().x(), step)) {
    const Vec2 at = scale({value, scale.low().y()});
    draw_line(page, at, scale({value, scale.high().y()}), 1.0, value == 0.0 ? kZero : kGrid);
    if (numbers) write(page, fonts.regular, at + Vec2(0, 18), Align::centre, number(value), 12, kSoftInk);
  }
  for (const double value : ticks(scale.low().y(), scale.high().y(), step)) {
    const Vec2 at = scale({scale.low().x(), value});
    draw_line(page, at, scale({scale.high().x(), value}), 1.0, value == 0.0 ? kZero : kGrid);
    if (numbers) write(page, fonts.regular, at + Vec2(-8, 4), Align::right, number(value), 12, kSoftInk);
  }
  if (numbers) outline(page, {box.x - 1, box.y - 1, box.width + 2, box.height + 2}, 0.0, kCellBorder);
}

void draw_polygon(Picture& page, const PlotScale& scale, const JointRange& range, double width) {
  std::vector<Vec2> corners;
  for (const Vec2& corner : range.polygon) corners.push_back(scale(in_degrees(corner)));
  fill_polygon(page, corners, kRegion, 0.13);
  const Vec2 centre = scale(Vec2::Zero());
  for (const Vec2& corner : corners) draw_line(page, centre, corner, 1.0, kRegion, 0.28);
  for (std::size_t i = 0; i < corners.size(); ++i)
    draw_line(page, corners[i], corners[(i + 1) % corners.size()], width, kRegion);
  if (width >= 2.0)
    for (const Vec2& corner : corners) fill_disc(page, corner, 1.6 * width, kRegion);
}

Color time_color(std::size_t frame, std::size_t frames) {
  return mix(kEarly, kLate, frames > 1 ? static_cast<double>(frame) / static_cast<double>(frames - 1) : 0.0);
}

void draw_path(Picture& page, const PlotScale& scale, const RomPath& path, double width) {
  const std::size_t frames = path.charts.size();
  const auto at = [&](std::size_t i) { return scale(in_degrees(path.charts[i].swing)); };
  for (std::size_t i = 1; i < frames; ++i) draw_line(page, at(i - 1), at(i), width, time_color(i, frames));
  for (std::size_t i = 0; i < frames; ++i)
    if (path.excess_deg[i] > kOutside_deg) {
      if (i > 0) draw_line(page, at(i - 1), at(i), width, kAccent);
      fill_disc(page, at(i), 0.9 * width, kAccent);
    }
  if (frames == 0) return;
  fill_disc(page, at(0), 2.6 * width, kPaper);
  fill_disc(page, at(0), 2.0 * width, time_color(0, frames));
  fill_disc(page, at(frames - 1), 2.6 * width, kPaper);
  fill_disc(page, at(frames - 1), 2.0 * width, time_color(frames - 1, frames));
}

void draw_chords(Picture& page, const Fonts& fonts, const PlotScale& scale, const RomPanel::State& state) {
  struct End {
    Vec2 at;
    const char* name;
    double value;
    Vec2 shift;
    Align align;
  };
  const Vec2 a = state.swing;
  const auto& [y, z] = state.stops;
  const std::array<End, 4> ends = {{{{y[0], a.y()}, "θylo", y[0], {12, -10}, Align::left},
                                    {{y[1], a.y()}, "θyhi", y[1], {12, -10}, Align::left},
                                    {{a.x(), z[0]}, "θzlo", z[0], {12, 20}, Align::left},
                                    {{a.x(), z[1]}, "θzhi", z[1], {12, -10}, Align::left}}};
  const auto place = [&](const Vec2& swing) { return scale(in_degrees(swing)); };
  draw_line(page, place(ends[0].at), place(ends[1].at), 3.0, kAccent);
  draw_line(page, place(ends[2].at), place(ends[3].at), 3.0, kLate);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const End& end = ends[i];
    const bool horizontal = i < 2;
    const Color color = horizontal ? kAccent : kLate;
    const Box& box = scale.box();
    const Vec2 foot =
        horizontal ? Vec2(place(end.at).x(), box.y + box.height) : Vec2(box.x, place(end.at).y());
    draw_dashed_line(page, place(end.at), foot, 1.0, 4.0, color);
    fill_disc(page, place(end.at), 5.5, kPaper);
    fill_disc(page, place(end.at), 4.0, color);
    write_label(page, fonts.bold, place(end.at) + end.shift, end.align,
                fmt::format("{} {}°", end.name, number(std::round(10.0 * degrees(end.value)) / 10.0)), 15,
                color);
  }
  fill_disc(page, place(a), 8.5, kPaper);
  fill_disc(page, place(a), 6.5, kInk);
  write_label(page, fonts.bold, place(a) + Vec2(-14, -12), Align::right,
              fmt::format("({}°, {}°)", number(std::round(10.0 * degrees(a.x())) / 10.0),
                          number(std::round(10.0 * degrees(a.y())) / 10.0)),
              14, kInk);
}

/// "flexion", or "a_z" with its sign where the range does not name its meaning.
std::string meaning(const JointRange& range, std::size_t axis, bool positive) {
  constexpr std::array names = {"a_y", "a_z", "α"};
  const AxisMeaning& words = range.meanings[axis];
  const std::string& text = positive ? words.positive : words.negative;
  return text.empty() ? (positive ? "+" : "\u2212") + std::string(names[axis]) : text;
}

/// A panel's plane with numbers at its axes and words at their ends.
void draw_plane(Picture& page, const Fonts& fonts, const Box& card, const Extent& extent,
                const RomPanel& panel) {
  const Box box{card.x + 62, card.y + 52, card.width - 84, card.height - 118};
  const PlotScale scale = scale_for(box, extent);
  draw_grid(page, fonts, scale, true);
  draw_polygon(page, scale, *panel.range, 2.0);
  if (panel.path != nullptr) draw_path(page, scale, *panel.path, 2.6);
  if (panel.state) draw_chords(page, fonts, scale, *panel.state);
  const JointRange& range = *panel.range;
  const double bottom = card.y + card.height - 18;
  write(page, fonts.regular, {card.x + 18.0, card.y + 34.0}, Align::left,
        "a_z  ↑ " + meaning(range, 1, true) + "   ↓ " + meaning(range, 1, false), 14, kInk);
  write(page, fonts.regular, {double(box.x), bottom}, Align::left, "← " + meaning(range, 0, false), 14, kInk);
  write(page, fonts.regular, {box.x + 0.5 * box.width, bottom}, Align::centre, "a_y, degrees", 13, kSoftInk);
  write(page, fonts.regular, {double(box.x + box.width), bottom}, Align::right,
        meaning(range, 0, true) + " →", 14, kInk);
}

std::array<double, 2> twist_extent(const RomPanel& panel) {
  std::array<double, 2> ends = {degrees(panel.range->twist_min), degrees(panel.range->twist_max)};
  if (panel.path != nullptr)
    for (const SwingTwist& chart : panel.path->charts) {
      ends[0] = std::min(ends[0], degrees(chart.twist));
      ends[1] = std::max(ends[1], degrees(chart.twist));
    }
  return ends;
}

/// The twist's interval as an upright bar; a path is drawn along it from left (its start) to right.
void draw_twist(Picture& page, const Fonts& fonts, const Box& card, const RomPanel& panel) {
  const JointRange& range = *panel.range;
  const std::array<double, 2> ends = twist_extent(panel);
  const double air = 0.06 * (ends[1] - ends[0]) + 2.0;
  const Box box{card.x + 62, card.y + 52, card.width - 84, card.height - 118};
  const PlotScale scale(box, {0.0, ends[0] - air}, {1.0, ends[1] + air});
  for (const double value : ticks(scale.low().y(), scale.high().y(), tick_step(ends[1] - ends[0], 8))) {
    const Vec2 at = scale({0.0, value});
    draw_line(page, at, scale({1.0, value}), 1.0, value == 0.0 ? kZero : kGrid);
    write(page, fonts.regular, at + Vec2(-8, 4), Align::right, number(value), 12, kSoftInk);
  }
  const double low = degrees(range.twist_min), high = degrees(range.twist_max);
  fill_polygon(page, {scale({0, low}), scale({1, low}), scale({1, high}), scale({0, high})}, kRegion, 0.13);
  for (const double limit : {low, high}) draw_line(page, scale({0, limit}), scale({1, limit}), 2.0, kRegion);
  if (panel.path != nullptr) {
    const std::size_t frames = panel.path->charts.size();
    const auto at = [&](std::size_t i) {
      const double share = frames > 1 ? static_cast<double>(i) / static_cast<double>(frames - 1) : 0.5;
      return scale({share, degrees(panel.path->charts[i].twist)});
    };
    for (std::size_t i = 1; i < frames; ++i) {
      const double twist = degrees(panel.path->charts[i].twist);
      const bool outside = twist < low - kOutside_deg || twist > high + kOutside_deg;
      draw_line(page, at(i - 1), at(i), 2.2, outside ? kAccent : time_color(i, frames));
    }
  }
  outline(page, {box.x - 1, box.y - 1, box.width + 2, box.height + 2}, 0.0, kCellBorder);
  write(page, fonts.regular, {card.x + 18.0, card.y + 34.0}, Align::left, "α  ↑ " + meaning(range, 2, true),
        14, kInk);
  write(page, fonts.regular, {double(box.x), card.y + card.height - 42.0}, Align::left,
        "↓ " + meaning(range, 2, false), 14, kInk);
  write(page, fonts.regular, {double(box.x), card.y + card.height - 18.0}, Align::left,
        fmt::format("{}° to {}°", number(std::round(10.0 * low) / 10.0),
                    number(std::round(10.0 * high) / 10.0)),
        13, kSoftInk);
}

struct Series {
  std::string name;
  const RomPath* path;
  Color color;
};

void draw_series(Picture& page, const PlotScale& scale, const Series& series) {
  const auto at = [&](std::size_t i) {
    return scale({static_cast<double>(i) / series.path->fps, series.path->excess_deg[i]});
  };
  const std::size_t frames = series.path->excess_deg.size();
  for (std::size_t i = 1; i < frames; ++i) draw_line(page, at(i - 1), at(i), 1.8, series.color);
  if (frames == 1) fill_disc(page, at(0), 3.0, series.color);
}

/// Excess over time; `shown` may be empty.
void draw_excess(Picture& page, const Fonts& fonts, const Box& card, const std::vector<Series>& shown,
                 double duration_s) {
  const Box box{card.x + 62, card.y + 48, card.width - 84, card.height - 92};
  double highest = 1.2;
  for (const Series& series : shown)
    for (const double value : series.path->excess_deg) highest = std::max(highest, 1.1 * value);
  const PlotScale scale(box, {0.0, 0.0}, {std::max(duration_s, 1e-3), highest});
  for (const double value : ticks(0.0, highest, tick_step(highest, 5))) {
    draw_line(page, scale({0.0, value}), scale({scale.high().x(), value}), 1.0, value == 0.0 ? kZero : kGrid);
    write(page, fonts.regular, scale({0.0, value}) + Vec2(-8, 4), Align::right, number(value), 12, kSoftInk);
  }
  for (const double value : ticks(0.0, scale.high().x(), tick_step(scale.high().x(), 12)))
    write(page, fonts.regular, scale({value, 0.0}) + Vec2(0, 18), Align::centre, number(value) + " s", 12,
          kSoftInk);
  draw_dashed_line(page, scale({0.0, 1.0}), scale({scale.high().x(), 1.0}), 1.0, 5.0, kAccent);
  for (const Series& series : shown) draw_series(page, scale, series);
  write(page, fonts.regular, {card.x + 18.0, card.y + 32.0}, Align::left, "degrees outside the range", 14,
        kInk);
  double x = card.x + card.width - 22;
  for (auto series = shown.rbegin(); series != shown.rend(); ++series) {
    write(page, fonts.bold, {x, card.y + 32.0}, Align::right, series->name, 13, series->color);
    x -= fonts.bold.width(series->name, 13) + 18;
  }
  if (shown.empty())
    write(page, fonts.regular, {x, card.y + 32.0}, Align::right, "inside the range all the time", 13,
          kSoftInk);
}

double largest_excess(const RomPath& path) {
  return path.excess_deg.empty() ? 0.0 : *std::max_element(path.excess_deg.begin(), path.excess_deg.end());
}

double duration_of(const RomPath& path) {
  return path.charts.empty() ? 0.0 : static_cast<double>(path.charts.size() - 1) / path.fps;
}

/// From the start's colour to the end's, with their times.
void draw_time_key(Picture& page, const Fonts& fonts, double right, double baseline, double duration_s) {
  const std::string end = fmt::format("{:.2f} s", duration_s);
  write(page, fonts.regular, {right, baseline}, Align::right, end, 13, kSoftInk);
  const double bar_right = right - fonts.regular.width(end, 13) - 10, bar_left = bar_right - 120;
  for (int i = 0; i < 120; ++i)
    draw_line(page, {bar_left + i, baseline - 5}, {bar_left + i + 1, baseline - 5}, 6.0,
              mix(kEarly, kLate, i / 119.0));
  write(page, fonts.regular, {bar_left - 10, baseline}, Align::right, "0 s", 13, kSoftInk);
  const double red = bar_left - 60;
  write(page, fonts.regular, {red, baseline}, Align::right, "outside", 13, kSoftInk);
  const double dot = red - fonts.regular.width("outside", 13) - 12;
  fill_disc(page, {dot, baseline - 5}, 4.0, kAccent);
}

void draw_small_panel(Picture& page, const Fonts& fonts, const Box& card, const Extent& extent,
                      const RomPanel& panel) {
  draw_card(page, card);
  const JointRange& range = *panel.range;
  write(page, fonts.bold, {card.x + 12.0, card.y + 24.0}, Align::left, panel.title, 14, kInk);
  const bool outside = panel.path != nullptr && largest_excess(*panel.path) > 1.0;
  for (std::size_t i = 0; i < panel.notes.size(); ++i)
    write(page, fonts.regular, {card.x + 12.0, card.y + 42.0 + 16.0 * static_cast<double>(i)}, Align::left,
          panel.notes[i], 11, outside ? kAccent : kSoftInk);
  const Box box{card.x + 10, card.y + 66, card.width - 36, card.height - 98};
  const PlotScale scale = scale_for(box, extent);
  draw_grid(page, fonts, scale, false);
  draw_polygon(page, scale, range, 1.5);
  if (panel.path != nullptr) draw_path(page, scale, *panel.path, 1.5);
  write(page, fonts.regular, {box.x + 4.0, box.y + 10.0}, Align::left, "↑ " + meaning(range, 1, true), 10,
        kSoftInk);
  write(page, fonts.regular, {box.x + double(box.width), card.y + card.height - 12.0}, Align::right,
        meaning(range, 0, true) + " →", 10, kSoftInk);
  // The twist's bar, from -180 to 180 degrees.
  const PlotScale twist({card.x + card.width - 18, box.y, 8, box.height}, {0, -130}, {1, 130});
  fill(page, twist.box(), 3.0, kGrid);
  const double low = degrees(range.twist_min), high = degrees(range.twist_max);
  fill_polygon(page, {twist({0, low}), twist({1, low}), twist({1, high}), twist({0, high})}, kRegion, 0.6);
  if (panel.path == nullptr) return;
  const std::size_t frames = panel.path->charts.size();
  for (std::size_t i = 0; i < frames; ++i) {
    const double value = degrees(panel.path->charts[i].twist);
    const bool out = value < low - kOutside_deg || value > high + kOutside_deg;
    draw_line(page, twist({0.1, value}), twist({0.9, value}), 1.0, out ? kAccent : time_color(i, frames));
  }
}

void draw_reading_help(Picture& page, const Fonts& fonts, const Box& card) {
  const std::array lines = {
      "polygon", "where the link may swing: a_y to the right, a_z upwards, on one scale",
      "fan",     "its triangles about the middle of the range",
      "bar",     "the twist α about the link, from \u2212130° to 130°",
      "grid",    "50°, the darker lines through the reference direction"};
  write(page, fonts.bold, {card.x + 24.0, card.y + 40.0}, Align::left, "How to read it", 16, kInk);
  for (std::size_t i = 0; i < lines.size(); i += 2) {
    const double baseline = card.y + 82.0 + 19.0 * static_cast<double>(i);
    write(page, fonts.bold, {card.x + 24.0, baseline}, Align::left, lines[i], 14, kRegion);
    write(page, fonts.regular, {card.x + 110.0, baseline}, Align::left, lines[i + 1], 14, kSoftInk);
  }
}

std::vector<Series> worst_series(const RomFigure& figure) {
  std::vector<const RomPanel*> panels;
  for (const RomPanel& panel : figure.panels)
    if (panel.path != nullptr && largest_excess(*panel.path) > kOutside_deg) panels.push_back(&panel);
  std::stable_sort(panels.begin(), panels.end(), [](const RomPanel* a, const RomPanel* b) {
    return largest_excess(*a->path) > largest_excess(*b->path);
  });
  std::vector<Series> series;
  for (std::size_t i = 0; i < std::min(panels.size(), kSeries.size()); ++i)
    series.push_back({panels[i]->title, panels[i]->path, kSeries[i]});
  std::reverse(series.begin(), series.end());  // the worst on top
  return series;
}

/// Of the longest path, or nothing where no panel has one.
std::optional<double> duration_of(const RomFigure& figure) {
  std::optional<double> duration;
  for (const RomPanel& panel : figure.panels)
    if (panel.path != nullptr) duration = std::max(duration.value_or(0.0), duration_of(*panel.path));
  return duration;
}

}  // namespace

Result<Picture> draw_rom_joint(const RomFigure& figure) {
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  const RomPanel& panel = figure.panels.front();
  constexpr int kPlane = 680, kTwist = 250, kExcess = 220;
  const int top = header_height(figure);
  const int height = top + kPlane + (panel.path != nullptr ? kGap + kExcess : 0) + 54;
  Picture page = blank(2 * kMargin + kPlane + kGap + kTwist, height, kPage);
  draw_header(page, *fonts, figure);
  const Box plane{kMargin, top, kPlane, kPlane};
  draw_card(page, plane);
  draw_plane(page, *fonts, plane, extent_of(figure.panels), panel);
  const Box twist{kMargin + kPlane + kGap, top, kTwist, kPlane};
  draw_card(page, twist);
  draw_twist(page, *fonts, twist, panel);
  if (panel.path == nullptr) return page;
  const Box excess{kMargin, top + kPlane + kGap, kPlane + kGap + kTwist, kExcess};
  draw_card(page, excess);
  draw_excess(page, *fonts, excess, {{panel.title, panel.path, kAccent}}, duration_of(*panel.path));
  draw_time_key(page, *fonts, page.width - kMargin, height - 22, duration_of(*panel.path));
  return page;
}

Result<Picture> draw_rom_overview(const RomFigure& figure, int columns) {
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  constexpr int kWidth = 226, kHeight = 300;
  const int count = static_cast<int>(figure.panels.size());
  const int rows = (count + columns - 1) / columns;
  const int top = header_height(figure);
  const int width = 2 * kMargin + columns * (kWidth + kGap) - kGap;
  Picture page = blank(width, top + rows * (kHeight + kGap) + 40, kPage);
  draw_header(page, *fonts, figure);
  const Extent extent = extent_of(figure.panels);
  int free_from = columns;  // of the first row
  for (int i = count - 1; i >= 0; --i) {
    if (figure.panels[i].range == nullptr) {
      if (i < columns) free_from = i;
      continue;
    }
    const Box card{kMargin + i % columns * (kWidth + kGap), top + i / columns * (kHeight + kGap), kWidth,
                   kHeight};
    draw_small_panel(page, *fonts, card, extent, figure.panels[i]);
  }
  const std::optional<double> duration_s = duration_of(figure);
  if (duration_s) draw_time_key(page, *fonts, width - kMargin, page.height - 22, *duration_s);
  if (free_from == columns) return page;
  const Box card{kMargin + free_from * (kWidth + kGap), top, (columns - free_from) * (kWidth + kGap) - kGap,
                 kHeight};
  draw_card(page, card);
  if (duration_s)
    draw_excess(page, *fonts, card, worst_series(figure), *duration_s);
  else
    draw_reading_help(page, *fonts, card);
  return page;
}

Result<Picture> draw_rom_comparison(const RomFigure& figure) {
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  constexpr int kWidth = 560, kTitle = 76;
  const int count = static_cast<int>(figure.panels.size());
  const int top = header_height(figure);
  Picture page = blank(2 * kMargin + count * kWidth + (count - 1) * kGap, top + kTitle + kWidth + 54, kPage);
  draw_header(page, *fonts, figure);
  const Extent extent = extent_of(figure.panels);
  for (int i = 0; i < count; ++i) {
    const RomPanel& panel = figure.panels[i];
    const int left = kMargin + i * (kWidth + kGap);
    draw_card(page, {left, top, kWidth, kTitle + kWidth});
    write(page, fonts->bold, {left + 18.0, top + 32.0}, Align::left, panel.title, 19, kInk);
    for (std::size_t n = 0; n < panel.notes.size(); ++n)
      write(page, fonts->regular, {left + 18.0, top + 56.0 + 20.0 * static_cast<double>(n)}, Align::left,
            panel.notes[n], 14, kSoftInk);
    draw_plane(page, *fonts, {left, top + kTitle, kWidth, kWidth}, extent, panel);
  }
  if (const auto duration_s = duration_of(figure))
    draw_time_key(page, *fonts, page.width - kMargin, page.height - 22, *duration_s);
  return page;
}

}  // namespace ukemi
