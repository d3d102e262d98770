// Flat drawing on pictures: colours are sRGB, coverage is blended in sRGB as text expects.
#pragma once

#include <cstdint>

#include "render/render.h"

namespace ukemi {

struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
};

constexpr Color hex(std::uint32_t rgb) {
  return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>((rgb >> 8) & 0xff),
          static_cast<std::uint8_t>(rgb & 0xff)};
}

struct Box {
  int x = 0, y = 0, width = 0, height = 0;
};

Picture blank(int width, int height, Color color);
/// Coverage in [0, 1]; a pixel outside is ignored.
void blend(Picture& picture, int x, int y, Color color, double coverage);
void fill(Picture& picture, const Box& box, double radius, Color color, double opacity = 1.0);
/// A line of one pixel inside the rounded box.
void outline(Picture& picture, const Box& box, double radius, Color color);
/// Copies `source` with rounded corners.
void paste(Picture& picture, const Picture& source, int x, int y, double radius);

}  // namespace ukemi
