// Triangles of one frame, in world space: metres, y up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/character.h"
#include "base/math.h"
#include "body/body.h"

namespace ukemi {

using Rgba = std::array<float, 4>;  // linear, with alpha

/// Colour of an sRGB hex triplet 0xRRGGBB.
Rgba srgb(std::uint32_t hex, float alpha = 1.0f);

struct Vertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  // zero: the face's own
  Eigen::Vector2f uv;
  Rgba color;
};

struct Surface {
  Rgba color{1, 1, 1, 1};
  int texture = -1;
  Material::Alpha alpha = Material::Alpha::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool mirrored = false;  // clockwise fronts
  bool casts_shadow = true;
  bool takes_shadow = true;
  float gloss = 0.12f;
};

struct Piece {
  Surface surface;
  std::uint32_t first = 0;  // index
  std::uint32_t count = 0;
};

/// Contract: pieces follow each other in `indices` and cover it.
struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Piece> pieces;

  /// Starts a piece; what is appended until the next call belongs to it.
  void begin(const Surface& surface);
};

// Each appends to the piece begun last. Colours are per vertex.
void add_capsule(Geometry& geometry, const Rigid& world_from_shape, double radius, double length,
                 const Rgba& color);
void add_ball(Geometry& geometry, const Rigid& world_from_ball, double radius, const Rgba& color,
              const Rgba& band_color);
void add_box(Geometry& geometry, const Rigid& world_from_box, const Vec3& size, const Rgba& color);
/// The bone of animation tools: a stretched octahedron, thickest near `from`.
void add_octahedron(Geometry& geometry, const Vec3& from, const Vec3& to, double radius, const Rgba& color);
/// A thin tube along the points.
void add_tube(Geometry& geometry, const std::vector<Vec3>& points, double radius, const Rgba& color);
/// One triangle with its own normal, seen from both sides where the surface is.
void add_flat_triangle(Geometry& geometry, const std::array<Vec3, 3>& corners, const Rgba& color);
/// Tip at `tip`, pointing along `direction` (unit).
void add_arrow(Geometry& geometry, const Vec3& tip, const Vec3& direction, double length, const Rgba& color);

}  // namespace ukemi
