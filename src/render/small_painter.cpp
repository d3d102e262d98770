#include "render/small_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "render/lighting.h"
#include "render/raster.h"

namespace ukemi {
namespace {

using Vec3f = Eigen::Vector3f;

constexpr int kGrain = 2;  // samples a pixel each way
constexpr int kFloorMapSize = 96;
constexpr float kFarthest = 1e30f;
constexpr float kNearest = 1e-3f;  // m in front of the eye

// The painter's lights (shaders.h).
const Vec3f kKey = Vec3f(1.00f, 0.95f, 0.87f) * 0.92f;
const Vec3f kSky = Vec3f(0.86f, 0.92f, 1.00f) * 0.54f;
const Vec3f kGround = Vec3f(1.00f, 0.93f, 0.85f) * 0.27f;
const Vec3f kRim = Vec3f(0.92f, 0.96f, 1.00f) * 0.35f;

float smoothstep(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// A soft shoulder above 0.7, so that bright cloth keeps its folds.
Vec3f softened(const Vec3f& color) {
  Vec3f result = color.cwiseMin(0.7f);
  for (int i = 0; i < 3; ++i)
    if (color[i] > 0.7f) result[i] += 0.3f * (1.0f - std::exp(-(color[i] - 0.7f) / 0.3f));
  return result;
}

struct Lights {
  Vec3f eye, to_key, to_rim;

  explicit Lights(const Camera& camera)
      : eye(camera.eye.cast<float>()),
        to_key(towards(camera, kKeyAzimuth, kKeyElevation).cast<float>()),
        to_rim(towards(camera, kRimAzimuth, kRimElevation).cast<float>()) {}
};

/// What falls on a point: times its colour, and what it reflects.
struct Lit {
  Vec3f light, highlight;
};

Lit lit(const Lights& lights, const Vec3f& point, const Vec3f& normal, float gloss) {
  const Vec3f v = (lights.eye - point).normalized();
  const float wrapped = std::max((normal.dot(lights.to_key) + 0.15f) / 1.15f, 0.0f);
  const float up = 0.5f + 0.5f * normal.y();
  Lit result{(1.0f - up) * kGround + up * kSky + wrapped * kKey, Vec3f::Zero()};
  const float away = 1.0f - std::max(normal.dot(v), 0.0f);
  result.light += away * away * away * std::max(normal.dot(lights.to_rim) + 0.2f, 0.0f) * kRim;
  const float mirror = std::max(normal.dot((v + lights.to_key).normalized()), 0.0f);
  const float m4 = mirror * mirror * mirror * mirror;
  const float m32 = m4 * m4 * m4 * m4 * m4 * m4 * m4 * m4;
  result.highlight = m32 * m4 * gloss * kKey;
  return result;
}

/// A texture's colour at a place that repeats, linear.
struct Texel {
  Vec3f color = Vec3f::Ones();
  float alpha = 1.0f;
};

const std::array<float, 256>& linear_values() {
  static const std::array<float, 256> values = [] {
    std::array<float, 256> made{};
    for (std::uint32_t i = 0; i < 256; ++i) made[i] = srgb(i)[2];
    return made;
  }();
  return values;
}

Texel texel(const Picture& picture, const Eigen::Vector2f& uv) {
  const auto place = [](float u, int size) {
    const int i = static_cast<int>((u - std::floor(u)) * static_cast<float>(size));
    return static_cast<std::size_t>(std::clamp(i, 0, size - 1));
  };
  const std::size_t at = 4 * (place(uv.y(), picture.height) * static_cast<std::size_t>(picture.width) +
                              place(uv.x(), picture.width));
  const auto& linear = linear_values();
  const auto& rgba = picture.rgba;
  return {Vec3f(linear[rgba[at]], linear[rgba[at + 1]], linear[rgba[at + 2]]),
          static_cast<float>(rgba[at + 3]) / 255.0f};
}

struct Sample {
  Vec3f color = Vec3f::Zero();
  float through = 1.0f;
};

/// A vertex as the grid and the lights see it.
struct Seen {
  Corner corner;
  bool in_front = false;
  Vec3f color = Vec3f::Zero();      // without texture: all of it; else the light times its colour
  Vec3f highlight = Vec3f::Zero();  // with texture
  float alpha = 1.0f;
};

/// The grid of samples that the pieces of a frame are drawn on, one after another.
class Grid {
 public:
  Grid(int width, int height, const StageView& stage, const std::vector<Picture>& textures)
      : width_(kGrain * width),
        height_(kGrain * height),
        clip_from_world_(stage.camera.clip_from_world()),
        lights_(stage.camera),
        textures_(textures),
        samples_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
        depth_(samples_.size(), kFarthest) {}

  void draw(const Geometry& geometry) {
    for (const Piece& piece : geometry.pieces) draw_piece(geometry, piece, false);
  }

  /// Draws a transparent piece: its front faces only.
  void draw_front(const Geometry& geometry) {
    if (geometry.indices.empty()) return;
    std::vector<std::optional<Corner>> corners;
    corners.reserve(geometry.vertices.size());
    for (const Vertex& vertex : geometry.vertices) corners.push_back(corner_of(vertex.position));
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
      const auto *a = &corners[geometry.indices[i]], *b = &corners[geometry.indices[i + 1]],
                 *c = &corners[geometry.indices[i + 2]];
      if (*a && *b && *c)
        for_each_sample({**a, **b, **c}, width_, height_, [&](std::size_t s, const auto&, float depth) {
          depth_[s] = std::min(depth_[s], depth);
        });
    }
    for (const Piece& piece : geometry.pieces) draw_piece(geometry, piece, true);
  }

  void forget_depth() { std::fill(depth_.begin(), depth_.end(), kFarthest); }
  const Sample& at(int x, int y) const {
    return samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }

 private:
  std::optional<Corner> corner_of(const Vec3f& position) const {
    const Eigen::Vector4f clip = clip_from_world_ * position.homogeneous();
    if (!(clip.w() > kNearest)) return std::nullopt;
    const float inverse = 1.0f / clip.w();
    return Corner{(0.5f + 0.5f * clip.x() * inverse) * static_cast<float>(width_),
                  (0.5f - 0.5f * clip.y() * inverse) * static_cast<float>(height_), clip.z() * inverse};
  }

  const Picture* texture_of(const Surface& surface) const {
    if (surface.texture < 0 || surface.texture >= static_cast<int>(textures_.size())) return nullptr;
    const Picture& picture = textures_[static_cast<std::size_t>(surface.texture)];
    return picture.rgba.empty() ? nullptr : &picture;
  }

  void shade(const Vertex& vertex, const Vec3f& normal, const Surface& surface, Seen& seen) const {
    const Lit light = lit(lights_, vertex.position, normal, surface.gloss);
    Vec3f own;
    for (int i = 0; i < 3; ++i)
      own[i] = surface.color[static_cast<std::size_t>(i)] * vertex.color[static_cast<std::size_t>(i)];
    seen.alpha = surface.color[3] * vertex.color[3];
    seen.color = own.cwiseProduct(light.light);
    if (texture_of(surface) != nullptr)
      seen.highlight = light.highlight;
    else
      seen.color = softened(seen.color + light.highlight);
  }

  /// The piece's vertices, those with normals lit from the front.
  const std::vector<Seen>& seen_of(const Geometry& geometry, const Piece& piece) {
    const auto first = geometry.indices.begin() + piece.first;
    const auto [low, high] = std::minmax_element(first, first + piece.count);
    lowest_ = *low;
    seen_.assign(*high - *low + 1, {});
    for (std::uint32_t i = *low; i <= *high; ++i) {
      const Vertex& vertex = geometry.vertices[i];
      Seen& seen = seen_[i - lowest_];
      const auto corner = corner_of(vertex.position);
      seen.in_front = corner.has_value();
      if (!corner) continue;
      seen.corner = *corner;
      if (vertex.normal.squaredNorm() > 0.0f) shade(vertex, vertex.normal.normalized(), piece.surface, seen);
    }
    return seen_;
  }

  /// Whether the triangle is seen from its front: counter-clockwise, y down.
  static bool is_front(const Corner& a, const Corner& b, const Corner& c, bool mirrored) {
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return (area < 0.0f) != mirrored;
  }

  void draw_piece(const Geometry& geometry, const Piece& piece, bool front_only) {
    if (piece.count < 3) return;
    const std::vector<Seen>& seen = seen_of(geometry, piece);
    for (std::uint32_t i = piece.first; i + 2 < piece.first + piece.count; i += 3) {
      const std::uint32_t* index = geometry.indices.data() + i;
      const Seen &a = seen[index[0] - lowest_], &b = seen[index[1] - lowest_], &c = seen[index[2] - lowest_];
      if (!a.in_front || !b.in_front || !c.in_front) continue;
      const bool front = is_front(a.corner, b.corner, c.corner, piece.surface.mirrored);
      if (!front && !piece.surface.double_sided) continue;
      const std::array vertices = {&geometry.vertices[index[0]], &geometry.vertices[index[1]],
                                   &geometry.vertices[index[2]]};
      std::array triangle = {a, b, c};
      light_flat_or_back(vertices, piece.surface, front, triangle);
      draw_triangle(triangle, vertices, piece.surface, front_only);
    }
  }

  /// Vertices without normals take the face's; seen from behind, normals are turned round.
  void light_flat_or_back(const std::array<const Vertex*, 3>& vertices, const Surface& surface, bool front,
                          std::array<Seen, 3>& triangle) const {
    const auto smooth = [&](std::size_t k) { return vertices[k]->normal.squaredNorm() > 0.0f; };
    if (front && smooth(0) && smooth(1) && smooth(2)) return;
    const Vec3f face = (vertices[1]->position - vertices[0]->position)
                           .cross(vertices[2]->position - vertices[0]->position)
                           .normalized();
    const bool towards_eye = face.dot(lights_.eye - vertices[0]->position) > 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      if (smooth(k) && front) continue;
      const Vec3f normal = smooth(k)     ? Vec3f(-vertices[k]->normal.normalized())
                           : towards_eye ? face
                                         : Vec3f(-face);
      shade(*vertices[k], normal, surface, triangle[k]);
    }
  }

  void draw_triangle(const std::array<Seen, 3>& t, const std::array<const Vertex*, 3>& vertices,
                     const Surface& surface, bool front_only) {
    const Picture* texture = texture_of(surface);
    const bool blends = surface.alpha == Material::Alpha::blend;
    for_each_sample({t[0].corner, t[1].corner, t[2].corner}, width_, height_,
                    [&](std::size_t s, const std::array<float, 3>& w, float depth) {
                      if (front_only ? depth > depth_[s] : depth >= depth_[s]) return;
                      Vec3f color = w[0] * t[0].color + w[1] * t[1].color + w[2] * t[2].color;
                      float alpha = w[0] * t[0].alpha + w[1] * t[1].alpha + w[2] * t[2].alpha;
                      if (texture != nullptr) {
                        const Texel own = texel(*texture, w[0] * vertices[0]->uv + w[1] * vertices[1]->uv +
                                                              w[2] * vertices[2]->uv);
                        alpha *= own.alpha;
                        color = softened(color.cwiseProduct(own.color) + w[0] * t[0].highlight +
                                         w[1] * t[1].highlight + w[2] * t[2].highlight);
                      }
                      if (surface.alpha == Material::Alpha::mask && alpha < surface.alpha_cutoff) return;
                      if (!blends) alpha = 1.0f;
                      samples_[s].color = (1.0f - alpha) * samples_[s].color + alpha * color;
                      samples_[s].through *= 1.0f - alpha;
                      if (!blends) depth_[s] = depth;
                    });
  }

  int width_, height_;
  Eigen::Matrix4f clip_from_world_;
  Lights lights_;
  const std::vector<Picture>& textures_;
  std::vector<Sample> samples_;
  std::vector<float> depth_;
  std::vector<Seen> seen_;    // of the piece that is being drawn
  std::uint32_t lowest_ = 0;  // its first vertex
};

/// The figure pressed flat onto the floor.
class FloorShadow {
 public:
  FloorShadow(const Geometry& geometry, const StageView& stage) {
    const Vec3 to_key = towards(stage.camera, kKeyAzimuth, kKeyElevation);
    area_ = floor_area(shadow_bounds(geometry, stage.focus), stage.floor_y, to_key).cast<float>();
    press(geometry, static_cast<float>(stage.floor_y), (to_key / to_key.y()).cast<float>(), 3.0f, key_);
    press(geometry, static_cast<float>(stage.floor_y), Vec3f::UnitY(), static_cast<float>(kContactReach_m),
          contact_);
    const double pixels_per_metre = kFloorMapSize / (2.0 * static_cast<double>(area_.z()));
    blur(key_, kFloorMapSize, kPenumbra_m * pixels_per_metre);
    blur(contact_, kFloorMapSize, kContactBlur_m * pixels_per_metre);
  }

  /// How bright the floor is at (x, z).
  float bright(float x, float z) const {
    const float scale = 0.5f * kFloorMapSize / area_.z();
    const float u = (x - area_.x()) * scale + 0.5f * kFloorMapSize - 0.5f;
    const float v = (z - area_.y()) * scale + 0.5f * kFloorMapSize - 0.5f;
    if (!(u > 0.0f && v > 0.0f && u < kFloorMapSize - 1 && v < kFloorMapSize - 1)) return 1.0f;
    return (1.0f - 0.40f * between(key_, u, v)) * (1.0f - 0.55f * between(contact_, u, v));
  }

 private:
  using Map = std::vector<float>;

  static float between(const Map& map, float u, float v) {
    const auto x = static_cast<std::size_t>(u), y = static_cast<std::size_t>(v);
    const float s = u - static_cast<float>(x), t = v - static_cast<float>(y);
    const float* row = map.data() + y * kFloorMapSize + x;
    return (1.0f - t) * ((1.0f - s) * row[0] + s * row[1]) +
           t * ((1.0f - s) * row[kFloorMapSize] + s * row[kFloorMapSize + 1]);
  }

  /// Along `light`, fading with the height over `reach`.
  void press(const Geometry& geometry, float floor_y, const Vec3f& light, float reach, Map& map) const {
    const float scale = 0.5f * kFloorMapSize / area_.z();
    std::vector<Corner> corners;
    corners.reserve(geometry.vertices.size());
    for (const Vertex& vertex : geometry.vertices) {
      const float height = vertex.position.y() - floor_y;
      const float x = vertex.position.x() - light.x() * height - area_.x();
      const float z = vertex.position.z() - light.z() * height - area_.y();
      corners.push_back({x * scale + 0.5f * kFloorMapSize, z * scale + 0.5f * kFloorMapSize,
                         std::exp(-std::max(height, 0.0f) / reach)});
    }
    for (const Piece& piece : geometry.pieces) {
      if (!piece.surface.casts_shadow) continue;
      const auto* index = geometry.indices.data() + piece.first;
      for (std::uint32_t i = 0; i + 2 < piece.count; i += 3)
        for_each_sample({corners[index[i]], corners[index[i + 1]], corners[index[i + 2]]}, kFloorMapSize,
                        kFloorMapSize,
                        [&map](std::size_t s, const auto&, float dark) { map[s] = std::max(map[s], dark); });
    }
  }

  Vec3f area_;  // see floor_area
  Map key_ = Map(static_cast<std::size_t>(kFloorMapSize) * kFloorMapSize);
  Map contact_ = key_;
};

/// How much of a line `width_px` wide at whole multiples covers the place; `pixel`: how far it is to the next
/// pixel.
float line_cover(float place, float pixel, float width_px) {
  const float away = std::abs(place - std::round(place)) / pixel;
  return std::clamp(0.5f * width_px + 0.5f - away, 0.0f, 1.0f) * (1.0f - smoothstep(0.08f, 0.3f, pixel));
}

float grid_cover(const Eigen::Vector2f& place, const Eigen::Vector2f& pixel, float step_m, float width_px) {
  return std::max(line_cover(place.x() / step_m, pixel.x() / step_m, width_px),
                  line_cover(place.y() / step_m, pixel.y() / step_m, width_px));
}

/// sRGB of a linear value.
std::uint8_t encoded(float value) {
  constexpr int kSteps = 4096;
  static const std::array<std::uint8_t, kSteps + 1> table = [] {
    std::array<std::uint8_t, kSteps + 1> made{};
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const double v = static_cast<double>(i) / kSteps;
      const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
      made[i] = static_cast<std::uint8_t>(std::lround(255.0 * s));
    }
    return made;
  }();
  return table[static_cast<std::size_t>(std::clamp(value, 0.0f, 1.0f) * kSteps + 0.5f)];
}

Vec3f rgb(const Rgba& color) { return {color[0], color[1], color[2]}; }

}  // namespace

SmallPainter::SmallPainter(int width, int height, const FrameGeometry& frame, const StageView& stage,
                           const std::vector<Picture>& textures)
    : width_(width), height_(height) {
  draw_figure(frame, stage, textures);
  draw_floor(frame, stage);
}

void SmallPainter::draw_figure(const FrameGeometry& frame, const StageView& stage,
                               const std::vector<Picture>& textures) {
  Grid grid(width_, height_, stage, textures);
  grid.draw(frame.solid);
  grid.draw_front(frame.ghost);
  grid.forget_depth();
  grid.draw_front(frame.overlay);
  constexpr float kShare = 1.0f / (kGrain * kGrain);
  figure_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      Figure pixel{Eigen::Vector3f::Zero(), 0.0f};
      for (int k = 0; k < kGrain * kGrain; ++k) {
        const Sample& sample = grid.at(kGrain * x + k % kGrain, kGrain * y + k / kGrain);
        pixel.color += kShare * sample.color;
        pixel.through += kShare * sample.through;
      }
      figure_.push_back(pixel);
    }
}

void SmallPainter::draw_floor(const FrameGeometry& frame, const StageView& stage) {
  const FloorShadow shadow(frame.solid, stage);
  const Camera& camera = stage.camera;
  const double slope = std::tan(0.5 * camera.vertical_fov);
  const Mat3 turn = camera.world_from_camera.toRotationMatrix();
  const Vec3f right = (turn.col(0) * (2.0 * slope * camera.aspect / width_)).cast<float>();
  const Vec3f down = (turn.col(1) * (-2.0 * slope / height_)).cast<float>();
  const Vec3f corner = (-turn.col(2)).cast<float>() - (0.5f * static_cast<float>(width_) - 0.5f) * right -
                       (0.5f * static_cast<float>(height_) - 0.5f) * down;
  const auto fall = static_cast<float>(stage.floor_y - camera.eye.y());
  const Eigen::Vector2f eye(static_cast<float>(camera.eye.x()), static_cast<float>(camera.eye.z()));
  const Eigen::Vector2f focus(static_cast<float>(stage.focus.x()), static_cast<float>(stage.focus.z()));
  floor_.assign(figure_.size(), {});
  for (std::size_t i = 0; i < floor_.size(); ++i) {
    if (figure_[i].through <= 0.0f) continue;
    const Vec3f ray = corner + static_cast<float>(i % static_cast<std::size_t>(width_)) * right +
                      static_cast<float>(i / static_cast<std::size_t>(width_)) * down;
    const float t = fall / ray.y();
    if (!(t > 0.0f)) continue;
    const Eigen::Vector2f along(ray.x(), ray.z());
    const Eigen::Vector2f place = eye + t * along;
    const float away = (place - focus).norm() / static_cast<float>(stage.reach);
    Floor& floor = floor_[i];
    floor.bright = shadow.bright(place.x(), place.y());
    floor.ground = 1.0f - smoothstep(0.5f, 2.6f, away);
    if (floor.ground <= 0.0f) continue;
    // How the place moves from pixel to pixel.
    const auto moved = [&](const Vec3f& step) {
      return Eigen::Vector2f(t * (Eigen::Vector2f(step.x(), step.z()) - step.y() / ray.y() * along));
    };
    const Eigen::Vector2f pixel = moved(right).cwiseAbs() + moved(down).cwiseAbs();
    floor.line = floor.ground * std::max(0.8f * grid_cover(place, pixel, 1.0f, 1.3f),
                                         0.30f * grid_cover(place, pixel, 0.25f, 1.0f));
  }
}

Picture SmallPainter::in(const Theme& theme) const {
  const Vec3f background = rgb(theme.background), ground = rgb(theme.ground), line = rgb(theme.line);
  Picture picture{width_, height_, std::vector<std::uint8_t>(4 * figure_.size(), 255)};
  for (std::size_t i = 0; i < figure_.size(); ++i) {
    const Floor& floor = floor_[i];
    Vec3f color = background + floor.ground * (ground - background);
    color += theme.line[3] * floor.line * (line - color);
    color = figure_[i].color + figure_[i].through * floor.bright * color;
    for (int k = 0; k < 3; ++k) picture.rgba[4 * i + static_cast<std::size_t>(k)] = encoded(color[k]);
  }
  return picture;
}

}  // namespace ukemi
