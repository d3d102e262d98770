#include "render/moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

/// One point that travels `place(frame)` metres along x; 30 frames per second.
template <typename Place>
std::pair<Clip, std::vector<std::vector<Vec3>>> motion(int frames, Place&& place) {
  Clip clip{"motion", 30.0, std::vector<Pose>(frames), {}};
  std::vector<std::vector<Vec3>> points;
  for (int frame = 0; frame < frames; ++frame) points.push_back({Vec3(place(frame), 0.0, 0.0)});
  return {clip, points};
}

std::vector<int> frames_of(const std::vector<Moment>& moments) {
  std::vector<int> frames;
  for (const Moment& moment : moments) frames.push_back(moment.frame);
  return frames;
}

TEST(Moments, divide_even_motion_evenly) {
  const auto [clip, points] = motion(101, [](int frame) { return 0.1 * frame; });
  EXPECT_EQ(frames_of(choose_moments(clip, points, 5)), (std::vector{0, 25, 50, 75, 100}));
}

TEST(Moments, are_denser_where_the_motion_is_fast) {
  const auto [clip, points] = motion(101, [](int frame) { return frame < 80 ? 0.0 : 0.1 * (frame - 80); });
  int late = 0;
  for (const int frame : frames_of(choose_moments(clip, points, 12))) late += frame >= 79;
  EXPECT_GE(late, 10);
}

TEST(Moments, hold_first_last_and_marked_frames_and_name_them) {
  auto [clip, points] = motion(91, [](int frame) { return 0.01 * frame; });
  clip.marks = {{"start", 0.0}, {"impact", 0.5}, {"first_ground_contact", 1.0}, {"rest", 3.0}};
  const std::vector<Moment> moments = choose_moments(clip, points, 8);
  ASSERT_EQ(moments.size(), 8u);
  EXPECT_EQ(moments.front().phase, "start");
  EXPECT_EQ(moments.back().frame, 90);
  EXPECT_EQ(moments.back().phase, "rest");
  std::vector<std::string> named;
  for (const Moment& moment : moments)
    if (!moment.phase.empty()) named.push_back(moment.phase);
  EXPECT_EQ(named, (std::vector<std::string>{"start", "impact", "first ground contact", "rest"}));
}

TEST(Moments, are_denser_just_after_the_impact) {
  auto [clip, points] = motion(121, [](int frame) { return 0.02 * frame; });
  clip.marks = {{"impact", 2.0}};
  const std::vector<int> frames = frames_of(choose_moments(clip, points, 14));
  const auto impact = std::find(frames.begin(), frames.end(), 60);
  ASSERT_NE(impact, frames.end());
  EXPECT_LT(3 * (impact[1] - impact[0]), 2 * (frames[1] - frames[0]));
}

TEST(Moments, name_a_rest_that_lasts_at_the_last_frame) {
  auto [clip, points] = motion(91, [](int frame) { return 0.02 * std::min(frame, 60); });
  clip.marks = {{"rest", 2.0}};
  EXPECT_EQ(choose_moments(clip, points, 6).back().phase, "at rest since 2.00 s");
  for (const Moment& moment : choose_moments(clip, points, 2)) EXPECT_NE(moment.frame, 60);
  clip.marks = {{"rest", 1.0}};
  EXPECT_EQ(choose_moments(clip, points, 6).back().phase, "") << "it moved on after that";
}

TEST(Moments, name_two_marks_of_one_frame_together) {
  auto [clip, points] = motion(10, [](int frame) { return 0.1 * frame; });
  clip.marks = {{"start", 0.0}, {"impact", 0.0}};
  EXPECT_EQ(choose_moments(clip, points, 4).front().phase, "start, impact");
}

TEST(Moments, prefer_the_impact_when_there_is_no_room) {
  auto [clip, points] = motion(31, [](int frame) { return 0.1 * frame; });
  clip.marks = {{"first_ground_contact", 0.2}, {"impact", 0.5}, {"rest", 0.9}};
  EXPECT_EQ(frames_of(choose_moments(clip, points, 3)), (std::vector{0, 15, 30}));
  EXPECT_EQ(frames_of(choose_moments(clip, points, 1)), (std::vector{0}));
}

TEST(Moments, name_the_fastest_frame) {
  auto [clip, points] =
      motion(91, [](int frame) { return 0.002 * frame + 0.5 / (1.0 + std::exp(-0.6 * (frame - 40))); });
  const std::vector<Moment> moments = choose_moments(clip, points, 8);
  const auto peak = std::find_if(moments.begin(), moments.end(),
                                 [](const Moment& moment) { return moment.phase == "peak speed"; });
  ASSERT_NE(peak, moments.end());
  EXPECT_NEAR(peak->frame, 40, 1);
  clip.marks = {{"first_ground_contact", 41 / 30.0}};
  const std::vector<Moment> again = choose_moments(clip, points, 8);
  EXPECT_TRUE(std::any_of(again.begin(), again.end(), [](const Moment& moment) {
    return moment.frame == 41 && moment.phase == "first ground contact, peak speed";
  }));
}

TEST(Moments, half_of_the_way_is_counted_from_the_impact) {
  auto [clip, points] = motion(101, [](int frame) { return 0.1 * frame; });
  EXPECT_EQ(halfway_frame(clip, points), 50);
  clip.marks = {{"impact", 2.0}};
  EXPECT_EQ(halfway_frame(clip, points), 80);
}

TEST(Moments, of_a_short_clip_are_all_its_frames_once) {
  for (int frames = 1; frames < 14; ++frames) {
    const auto [clip, points] = motion(frames, [](int frame) { return frame == 1 ? 5.0 : 0.0; });
    const std::vector<int> chosen = frames_of(choose_moments(clip, points, 12));
    ASSERT_EQ(chosen.size(), static_cast<std::size_t>(std::min(frames, 12)));
    for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
    EXPECT_EQ(chosen.front(), 0);
    EXPECT_EQ(chosen.back(), frames - 1);
  }
}

TEST(Moments, of_a_figure_at_rest_are_spread_over_the_time) {
  const auto [clip, points] = motion(61, [](int) { return 0.0; });
  EXPECT_EQ(frames_of(choose_moments(clip, points, 4)), (std::vector{0, 20, 40, 60}));
}

}  // namespace
}  // namespace ukemi
