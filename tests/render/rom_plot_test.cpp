#include "render/rom_plot.h"

#include <gtest/gtest.h>

#include "render/plot.h"

namespace ukemi {
namespace {

double covered(const Picture& picture) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) sum += picture.rgba[i] / 255.0;
  return sum;
}

int count(const Picture& picture, Color color) {
  int sum = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    if (picture.rgba[i] == color.r && picture.rgba[i + 1] == color.g && picture.rgba[i + 2] == color.b) ++sum;
  return sum;
}
bool holds(const Picture& picture, Color color) { return count(picture, color) > 0; }

JointRange square() {
  JointRange range;
  range.polygon = {{0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}};
  range.twist_min = -0.5;
  range.twist_max = 0.5;
  return range;
}

/// Along a_y to `end` degrees.
RomPath path_to(double end_deg) {
  RomPath path;
  for (int i = 0; i <= 10; ++i) {
    path.charts.push_back({{radians(0.1 * i * end_deg), 0.0}, 0.0});
    path.excess_deg.push_back(std::max(0.0, 0.1 * i * end_deg - degrees(0.5)));
  }
  return path;
}

const Color kRed = hex(0xC23B22);

TEST(Plot, AFilledPolygonCoversItsArea) {
  Picture picture = blank(100, 100, hex(0));
  fill_polygon(picture, {{10.5, 10}, {90, 20.25}, {40, 95}}, hex(0xFFFFFF));
  EXPECT_NEAR(covered(picture), 0.5 * std::abs(79.5 * 85.0 - 29.5 * 10.25), 6.0);
}

TEST(Plot, ALineCoversItsLengthTimesItsWidth) {
  Picture picture = blank(200, 100, hex(0));
  draw_line(picture, {20, 20}, {180, 80}, 4.0, hex(0xFFFFFF));
  EXPECT_NEAR(covered(picture), std::hypot(160.0, 60.0) * 4.0 + 3.14159 * 4.0, 6.0);
}

TEST(Plot, TicksAreRoundAndFewEnough) {
  EXPECT_DOUBLE_EQ(tick_step(100.0, 10), 10.0);
  EXPECT_DOUBLE_EQ(tick_step(101.0, 10), 20.0);
  EXPECT_DOUBLE_EQ(tick_step(0.3, 4), 0.1);
  EXPECT_EQ(ticks(-25.0, 31.0, 10.0), (std::vector<double>{-20, -10, 0, 10, 20, 30}));
}

TEST(RomPlot, OnlyAPathThatLeavesItsRangeIsDrawnInRed) {
  const JointRange range = square();
  const RomPath inside = path_to(20.0), outside = path_to(60.0);
  RomFigure figure{"a joint", {"a note"}, {{"joint", {}, &range, &inside, {}}}};
  figure.panels.push_back({"empty place", {}, nullptr, nullptr, {}});
  const auto calm = draw_rom_overview(figure, 2);
  ASSERT_TRUE(calm) << calm.error().message();
  figure.panels.front().path = &outside;
  const auto far = draw_rom_overview(figure, 2);
  ASSERT_TRUE(far);
  EXPECT_EQ(calm->width, far->width);
  EXPECT_GT(count(*far, kRed), count(*calm, kRed) + 20) << "the calm one has the legend's dot";
  figure.panels.resize(1);
  const auto large = draw_rom_joint(figure);
  ASSERT_TRUE(large);
  EXPECT_TRUE(holds(*large, kRed));
}

TEST(RomPlot, AStateIsDrawnWithItsChords) {
  const JointRange range = square();
  RomFigure figure{"a joint", {}, {{"joint", {}, &range, nullptr, {}}}};
  const auto plain = draw_rom_joint(figure);
  ASSERT_TRUE(plain);
  EXPECT_FALSE(holds(*plain, kRed));
  const SwingTwist state{{0.1, -0.2}, 0.0};
  figure.panels.front().state = RomPanel::State{state.swing, {{-0.5, 0.5}, {-0.5, 0.5}}};
  const auto drawn = draw_rom_joint(figure);
  ASSERT_TRUE(drawn);
  EXPECT_TRUE(holds(*drawn, kRed));
}

}  // namespace
}  // namespace ukemi
