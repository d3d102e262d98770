#include "render/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/page.h"

namespace ukemi {
namespace {

constexpr int kMargin = 36;
constexpr int kNames = 110;     // width of the rows' names
constexpr int kPanel = 330;     // width of a scale
constexpr int kPanelGap = 100;  // room for the number after the longest line
constexpr int kZero = 26;       // width left of a scale, for zeros
constexpr int kRow = 34;
constexpr double kDot = 6.0;
constexpr double kTitleSize = 23, kTextSize = 14, kSmallSize = 12;
constexpr Color kOther = hex(0x8C8377);
constexpr Color kStrong = hex(0x1F7A5C);

/// Whole powers of ten around the positive values.
struct Scale {
  int low = -1, high = 1;

  double place(double value) const { return std::clamp((std::log10(value) - low) / (high - low), 0.0, 1.0); }
};

Scale scale_of(const std::vector<double>& values) {
  Scale scale;
  bool found = false;
  for (const double value : values) {
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    const double power = std::log10(value);
    const int low = static_cast<int>(std::floor(power));
    const int high = static_cast<int>(std::ceil(power));
    scale.low = found ? std::min(scale.low, low) : low;
    scale.high = found ? std::max(scale.high, high) : high;
    found = true;
  }
  scale.high = std::max(scale.high, scale.low + 1);
  return scale;
}

std::string number(double value) {
  if (value >= 100.0) return fmt::format("{:.0f}", value);
  if (value >= 0.01 || value == 0.0) return fmt::format("{:.2g}", value);
  return fmt::format("{:.0e}", value);
}

std::string power_of_ten(int power) {
  if (power >= -3 && power <= 4) return fmt::format("{:g}", std::pow(10.0, power));
  return fmt::format("1e{}", power);
}

void draw_scale(Picture& page, const Fonts& fonts, const ChartPanel& panel, const Scale& scale, int x, int y,
                int height) {
  fonts.bold.draw(page, x, y - 14, panel.title, kTextSize, kInk);
  fonts.regular.draw(page, x + fonts.bold.width(panel.title, kTextSize) + 8, y - 14, panel.unit, kTextSize,
                     kSoftInk);
  const int powers = scale.high - scale.low;
  const int every = powers > 6 ? 2 : 1;
  for (int i = 0; i <= powers; ++i) {
    const int at = x + i * kPanel / powers;
    fill(page, {at, y, 1, height}, 0.0, kCellBorder);
    if (i % every != 0) continue;
    const std::string text = power_of_ten(scale.low + i);
    fonts.regular.draw(page, at - 0.5 * fonts.regular.width(text, kSmallSize), y + height + 18, text,
                       kSmallSize, kSoftInk);
  }
}

void draw_values(Picture& page, const Fonts& fonts, const Chart& chart, const ChartPanel& panel,
                 const Scale& scale, int x, int y) {
  for (std::size_t row = 0; row < panel.values.size(); ++row) {
    const double value = panel.values[row];
    const Color color = chart.strong[row] ? kStrong : kOther;
    const int middle = y + static_cast<int>(row) * kRow + kRow / 2;
    const bool zero = !(value > 0.0);
    const int at = zero ? x - kZero : x + static_cast<int>(std::lround(scale.place(value) * kPanel));
    if (!zero) fill(page, {x, middle - 1, at - x, 3}, 1.0, color, 0.55);
    const int side = static_cast<int>(2 * kDot);
    fill(page, {at - side / 2, middle - side / 2, side, side}, kDot, color);
    const std::string text = number(value);
    if (zero)
      fonts.bold.draw(page, at + kDot + 3, middle + 5, text, kSmallSize, color);
    else
      fonts.regular.draw(page, at + kDot + 5, middle + 5, text, kSmallSize, kInk);
  }
}

}  // namespace

Result<Picture> render_chart(const Chart& chart) {
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  const int rows_height = static_cast<int>(chart.rows.size()) * kRow;
  const int top = kMargin + 36 + 23 * static_cast<int>(chart.notes.size()) + 44;
  const int panels = static_cast<int>(chart.panels.size());
  Picture page =
      blank(2 * kMargin + kNames + panels * (kPanel + kPanelGap), top + rows_height + 30 + kMargin, kPage);
  int baseline = kMargin + 20;
  fonts->bold.draw(page, kMargin, baseline, chart.title, kTitleSize, kInk);
  for (const std::string& note : chart.notes)
    fonts->regular.draw(page, kMargin, baseline += 23, note, kTextSize, kSoftInk);
  for (std::size_t row = 0; row < chart.rows.size(); ++row) {
    const int y = top + static_cast<int>(row) * kRow;
    if (row % 2 == 0)
      fill(page, {kMargin - 8, y, page.width - 2 * kMargin + 16, kRow}, 4.0, kCellBorder, 0.28);
    fonts->bold.draw(page, kMargin, y + kRow / 2 + 5, chart.rows[row], kTextSize,
                     chart.strong[row] ? kStrong : kInk);
  }
  for (int i = 0; i < panels; ++i) {
    const ChartPanel& panel = chart.panels[i];
    const Scale scale = scale_of(panel.values);
    const int x = kMargin + kNames + i * (kPanel + kPanelGap) + kZero;
    draw_scale(page, *fonts, panel, scale, x, top, rows_height);
    draw_values(page, *fonts, chart, panel, scale, x, top);
  }
  return page;
}

}  // namespace ukemi
