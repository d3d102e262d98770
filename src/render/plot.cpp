#include "render/plot.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr int kSamples = 4;  // per pixel side, of filled polygons

struct PixelRange {
  int x0, y0, x1, y1;  // x1, y1 excluded
};

PixelRange around(const Picture& picture, const Vec2& low, const Vec2& high) {
  const auto from = [](double v) { return std::max(0, static_cast<int>(std::floor(std::max(v, 0.0)))); };
  const auto to = [](double v, int end) {
    return static_cast<int>(std::ceil(std::clamp(v, 0.0, static_cast<double>(end))));
  };
  return {from(low.x()), from(low.y()), to(high.x() + 1.0, picture.width),
          to(high.y() + 1.0, picture.height)};
}

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along - point).norm();
}

bool inside(const std::vector<Vec2>& corners, const Vec2& point) {
  bool result = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec2& a = corners[i];
    const Vec2& b = corners[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x()) result = !result;
  }
  return result;
}

double coverage(const std::vector<Vec2>& corners, int x, int y) {
  int hits = 0;
  for (int i = 0; i < kSamples; ++i)
    for (int j = 0; j < kSamples; ++j)
      hits += inside(corners, {x + (i + 0.5) / kSamples, y + (j + 0.5) / kSamples});
  return static_cast<double>(hits) / (kSamples * kSamples);
}

}  // namespace

void draw_line(Picture& picture, const Vec2& a, const Vec2& b, double width, Color color, double opacity) {
  if (!a.allFinite() || !b.allFinite()) return;
  const Vec2 reach = Vec2::Constant(0.5 * width + 1.0);
  const PixelRange range = around(picture, a.cwiseMin(b) - reach, a.cwiseMax(b) + reach);
  for (int y = range.y0; y < range.y1; ++y)
    for (int x = range.x0; x < range.x1; ++x) {
      const double distance = distance_to_segment({x + 0.5, y + 0.5}, a, b);
      blend(picture, x, y, color, opacity * std::clamp(0.5 * width - distance + 0.5, 0.0, 1.0));
    }
}

void draw_dashed_line(Picture& picture, const Vec2& a, const Vec2& b, double width, double dash,
                      Color color) {
  const double length = (b - a).norm();
  for (double at = 0.0; at < length; at += 2.0 * dash)
    draw_line(picture, a + (b - a) * (at / length), a + (b - a) * (std::min(at + dash, length) / length),
              width, color);
}

void fill_disc(Picture& picture, const Vec2& centre, double radius, Color color, double opacity) {
  draw_line(picture, centre, centre, 2.0 * radius, color, opacity);
}

void fill_polygon(Picture& picture, const std::vector<Vec2>& corners, Color color, double opacity) {
  if (corners.size() < 3) return;
  Vec2 low = corners.front(), high = corners.front();
  for (const Vec2& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const PixelRange range = around(picture, low, high);
  for (int y = range.y0; y < range.y1; ++y)
    for (int x = range.x0; x < range.x1; ++x) blend(picture, x, y, color, opacity * coverage(corners, x, y));
}

Color mix(Color a, Color b, double share) {
  const auto channel = [share](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * std::clamp(share, 0.0, 1.0)));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

double tick_step(double span, int most) {
  const double least = span / most;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= least * (1.0 - 1e-9)) return factor * decade;
  return 10.0 * decade;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> values;
  const auto first = static_cast<long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(high / step + 1e-9));
  for (long i = first; i <= last; ++i) values.push_back(static_cast<double>(i) * step);
  return values;
}

}  // namespace ukemi
