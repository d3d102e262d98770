#include "render/sheet_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plot.h"

namespace ukemi {
namespace {

constexpr double kTitleSize = 26, kFactSize = 16, kFactLabelSize = 12, kNoteSize = 14, kSmallSize = 12.5;
constexpr double kSmallestTitle = 0.55;  // of its size, before it is cut
constexpr double kFactGap = 34, kFactRow = 48, kNoteRow = 22;

struct PlacedFact {
  const Fact* fact;
  double x = 0.0;
  int row = 0;
};

/// Side by side, as many as there is room for in a row.
std::vector<PlacedFact> place_facts(const Pen& pen, const std::vector<Fact>& facts, double room) {
  std::vector<PlacedFact> placed;
  double x = 0.0;
  int row = 0;
  for (const Fact& fact : facts) {
    const double width = std::max(pen.fonts.regular.width(fact.label, pen.size(kFactLabelSize)),
                                  pen.fonts.bold.width(fact.value, pen.size(kFactSize)));
    if (x > 0.0 && x + width > room) {
      x = 0.0;
      ++row;
    }
    placed.push_back({&fact, x, row});
    x += width + pen.size(kFactGap);
  }
  return placed;
}

double time_of(const SpeedCurve& timeline) {
  return static_cast<double>(timeline.speeds.size() - 1) / timeline.fps;
}

/// A round tick, far enough from the next for its label.
double time_step(double duration_s, int width, double label_px) {
  return std::max(tick_step(duration_s, std::max(1, static_cast<int>(width / label_px))), 0.1);
}

void draw_curve(Picture& page, const Pen& pen, const SpeedCurve& timeline, const Box& box) {
  const double peak = *std::max_element(timeline.speeds.begin(), timeline.speeds.end());
  if (!(peak > 0.0)) return;
  const double last = static_cast<double>(timeline.speeds.size() - 1);
  const double base = box.y + box.height;
  Vec2 before(box.x, base);
  for (int px = 0; px <= box.width; ++px) {
    const double at = last * px / box.width;
    const auto frame = static_cast<std::size_t>(std::min(at, last - 1.0));
    const double share = at - static_cast<double>(frame);
    const double speed = timeline.speeds[frame] * (1.0 - share) + timeline.speeds[frame + 1] * share;
    const Vec2 point(box.x + px, base - box.height * speed / peak);
    for (int y = static_cast<int>(std::ceil(point.y())); y < base; ++y)
      blend(page, box.x + px, y, pen.theme.accent, 0.13);
    if (px > 0) draw_line(page, before, point, pen.size(1.5), pen.theme.accent, 0.8);
    before = point;
  }
  const std::string text = fmt::format("mean speed of the joints, at most {:.1f} m/s", peak);
  const double size = pen.size(kSmallSize);
  const double width = pen.fonts.regular.width(text, size);
  const int left = box.x + box.width - static_cast<int>(std::ceil(width));
  fill(
      page,
      {left - pen.scaled(4), box.y - pen.scaled(10), static_cast<int>(width) + pen.scaled(4), pen.scaled(15)},
      0.0, pen.theme.page, 0.85);
  pen.fonts.regular.draw(page, left, box.y + pen.scaled(2), text, size, pen.theme.soft_ink);
}

}  // namespace

int Pen::scaled(double pixels) const { return static_cast<int>(std::lround(pixels * zoom)); }

int heading_height(const Pen& pen, const Heading& heading, int room) {
  const std::vector<PlacedFact> facts = place_facts(pen, heading.facts, room);
  const int rows = facts.empty() ? 0 : facts.back().row + 1;
  return pen.scaled(34) + rows * pen.scaled(kFactRow) +
         static_cast<int>(heading.notes.size()) * pen.scaled(kNoteRow) + pen.scaled(14);
}

void draw_heading(Picture& page, const Pen& pen, const Heading& heading, int x, int y, int room) {
  const Fonts& fonts = pen.fonts;
  const double wanted = fonts.bold.width(heading.title, pen.size(kTitleSize));
  const double title_size = pen.size(kTitleSize) * std::clamp(room / wanted, kSmallestTitle, 1.0);
  fonts.bold.draw(page, x, y + pen.scaled(22), fonts.bold.fitted(heading.title, title_size, room), title_size,
                  pen.theme.ink);
  int top = y + pen.scaled(34);
  for (const PlacedFact& placed : place_facts(pen, heading.facts, room)) {
    const int row = top + placed.row * pen.scaled(kFactRow);
    fonts.regular.draw(page, x + placed.x, row + pen.scaled(17), placed.fact->label, pen.size(kFactLabelSize),
                       pen.theme.soft_ink);
    const std::string value = fonts.bold.fitted(placed.fact->value, pen.size(kFactSize), room - placed.x);
    fonts.bold.draw(page, x + placed.x, row + pen.scaled(37), value, pen.size(kFactSize), pen.theme.ink);
  }
  const std::vector<PlacedFact> facts = place_facts(pen, heading.facts, room);
  if (!facts.empty()) top += (facts.back().row + 1) * pen.scaled(kFactRow);
  for (const std::string& note : heading.notes) {
    fonts.regular.draw(page, x, top + pen.scaled(17), fonts.regular.fitted(note, pen.size(kNoteSize), room),
                       pen.size(kNoteSize), pen.theme.soft_ink);
    top += pen.scaled(kNoteRow);
  }
}

int label_height(const Pen& pen) { return pen.scaled(38); }

void draw_label(Picture& page, const Pen& pen, const Box& cell, const std::string& time,
                const std::string& phase) {
  const int left = cell.x + pen.scaled(14);
  const int baseline = cell.y + pen.scaled(27);
  const double after = pen.fonts.bold.draw(page, left, baseline, time, pen.size(15), pen.theme.ink);
  if (phase.empty()) return;
  const double size = pen.size(12);
  const int pad = pen.scaled(8);
  const int tag_left = static_cast<int>(std::lround(after)) + pen.scaled(14);
  const std::string text = pen.fonts.regular.fitted(phase, size, cell.x + cell.width - tag_left - 3.0 * pad);
  const Box tag{tag_left, baseline - pen.scaled(15),
                static_cast<int>(std::ceil(pen.fonts.regular.width(text, size))) + 2 * pad, pen.scaled(21)};
  const bool impact = phase.find("impact") != std::string::npos;
  fill(page, tag, 0.5 * tag.height, impact ? pen.theme.accent : kTag);
  pen.fonts.regular.draw(page, tag.x + pad, baseline, text, size, pen.theme.on_accent);
}

int timeline_height(const Pen& pen) { return pen.scaled(82); }

void draw_timeline(Picture& page, const Pen& pen, const SpeedCurve& timeline, const Box& box) {
  if (timeline.speeds.size() < 2) return;
  const double duration = time_of(timeline);
  const int base = box.y + box.height - pen.scaled(26);
  draw_curve(page, pen, timeline, {box.x, box.y + pen.scaled(6), box.width, base - box.y - pen.scaled(6)});
  fill(page, {box.x, base, box.width, std::max(1, pen.scaled(1))}, 0.0, pen.theme.soft_ink);
  const auto place = [&](double time_s) { return box.x + time_s / duration * box.width; };
  const double size = pen.size(kSmallSize);
  for (const double time : ticks(0.0, duration, time_step(duration, box.width, pen.size(90)))) {
    const std::string text = fmt::format("{:g} s", std::round(time * 1000.0) / 1000.0);
    const double width = pen.fonts.regular.width(text, size);
    const double x = std::clamp(place(time) - 0.5 * width, box.x + 0.0, box.x + box.width - width);
    pen.fonts.regular.draw(page, x, base + pen.scaled(22), text, size, pen.theme.soft_ink);
  }
  for (const Moment& moment : timeline.moments) {
    const Vec2 centre(place(moment.frame / timeline.fps), base);
    const bool impact = moment.phase.find("impact") != std::string::npos;
    fill_disc(page, centre, pen.size(5.0), pen.theme.page);
    fill_disc(page, centre, pen.size(3.6), impact ? pen.theme.accent : pen.theme.ink);
  }
}

double draw_scale(Picture& page, const Pen& pen, const StageView& stage, int cell_height, int x, int baseline,
                  const std::string& remark) {
  const Vec3 focus = stage.focus + Vec3(0.0, 0.5, 0.0);
  const double distance = (stage.camera.eye - focus).dot(stage.camera.world_from_camera * Vec3::UnitZ());
  const double per_metre = cell_height / (2.0 * std::tan(0.5 * stage.camera.vertical_fov) * distance);
  double metres = 1.0;
  while (metres * per_metre > pen.size(260.0)) metres *= 0.5;
  while (metres * per_metre < pen.size(40.0)) metres *= 2.0;
  const int length = static_cast<int>(std::lround(metres * per_metre));
  const int thick = std::max(1, pen.scaled(1.4));
  const int tall = pen.scaled(9);
  fill(page, {x, baseline - pen.scaled(1) - thick, length, thick}, 0.0, pen.theme.ink);
  for (const int end : {x, x + length - thick})
    fill(page, {end, baseline - pen.scaled(1) - tall, thick, tall}, 0.0, pen.theme.ink);
  std::string text = fmt::format("{:g} m", metres);
  if (!remark.empty()) text += "  ·  " + remark;
  return pen.fonts.regular.draw(page, x + length + pen.scaled(9), baseline, text, pen.size(13),
                                pen.theme.soft_ink);
}

}  // namespace ukemi
