#include "render/geometry.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

float linear_from_srgb(double value) {
  return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

std::uint32_t add_vertex(Geometry& geometry, const Vec3& position, const Vec3& normal, const Rgba& color) {
  geometry.vertices.push_back({position.cast<float>(), normal.cast<float>(), Eigen::Vector2f::Zero(), color});
  return static_cast<std::uint32_t>(geometry.vertices.size() - 1);
}

void add_triangle(Geometry& geometry, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  geometry.indices.insert(geometry.indices.end(), {a, b, c});
  geometry.pieces.back().count += 3;
}

/// A point of the outline that is turned about the y axis.
struct ProfilePoint {
  double radius, y;
  double normal_radius, normal_y;
  Rgba color;
};

/// Surface of revolution about y, outline from bottom to top.
void add_revolution(Geometry& geometry, const Rigid& world, const std::vector<ProfilePoint>& outline,
                    int sides) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  const auto row = static_cast<std::uint32_t>(sides + 1);
  for (const ProfilePoint& point : outline)
    for (int side = 0; side <= sides; ++side) {
      const double angle = 2.0 * kPi * (side % sides) / sides;
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      add_vertex(geometry, world * Vec3(point.radius * c, point.y, point.radius * s),
                 world.rotation * Vec3(point.normal_radius * c, point.normal_y, point.normal_radius * s),
                 point.color);
    }
  for (std::uint32_t ring = 0; ring + 1 < outline.size(); ++ring)
    for (std::uint32_t side = 0; side + 1 < row; ++side) {
      const std::uint32_t a = first + ring * row + side;
      add_triangle(geometry, a, a + row, a + row + 1);
      add_triangle(geometry, a, a + row + 1, a + 1);
    }
}

/// Arc of a sphere about (0, centre_y) between two latitudes, radians.
void add_arc(std::vector<ProfilePoint>& outline, double radius, double centre_y, double from, double to,
             int steps, const Rgba& color) {
  for (int i = 0; i <= steps; ++i) {
    const double latitude = from + (to - from) * i / steps;
    const double c = std::cos(latitude);
    const double s = std::sin(latitude);
    outline.push_back({radius * c, centre_y + radius * s, c, s, color});
  }
}

}  // namespace

Rgba srgb(std::uint32_t hex, float alpha) {
  const auto channel = [hex](int shift) { return linear_from_srgb(((hex >> shift) & 0xff) / 255.0); };
  return {channel(16), channel(8), channel(0), alpha};
}

void Geometry::begin(const Surface& surface) {
  pieces.push_back({surface, static_cast<std::uint32_t>(indices.size()), 0});
}

void add_capsule(Geometry& geometry, const Rigid& world_from_shape, double radius, double length,
                 const Rgba& color) {
  std::vector<ProfilePoint> outline;
  add_arc(outline, radius, -0.5 * length, -0.5 * kPi, 0.0, 8, color);
  add_arc(outline, radius, 0.5 * length, 0.0, 0.5 * kPi, 8, color);
  add_revolution(geometry, world_from_shape, outline, 28);
}

void add_ball(Geometry& geometry, const Rigid& world_from_ball, double radius, const Rgba& color,
              const Rgba& band_color) {
  constexpr double kBand = 0.16;  // radians of latitude
  std::vector<ProfilePoint> outline;
  add_arc(outline, radius, 0.0, -0.5 * kPi, -kBand, 10, color);
  add_arc(outline, radius, 0.0, -kBand, kBand, 3, band_color);
  add_arc(outline, radius, 0.0, kBand, 0.5 * kPi, 10, color);
  add_revolution(geometry, world_from_ball, outline, 40);
}

void add_box(Geometry& geometry, const Rigid& world_from_box, const Vec3& size, const Rgba& color) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = side * Vec3::Unit(axis);
      const Vec3 u = side * Vec3::Unit((axis + 1) % 3);
      const Vec3 v = Vec3::Unit((axis + 2) % 3);
      std::array<std::uint32_t, 4> corner{};
      for (int i = 0; i < 4; ++i) {
        const Vec3 place = normal + (i == 1 || i == 2 ? 1.0 : -1.0) * u + (i >= 2 ? 1.0 : -1.0) * v;
        corner[i] = add_vertex(geometry, world_from_box * Vec3(0.5 * size.cwiseProduct(place)),
                               world_from_box.rotation * normal, color);
      }
      add_triangle(geometry, corner[0], corner[1], corner[2]);
      add_triangle(geometry, corner[0], corner[2], corner[3]);
    }
}

void add_octahedron(Geometry& geometry, const Vec3& from, const Vec3& to, double radius, const Rgba& color) {
  const Vec3 along = to - from;
  const Quat turn = shortest_rotation(Vec3::UnitY(), along);
  const Vec3 waist = from + 0.15 * along;
  std::array<std::uint32_t, 6> corner{};
  corner[4] = add_vertex(geometry, from, Vec3::Zero(), color);
  corner[5] = add_vertex(geometry, to, Vec3::Zero(), color);
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.5 * kPi * i;
    corner[i] =
        add_vertex(geometry, waist + turn * Vec3(radius * std::cos(angle), 0.0, radius * std::sin(angle)),
                   Vec3::Zero(), color);
  }
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    add_triangle(geometry, corner[4], corner[i], corner[next]);
    add_triangle(geometry, corner[5], corner[next], corner[i]);
  }
}

void add_tube(Geometry& geometry, const std::vector<Vec3>& points, double radius, const Rgba& color) {
  constexpr std::uint32_t kSides = 7;
  if (points.size() < 2) return;
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 along = points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
    const Quat turn = shortest_rotation(Vec3::UnitY(), along);
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const double angle = 2.0 * kPi * side / kSides;
      const Vec3 out = turn * Vec3(std::cos(angle), 0.0, std::sin(angle));
      add_vertex(geometry, points[i] + radius * out, out, color);
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < points.size(); ++ring)
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t a = first + ring * kSides + side;
      const std::uint32_t b = first + ring * kSides + (side + 1) % kSides;
      add_triangle(geometry, a, a + kSides, b + kSides);
      add_triangle(geometry, a, b + kSides, b);
    }
}

void add_flat_triangle(Geometry& geometry, const std::array<Vec3, 3>& corners, const Rgba& color) {
  std::array<std::uint32_t, 3> vertex{};
  for (std::size_t i = 0; i < 3; ++i) vertex[i] = add_vertex(geometry, corners[i], Vec3::Zero(), color);
  add_triangle(geometry, vertex[0], vertex[1], vertex[2]);
}

void add_arrow(Geometry& geometry, const Vec3& tip, const Vec3& direction, double length, const Rgba& color) {
  const double shaft = 0.036 * length;
  const double head = 0.11 * length;
  const double neck = -0.34 * length;
  const double slope = std::atan2(head, -neck);
  const double c = std::cos(slope);
  const double s = std::sin(slope);
  const std::vector<ProfilePoint> outline{{0, -length, 0, -1, color},    {shaft, -length, 0, -1, color},
                                          {shaft, -length, 1, 0, color}, {shaft, neck, 1, 0, color},
                                          {shaft, neck, 0, -1, color},   {head, neck, 0, -1, color},
                                          {head, neck, c, s, color},     {0, 0, c, s, color}};
  add_revolution(geometry, {shortest_rotation(Vec3::UnitY(), direction), tip}, outline, 24);
}

}  // namespace ukemi
