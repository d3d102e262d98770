#include "render/canvas.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

/// Signed distance of a pixel's centre to the rounded box, pixels; negative inside.
double distance_to(const Box& box, double radius, int x, int y) {
  const double px = std::abs(x + 0.5 - box.x - 0.5 * box.width) - 0.5 * box.width + radius;
  const double py = std::abs(y + 0.5 - box.y - 0.5 * box.height) - 0.5 * box.height + radius;
  return std::hypot(std::max(px, 0.0), std::max(py, 0.0)) + std::min(std::max(px, py), 0.0) - radius;
}

double coverage_of(double distance) { return std::clamp(0.5 - distance, 0.0, 1.0); }

template <typename Visit>
void each_pixel(const Box& box, Visit&& visit) {
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) visit(x, y);
}

}  // namespace

Picture blank(int width, int height, Color color) {
  Picture picture{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 255)};
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    picture.rgba[i] = color.r;
    picture.rgba[i + 1] = color.g;
    picture.rgba[i + 2] = color.b;
  }
  return picture;
}

void blend(Picture& picture, int x, int y, Color color, double coverage) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height || coverage <= 0.0) return;
  std::uint8_t* pixel = picture.rgba.data() + (static_cast<std::size_t>(y) * picture.width + x) * 4;
  const std::uint8_t target[3] = {color.r, color.g, color.b};
  for (int i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround(pixel[i] + (target[i] - pixel[i]) * coverage));
}

void fill(Picture& picture, const Box& box, double radius, Color color, double opacity) {
  each_pixel(box, [&](int x, int y) {
    blend(picture, x, y, color, opacity * coverage_of(distance_to(box, radius, x, y)));
  });
}

void outline(Picture& picture, const Box& box, double radius, Color color) {
  each_pixel(box, [&](int x, int y) {
    const double distance = distance_to(box, radius, x, y);
    blend(picture, x, y, color, coverage_of(distance) - coverage_of(distance + 1.0));
  });
}

void paste(Picture& picture, const Picture& source, int x, int y, double radius) {
  const Box box{x, y, source.width, source.height};
  each_pixel(box, [&](int px, int py) {
    const std::uint8_t* from =
        source.rgba.data() + (static_cast<std::size_t>(py - y) * source.width + (px - x)) * 4;
    blend(picture, px, py, {from[0], from[1], from[2]}, coverage_of(distance_to(box, radius, px, py)));
  });
}

}  // namespace ukemi
