// What is read from a simulation: how far soles slide, on motions made by hand and on a blow that once
// dragged a foot.
#include "bake/response.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bake/bake.h"
#include "bake/other_man.h"
#include "base/character_path.h"
#include "feet/legs.h"
#include "load/load.h"
#include "simulate/standing_man.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

constexpr int kFrames = 60;

/// A man whose right foot is moved: every frame's place and turn of it, from where it stands.
struct Glide {
  double way_m = 0.0;     // forward, at a steady speed
  double up_m = 0.0;      // of the whole foot
  double tilt_deg = 0.0;  // about the toe's edge: the heel comes up, and the edge stays as high as it is
  int begin = 0, end = kFrames - 1;
};

double slide_of_a_foot(const Glide& glide, const std::vector<StepTaken>& steps = {}) {
  const test::StandingMan man;
  const Leg leg(man.body, man.segments, BodySide::right);
  const Quat tilt = exp_rotation(Vec3(0.0, 0.0, -radians(glide.tilt_deg)));
  const auto lowest = [&](const Rigid& foot) {
    double y = 1e9;
    for (const Vec3& corner : leg.sole) y = std::min(y, (foot * corner).y());
    return y;
  };
  Trajectory trajectory;
  trajectory.fps = 60.0;
  for (int f = 0; f < kFrames; ++f) {
    BodyPose pose = man.segments;
    Rigid& foot = pose[index(Segment::foot_r)];
    const double level = lowest(foot);
    foot.rotation = tilt * foot.rotation;
    foot.translation.y() += level - lowest(foot) + glide.up_m;
    const int gone = std::clamp(f - glide.begin, 0, glide.end - glide.begin);
    foot.translation.x() += glide.way_m * gone / (glide.end - glide.begin);
    trajectory.frames.push_back(pose);
  }
  return foot_slide(man.body, man.segments, trajectory, steps, 1.0);
}

TEST(FootSlide, IsHowFarASoleGlidesOnTheFloor) {
  EXPECT_EQ(slide_of_a_foot({}), 0.0);
  // From 50 ms after the beginning on.
  EXPECT_NEAR(slide_of_a_foot({.way_m = 0.05}), 0.05, 0.005);
  EXPECT_NEAR(slide_of_a_foot({.way_m = 0.10}), 0.10, 0.010);
  EXPECT_NEAR(slide_of_a_foot({.way_m = 0.10, .tilt_deg = 25.0}), 0.10, 0.010) << "on its toes";
  EXPECT_EQ(slide_of_a_foot({.way_m = 0.10, .up_m = 0.01}), 0.0) << "in the air";
}

TEST(FootSlide, OfALevelSoleThatIsDraggedIsItsWayAtAnySpeed) {
  EXPECT_NEAR(slide_of_a_foot({.way_m = 0.30, .begin = 20, .end = 30}), 0.30, 1e-9);
}

TEST(FootSlide, OfASwingThatSkimsTheFloorIsNone) {
  EXPECT_EQ(slide_of_a_foot({.way_m = 1.5, .up_m = 0.002, .tilt_deg = 25.0}), 0.0);
}

TEST(FootSlide, OfAFootInTheAirOfAReportedStepIsNone) {
  const Glide skim{.way_m = 0.8, .begin = 20, .end = 30};
  const StepTaken step{Segment::foot_r, 19.5 / 60.0, 30.5 / 60.0, 0.8};
  EXPECT_EQ(slide_of_a_foot(skim, {step}), 0.0);
  StepTaken other = step, begun = step;
  other.foot = Segment::foot_l;
  EXPECT_NEAR(slide_of_a_foot(skim, {other}), 0.8, 1e-9);
  begun.contact_s.reset();
  EXPECT_EQ(slide_of_a_foot(skim, {begun}), 0.0);
  begun.lift_s = 31.0 / 60.0;
  EXPECT_NEAR(slide_of_a_foot(skim, {begun}), 0.8, 1e-9);
}

/// The sole is that of the stance, however the foot lies in the first frame.
TEST(FootSlide, OfAClipThatBeginsOnItsToesIsOfTheStancesSole) {
  const test::StandingMan man;
  BakedClip baked;
  baked.prepared.body = man.body;
  baked.prepared.home = man.segments;
  baked.prepared.start.state.segments = man.segments;
  baked.timeline.trajectory.fps = 60.0;
  for (int f = 0; f < kFrames; ++f) {
    BodyPose pose = man.segments;
    Rigid& foot = pose[index(Segment::foot_r)];
    if (f == 0) foot.rotation = exp_rotation(Vec3(0.0, 0.0, -radians(40.0))) * foot.rotation;
    foot.translation += Vec3(0.002 * f, f == 0 ? 0.0 : 0.02, 0.0);  // in the air, level, slow
    baked.timeline.trajectory.frames.push_back(pose);
  }
  EXPECT_EQ(response_of(baked).foot_slide_max_m, 0.0);
}

/// The clip of a bake that begins in a walk, whose first frame has a foot on its toes.
TEST(FootSlide, OfAWalkerIsNotTheWayOfHisSwings) {
  Diagnostics diagnostics;
  const auto mannequin = load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
  ASSERT_TRUE(mannequin);
  BakeSettings settings;
  settings.hit = Segment::chest;
  settings.from = *parse_direction("back");
  settings.scene = SceneKind::impulse;
  settings.clip = "walk";
  settings.at_s = 0.1;
  const auto baked = bake(*mannequin, settings, diagnostics);
  ASSERT_TRUE(baked) << baked.error().message();
  const Response response = response_of(*baked);
  ASSERT_FALSE(response.steps.empty());
  EXPECT_GT(response.steps.front().length_m, 1.0);
  EXPECT_LT(response.foot_slide_max_m, 0.05);
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

/// The legs lean on one another after the first blow, and a shank touches the ground in the lunge after the
/// second.
/// Who goes more aside than ahead steps as wide as it takes.
TEST(Steps, AsideAreAsWideAsTheyHaveToBe) {
  const auto man = other_man();
  if (!man) GTEST_SKIP() << kNoExtraData;
  BakeSettings settings;
  settings.preset = "kick";
  settings.from = *parse_direction("back");
  Diagnostics diagnostics;
  const auto baked = bake(*man, settings, diagnostics);
  ASSERT_TRUE(baked);
  EXPECT_EQ(response_of(*baked).outcome, Outcome::stepped);
}

TEST(Steps, CatchABlowToTheHeadFromTheSide) {
  const auto man = other_man();
  if (!man) GTEST_SKIP() << kNoExtraData;
  Diagnostics diagnostics;
  for (const double n_s : {25.9, 31.5}) {
    BakeSettings settings;
    settings.hit = Segment::head;
    settings.from = *parse_direction("270");
    settings.scene = SceneKind::impulse;
    settings.ball_mass_kg = 1.0;
    settings.ball_speed_m_s = n_s;
    const auto baked = bake(*man, settings, diagnostics);
    ASSERT_TRUE(baked);
    EXPECT_EQ(response_of(*baked).outcome, Outcome::stepped) << n_s;
  }
}

}  // namespace
}  // namespace ukemi
