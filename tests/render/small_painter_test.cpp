// Pictures drawn without OpenGL: every sample once, and about what the painter shows.
#include "render/small_painter.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "render/boxy.h"
#include "render/raster.h"
#include "render/studio.h"

namespace ukemi {
namespace {

TEST(Raster, TrianglesThatShareEdgesCoverEverySampleOnce) {
  constexpr int kSize = 20;
  // A fan about a sample's centre, with corners on centres: edges pass through samples.
  const std::array<Corner, 6> rim = {{{0.5f, 0.5f, 1.0f},
                                      {10.5f, 0.5f, 1.0f},
                                      {18.5f, 4.5f, 1.0f},
                                      {18.5f, 18.5f, 1.0f},
                                      {9.25f, 19.0f, 1.0f},
                                      {0.5f, 18.5f, 1.0f}}};
  const Corner middle{10.5f, 10.5f, 3.0f};
  std::array<int, kSize * kSize> covered{};
  for (std::size_t i = 0; i < rim.size(); ++i)
    for_each_sample({middle, rim[i], rim[(i + 1) % rim.size()]}, kSize, kSize,
                    [&](std::size_t s, const std::array<float, 3>& w, float depth) {
                      ++covered[s];
                      EXPECT_NEAR(w[0] + w[1] + w[2], 1.0f, 1e-5f);
                      EXPECT_NEAR(depth, 1.0f + 2.0f * w[0], 1e-5f);
                    });
  int inside = 0;
  for (int y = 1; y < 18; ++y)
    for (int x = 1; x < 10; ++x, ++inside)
      EXPECT_EQ(covered[static_cast<std::size_t>(y * kSize + x)], 1) << x << " " << y;
  EXPECT_EQ(inside, 153);
  EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1);
}

TEST(Raster, TrianglesBeyondTheGridAreCutOff) {
  int samples = 0;
  for_each_sample({{{-100.0f, -100.0f, 0.0f}, {300.0f, -100.0f, 0.0f}, {-100.0f, 300.0f, 0.0f}}}, 8, 4,
                  [&](std::size_t s, const auto&, float) {
                    EXPECT_LT(s, 32u);
                    ++samples;
                  });
  EXPECT_EQ(samples, 32);
}

/// Mean difference of the channels, of 255.
double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

TEST(SmallPainter, ShowsAboutWhatThePainterShows) {
  const BoxyScene scene;
  const auto studio = open_studio(scene.shot, {}, 200, 150);
  ASSERT_TRUE(studio) << studio.error().message();
  const FrameGeometry geometry = studio->figure.geometry(20);
  Camera camera;
  camera.aspect = 200.0 / 150.0;
  camera.world_from_camera = telling_side(studio->figure, scene.shot, studio->joints);
  Framing framing(camera, {0.1, 0.1, 0.1, 0.1});
  Eigen::AlignedBox3d seen;
  for (const Vertex& vertex : geometry.solid.vertices) {
    framing.add(vertex.position.cast<double>());
    seen.extend(vertex.position.cast<double>());
  }
  StageView stage = stage_about(framing.fit(), seen);
  const SmallPainter painter(200, 150, geometry, stage, {});
  for (const ThemeKind kind : {ThemeKind::light, ThemeKind::dark}) {
    stage.theme = theme(kind);
    const Picture small = painter.in(stage.theme);
    const Picture full = studio->painter->draw(geometry, stage);
    EXPECT_LT(mean_difference(small, full), 4.0);
    EXPECT_LT(differing_pixels(small, full, 60), 200 * 150 / 50) << "shadows on the figure and edges";
  }
}

}  // namespace
}  // namespace ukemi
