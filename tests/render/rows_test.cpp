#include "render/rows.h"

#include <gtest/gtest.h>

#include "render/boxy.h"
#include "render/chart.h"

namespace ukemi {
namespace {

int red_pixels(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    count += picture.rgba[i] > 170 && picture.rgba[i + 1] < 50 && picture.rgba[i + 2] < 50;
  return count;
}

struct Runs {
  Character character = boxy_character();
  Clip clip = boxy_fall(character, 30);
  std::vector<MarkedShot> rows;
  RowsOptions options;

  explicit Runs(int count) {
    MarkedShot row;
    row.shot.character = &character;
    row.shot.clip = &clip;
    row.shot.title = "run";
    rows.assign(count, row);
    options.columns = 3;
    options.cell_width = 120;
    options.cell_height = 150;
  }
  Runs(const Runs&) = delete;
  Runs& operator=(const Runs&) = delete;
  Picture draw() const {
    const auto picture = render_rows(rows, options);
    EXPECT_TRUE(picture) << picture.error().message();
    return picture ? *picture : Picture{};
  }
};

TEST(Rows, MarkASpotInRedInEveryFrameThatHasIt) {
  Runs runs(2);
  const Picture plain = runs.draw();
  EXPECT_EQ(red_pixels(plain), 0);
  runs.rows[1].markers.assign(runs.clip.frames.size(), {{Vec3(0.0, 1.0, 0.0), "spot"}});
  const Picture marked = runs.draw();
  EXPECT_GT(red_pixels(marked), 3 * 10);
  runs.options.only = 0;
  EXPECT_EQ(red_pixels(runs.draw()), 0);
  runs.options.only = 1;
  const Picture alone = runs.draw();
  EXPECT_EQ(red_pixels(alone), red_pixels(marked));
  EXPECT_LT(alone.height, marked.height);
}

TEST(Rows, OfDifferentLengthsAreRefused) {
  Runs runs(2);
  const Clip longer = boxy_fall(runs.character, 31);
  runs.rows[1].shot.clip = &longer;
  EXPECT_FALSE(render_rows(runs.rows, runs.options));
  EXPECT_FALSE(render_rows({}, runs.options));
}

TEST(Rows, LeaveARunThatFliesApartOutOfTheCamera) {
  Runs runs(2);
  const Picture calm = runs.draw();
  Clip wild = runs.clip;
  for (LocalTransform& node : wild.frames.back()) node.translation.x() += 1e4;
  runs.rows[1].shot.clip = &wild;
  runs.options.only = 0;
  Runs one(1);
  EXPECT_EQ(runs.draw().rgba, one.draw().rgba);
}

TEST(CloseUp, ShowsTheSpotInThreeViews) {
  Runs runs(1);
  runs.rows[0].markers.assign(runs.clip.frames.size(), {{Vec3(0.0, 1.0, 0.0), "spot"}});
  CloseUpOptions options;
  options.frame = 20;
  options.focus = {0.0, 1.0, 0.0};
  const auto picture = render_close_up(runs.rows[0], options);
  ASSERT_TRUE(picture) << picture.error().message();
  EXPECT_GT(red_pixels(*picture), 300);
}

TEST(Chart, DrawsZerosLeftOfTheScaleAndLongerLinesForLargerValues) {
  Chart chart;
  chart.rows = {"first", "second", "third"};
  chart.strong = {false, false, true};
  chart.panels = {{"quantity", "m", {100.0, 1.0, 0.0}}};
  const auto picture = render_chart(chart);
  ASSERT_TRUE(picture) << picture.error().message();
  // Pixels of the lines' colour, row by row: 34 pixels high each, the last ends 66 above the bottom.
  const auto colored = [&](int row) {
    int count = 0;
    const int top = picture->height - 66 - (3 - row) * 34;
    for (int y = top; y < top + 34; ++y)
      for (int x = 146; x < picture->width; ++x) {
        const std::uint8_t* pixel = &picture->rgba[(static_cast<std::size_t>(y) * picture->width + x) * 4];
        count += pixel[0] < 0xC0;
      }
    return count;
  };
  EXPECT_GT(colored(0), colored(1) + 300);
  EXPECT_GT(colored(1), 50);
}

}  // namespace
}  // namespace ukemi
