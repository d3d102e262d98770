// What is read from a simulation: how far soles slide, on motions made by hand and on a blow that once
// dragged a foot.
#include "bake/response.h"

#include <gtest/gtest.h>

#include "bake/bake.h"
#include "base/character_path.h"
#include "load/load.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

/// A man whose right foot glides forward over the floor.
double slide_of_a_foot(double way_m) {
  const test::StandingMan man;
  constexpr int kFrames = 60;
  Trajectory trajectory;
  trajectory.fps = 60.0;
  for (int f = 0; f < kFrames; ++f) {
    BodyPose pose = man.segments;
    pose[index(Segment::foot_r)].translation.x() += way_m * f / (kFrames - 1);
    trajectory.frames.push_back(pose);
  }
  return foot_slide(man.body, trajectory, 1.0);
}

TEST(FootSlide, IsHowFarASoleGlidesOnTheFloor) {
  EXPECT_EQ(slide_of_a_foot(0.0), 0.0);
  // From 50 ms after the beginning on.
  EXPECT_NEAR(slide_of_a_foot(0.05), 0.05, 0.005);
  EXPECT_NEAR(slide_of_a_foot(0.10), 0.10, 0.010);
}

TEST(FootSlide, OfAFootWithoutLoadIsSmall) {
  Diagnostics diagnostics;
  const auto mannequin = load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
  ASSERT_TRUE(mannequin);
  BakeSettings settings;
  settings.from = *parse_direction("right");
  settings.scene = SceneKind::impulse;
  settings.ball_mass_kg = 1.0;
  settings.ball_speed_m_s = 25.0;
  const auto baked = bake(*mannequin, settings, diagnostics);
  ASSERT_TRUE(baked);
  const Response response = response_of(*baked);
  EXPECT_EQ(response.outcome, Outcome::stood);
  EXPECT_LT(response.foot_slide_max_m, 0.02);
}

}  // namespace
}  // namespace ukemi
