#include "render/lighting.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

/// One pass of a box filter of 2 radius + 1 along rows; the picture comes out transposed.
void box_blur_transposed(const std::vector<float>& from, std::vector<float>& to, int size, int radius) {
  const float weight = 1.0f / static_cast<float>(2 * radius + 1);
  for (int y = 0; y < size; ++y) {
    const float* row = from.data() + static_cast<std::size_t>(y) * size;
    float sum = 0.0f;
    for (int x = 0; x < radius && x < size; ++x) sum += row[x];
    for (int x = 0; x < size; ++x) {
      if (x + radius < size) sum += row[x + radius];
      to[static_cast<std::size_t>(x) * size + y] = sum * weight;
      if (x >= radius) sum -= row[x - radius];
    }
  }
}

}  // namespace

Vec3 towards(const Camera& camera, double azimuth, double elevation) {
  const Vec3 back = camera.world_from_camera * Vec3::UnitZ();
  const double turn = std::atan2(back.x(), back.z()) + azimuth;
  return {std::sin(turn) * std::cos(elevation), std::sin(elevation), std::cos(turn) * std::cos(elevation)};
}

ShadowBounds shadow_bounds(const Geometry& geometry, const Vec3& focus) {
  ShadowBounds bounds;
  for (const Piece& piece : geometry.pieces) {
    if (!piece.surface.casts_shadow) continue;
    for (std::uint32_t i = piece.first; i < piece.first + piece.count; ++i) {
      const Eigen::Vector3f& p = geometry.vertices[geometry.indices[i]].position;
      bounds.low = bounds.low.cwiseMin(p);
      bounds.high = bounds.high.cwiseMax(p);
    }
  }
  if (bounds.low.x() > bounds.high.x()) bounds.low = bounds.high = focus.cast<float>();
  return bounds;
}

Vec3 floor_area(const ShadowBounds& bounds, double floor_y, const Vec3& to_key) {
  const double shift = std::max(0.0, bounds.high.y() - floor_y);
  Eigen::AlignedBox2d area;
  for (const double height : {0.0, shift}) {
    const Vec2 slide = -height / to_key.y() * Vec2(to_key.x(), to_key.z());
    area.extend(Vec2(bounds.low.x(), bounds.low.z()) + slide);
    area.extend(Vec2(bounds.high.x(), bounds.high.z()) + slide);
  }
  const Vec2 centre = area.center();
  return {centre.x(), centre.y(), 0.5 * area.sizes().maxCoeff() + 3.0 * (kPenumbra_m + kContactBlur_m)};
}

void blur(std::vector<float>& map, int size, double radius_px) {
  const int radius = std::max(1, static_cast<int>(std::lround(radius_px)));
  std::vector<float> other(map.size());
  for (int pass = 0; pass < 3; ++pass) {
    box_blur_transposed(map, other, size, radius);
    box_blur_transposed(other, map, size, radius);
  }
}

}  // namespace ukemi
