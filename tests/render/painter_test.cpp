#include "render/painter.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

constexpr int kSide = 200;

struct Pixel {
  int r, g, b;
};

Pixel pixel(const Picture& picture, int x, int y) {
  const std::uint8_t* p = picture.rgba.data() + (static_cast<std::size_t>(y) * picture.width + x) * 4;
  return {p[0], p[1], p[2]};
}

bool reddish(const Pixel& p) { return p.r > p.g + 60 && p.r > p.b + 60; }
bool greenish(const Pixel& p) { return p.g > p.r + 60 && p.g > p.b + 60; }

/// Looks along -z at the plane z = 0, which fills the picture from -1 to 1; the floor is far below.
StageView front_stage() {
  StageView stage;
  stage.camera.eye = {0.0, 0.0, 1.0 / std::tan(0.5 * stage.camera.vertical_fov)};
  stage.floor_y = -50.0;
  return stage;
}

/// Right-angled, counterclockwise: (-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5) at depth z.
void add_triangle(Geometry& geometry, const Surface& surface, float z) {
  geometry.begin(surface);
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  const float x[] = {-0.5f, 0.5f, -0.5f};
  const float y[] = {-0.5f, -0.5f, 0.5f};
  for (int i = 0; i < 3; ++i)
    geometry.vertices.push_back({{x[i], y[i], z}, {0, 0, 1}, {x[i] + 0.5f, 0.5f - y[i]}, {1, 1, 1, 1}});
  geometry.indices.insert(geometry.indices.end(), {first, first + 1, first + 2});
  geometry.pieces.back().count = 3;
}

Surface painted(const Rgba& color) {
  Surface surface;
  surface.color = color;
  surface.gloss = 0.0f;
  return surface;
}

Picture draw(const FrameGeometry& frame, const std::vector<Picture>& textures = {}) {
  auto painter = Painter::make(kSide, kSide, textures);
  EXPECT_TRUE(painter);
  return (*painter)->draw(frame, front_stage());
}

TEST(Painter, puts_a_known_triangle_on_its_pixels) {
  FrameGeometry frame;
  add_triangle(frame.solid, painted({0.8f, 0.02f, 0.02f, 1.0f}), 0.0f);
  const Picture picture = draw(frame);
  // The corners are at pixels (50, 150), (150, 150) and (50, 50).
  EXPECT_TRUE(reddish(pixel(picture, 52, 147)));
  EXPECT_TRUE(reddish(pixel(picture, 144, 148)));
  EXPECT_TRUE(reddish(pixel(picture, 51, 56)));
  EXPECT_TRUE(reddish(pixel(picture, 98, 100)));
  EXPECT_FALSE(reddish(pixel(picture, 102, 100))) << "right of the slanted edge";
  EXPECT_FALSE(reddish(pixel(picture, 48, 147)));
  EXPECT_FALSE(reddish(pixel(picture, 52, 152)));
  int area = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) area += reddish(pixel(picture, x, y));
  EXPECT_NEAR(area, 5000, 100);
}

TEST(Painter, smooths_edges) {
  FrameGeometry frame;
  add_triangle(frame.solid, painted({0.8f, 0.02f, 0.02f, 1.0f}), 0.0f);
  const Picture picture = draw(frame);
  const int inside = pixel(picture, 60, 120).g;
  const int outside = pixel(picture, 140, 60).g;
  int between = 0;
  for (int x = 0; x < kSide; ++x) {
    const int g = pixel(picture, x, x).g;
    between += g > inside + 20 && g < outside - 20;
  }
  EXPECT_GT(between, 50) << "the slanted edge runs through half pixels";
}

TEST(Painter, hides_what_lies_behind) {
  FrameGeometry frame;
  add_triangle(frame.solid, painted({0.02f, 0.6f, 0.02f, 1.0f}), 0.1f);
  add_triangle(frame.solid, painted({0.8f, 0.02f, 0.02f, 1.0f}), 0.0f);
  EXPECT_TRUE(greenish(pixel(draw(frame), 70, 130)));
}

TEST(Painter, leaves_out_backs_unless_double_sided) {
  FrameGeometry frame;
  Surface surface = painted({0.8f, 0.02f, 0.02f, 1.0f});
  surface.mirrored = true;
  add_triangle(frame.solid, surface, 0.0f);
  EXPECT_FALSE(reddish(pixel(draw(frame), 70, 130)));
  frame.solid.pieces[0].surface.double_sided = true;
  EXPECT_TRUE(reddish(pixel(draw(frame), 70, 130)));
}

TEST(Painter, shows_the_texture_upright_and_cuts_out_its_holes) {
  // Upper row: red, transparent; lower row: green, green.
  const Picture texture{2, 2, {230, 10, 10, 255, 230, 10, 10, 0, 10, 200, 10, 255, 10, 200, 10, 255}};
  FrameGeometry frame;
  Surface surface = painted({1, 1, 1, 1});
  surface.texture = 0;
  surface.alpha = Material::Alpha::mask;
  add_triangle(frame.solid, surface, 0.0f);
  const Picture picture = draw(frame, {texture});
  EXPECT_TRUE(reddish(pixel(picture, 62, 75)));
  EXPECT_TRUE(greenish(pixel(picture, 80, 125)));
  for (Vertex& vertex : frame.solid.vertices) vertex.uv = {0.75f, 0.25f};
  EXPECT_FALSE(reddish(pixel(draw(frame, {texture}), 62, 120)));
}

TEST(Painter, blends_the_overlay_over_everything) {
  FrameGeometry frame;
  add_triangle(frame.solid, painted({0.8f, 0.02f, 0.02f, 1.0f}), 0.5f);
  Surface surface = painted({0.02f, 0.6f, 0.02f, 0.5f});
  surface.alpha = Material::Alpha::blend;
  add_triangle(frame.overlay, surface, 0.0f);
  const Pixel mixed = pixel(draw(frame), 70, 130);
  EXPECT_GT(mixed.r, 100);
  EXPECT_GT(mixed.g, 80);
}

TEST(Painter, darkens_the_floor_under_a_ball) {
  FrameGeometry frame;
  StageView stage;
  stage.camera.world_from_camera = look(0.0, radians(40.0));
  stage.camera.eye = stage.camera.world_from_camera * Vec3(0.0, 0.0, 4.0);
  auto painter = Painter::make(kSide, kSide, {});
  ASSERT_TRUE(painter);
  const Picture empty = (*painter)->draw(frame, stage);
  frame.solid.begin({});
  add_ball(frame.solid, {Quat::Identity(), {0.0, 0.2, 0.0}}, 0.2, {1, 1, 1, 1}, {1, 1, 1, 1});
  const Picture shaded = (*painter)->draw(frame, stage);
  const auto brightness = [&](const Picture& picture, const Vec3& world) {
    const Vec3 p = stage.camera.project(world);
    return pixel(picture, static_cast<int>((0.5 + 0.5 * p.x()) * kSide),
                 static_cast<int>((0.5 - 0.5 * p.y()) * kSide))
        .g;
  };
  // The key light stands to the left of the camera: the shadow falls to the right and back.
  const Vec3 in_shadow(0.27, 0.0, -0.05);
  const Vec3 in_light(-0.45, 0.0, 0.1);
  EXPECT_LT(brightness(shaded, in_shadow), brightness(empty, in_shadow) - 15);
  EXPECT_NEAR(brightness(shaded, in_light), brightness(empty, in_light), 2);
}

TEST(Painter, refuses_cells_beyond_the_context) {
  const auto painter = Painter::make(100000, 10, {});
  ASSERT_FALSE(painter);
  EXPECT_EQ(painter.error().kind, ErrorKind::output);
}

}  // namespace
}  // namespace ukemi
