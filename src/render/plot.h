// Lines, polygons and scales for figures. Positions are in pixels, x to the right, y down.
#pragma once

#include <vector>

#include "base/math.h"
#include "render/canvas.h"

namespace ukemi {

/// With round ends.
void draw_line(Picture& picture, const Vec2& a, const Vec2& b, double width, Color color,
               double opacity = 1.0);
void draw_dashed_line(Picture& picture, const Vec2& a, const Vec2& b, double width, double dash, Color color);
void fill_disc(Picture& picture, const Vec2& centre, double radius, Color color, double opacity = 1.0);
/// Even-odd; any simple polygon.
void fill_polygon(Picture& picture, const std::vector<Vec2>& corners, Color color, double opacity = 1.0);
/// The colour `share` of the way from a to b.
Color mix(Color a, Color b, double share);

/// Linear scales of a plot's two axes.
class PlotScale {
 public:
  PlotScale(const Box& box, const Vec2& low, const Vec2& high) : box_(box), low_(low), high_(high) {}

  Vec2 operator()(const Vec2& value) const {
    const Vec2 share = (value - low_).cwiseQuotient(high_ - low_);
    return {box_.x + share.x() * box_.width, box_.y + (1.0 - share.y()) * box_.height};
  }
  const Box& box() const { return box_; }
  const Vec2& low() const { return low_; }
  const Vec2& high() const { return high_; }

 private:
  Box box_;
  Vec2 low_, high_;
};

/// 1, 2 or 5 times a power of ten, so that at most `most` steps fit into `span`.
double tick_step(double span, int most);
/// The multiples of `step` from `low` to `high`.
std::vector<double> ticks(double low, double high, double step);

}  // namespace ukemi
