#include "render/moving.h"

#include <gtest/gtest.h>

#include "render/boxy.h"

namespace ukemi {
namespace {

std::vector<Picture> frames_of(const Shot& shot, const MovingOptions& options) {
  std::vector<Picture> frames;
  const Status drawn = render_moving(shot, options, [&](const Picture& picture) {
    frames.push_back(picture);
    return Status(Done{});
  });
  EXPECT_TRUE(drawn) << drawn.error().message();
  return frames;
}

TEST(Moving, has_a_picture_for_every_step_of_its_own_rate) {
  const BoxyScene scene;  // 46 frames at 30 a second: 1.5 s
  EXPECT_EQ(frames_of(scene.shot, {.width = 64, .height = 64, .fps = 30.0}).size(), 46u);
  EXPECT_EQ(frames_of(scene.shot, {.width = 64, .height = 64, .fps = 10.0}).size(), 16u);
  EXPECT_EQ(frames_of(scene.shot, {.width = 64, .height = 64, .fps = 10.0, .speed = 0.5}).size(), 31u);
}

TEST(Moving, shows_the_motion) {
  const BoxyScene scene;
  const std::vector<Picture> frames = frames_of(scene.shot, {.width = 96, .height = 64, .fps = 10.0});
  ASSERT_EQ(frames.front().width, 96);
  ASSERT_EQ(frames.front().height, 64);
  EXPECT_GT(differing_pixels(frames.front(), frames.back(), 40), 300);
}

TEST(Moving, turntable_goes_once_round) {
  BoxyScene scene;
  scene.clip.frames.resize(1);
  scene.shot.impact_direction.setZero();
  const std::vector<Picture> frames =
      frames_of(scene.shot, {.width = 64, .height = 64, .fps = 8.0, .turn_s = 1.0});
  ASSERT_EQ(frames.size(), 8u);
  EXPECT_GT(differing_pixels(frames[0], frames[2], 40), 50);
  EXPECT_LT(differing_pixels(frames[0], frames[4], 40), differing_pixels(frames[0], frames[2], 40))
      << "the figure is much the same from behind";
}

TEST(Moving, ends_where_a_picture_is_not_taken) {
  const BoxyScene scene;
  int taken = 0;
  const Status drawn = render_moving(scene.shot, {.width = 64, .height = 64}, [&](const Picture&) -> Status {
    if (++taken < 3) return Done{};
    return Error{ErrorKind::output, "", 0, 0, "", "full", ""};
  });
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().what, "full");
  EXPECT_EQ(taken, 3);
}

TEST(Moving, of_a_single_frame_needs_a_turn) {
  BoxyScene scene;
  scene.clip.frames.resize(1);
  const auto webp = render_webp(scene.shot, {});
  ASSERT_FALSE(webp);
  EXPECT_EQ(webp.error().kind, ErrorKind::usage);
  EXPECT_NE(webp.error().fix.find("--turntable"), std::string::npos);
}

TEST(Moving, refuses_sizes_and_rates_that_cannot_be) {
  const BoxyScene scene;
  for (const MovingOptions& options :
       {MovingOptions{.width = 10}, MovingOptions{.height = 5000}, MovingOptions{.fps = 0.0},
        MovingOptions{.speed = -1.0}, MovingOptions{.fps = 60.0, .speed = 1e-4}})
    EXPECT_FALSE(render_webp(scene.shot, options));
}

}  // namespace
}  // namespace ukemi
