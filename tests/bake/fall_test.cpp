// Falls as they are baked: whose lights go out when, first contacts as marks, breath, clips that end too
// soon.
#include <gtest/gtest.h>

#include <algorithm>

#include "bake/bake.h"
#include "bake/other_man.h"
#include "bake/response.h"
#include "base/character_path.h"
#include "load/load.h"

namespace ukemi {
namespace {

const Character& mannequin() {
  static const Character character = [] {
    Diagnostics loading;
    return *load_character(*character_path("mannequin"), LoadOptions{}, loading);
  }();
  return character;
}

BakedClip baked(const BakeSettings& settings, Diagnostics& diagnostics) {
  auto clip = bake(mannequin(), settings, diagnostics);
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().message());
  return clip ? std::move(*clip) : BakedClip{};
}

BakedClip baked(const BakeSettings& settings) {
  Diagnostics diagnostics;
  return baked(settings, diagnostics);
}

BakeSettings kick(const std::string& from, double steps) {
  BakeSettings settings;
  settings.preset = "kick";
  settings.from = *parse_direction(from);
  settings.most_steps = steps;
  return settings;
}

std::optional<double> mark(const BakedClip& clip, const std::string& name) {
  for (const Mark& mark : clip.timeline.clip.marks)
    if (mark.name == name) return mark.time_s;
  return std::nullopt;
}

/// Farthest that a segment is from the other clip's, until a time.
double difference(const BakedClip& a, const BakedClip& b, double until_s) {
  const auto& one = a.timeline.trajectory.frames;
  const auto& other = b.timeline.trajectory.frames;
  double most = 0.0;
  for (std::size_t f = 0; f < std::min(one.size(), other.size()); ++f)
    for (int s = 0; s < kSegmentCount; ++s)
      if (static_cast<double>(f) / 60.0 <= until_s)
        most = std::max(most, (one[f][s].translation - other[f][s].translation).norm());
  return most;
}

TEST(Knockout, AtATimeChangesNothingBeforeAndEverythingAfter) {
  BakeSettings settings = kick("front", 6);
  const BakedClip alive = baked(settings);
  settings.knockout = Knockout{Knockout::At::time, 0.3};
  const BakedClip out = baked(settings);
  EXPECT_FALSE(alive.behaviour.knocked_out_s);
  ASSERT_TRUE(out.behaviour.knocked_out_s);
  EXPECT_NEAR(*out.behaviour.knocked_out_s, 0.3, 0.02);
  EXPECT_EQ(difference(alive, out, 0.29), 0.0);
  EXPECT_GT(difference(alive, out, 1.5), 0.2);
  EXPECT_EQ(response_of(out).outcome, Outcome::fell);
  EXPECT_EQ(mark(out, "knocked_out"), out.behaviour.knocked_out_s);
}

TEST(Knockout, AfterAStepDropsWhoWouldHaveStood) {
  BakeSettings settings = kick("front", 6);
  settings.strength = 0.6;
  const BakedClip alive = baked(settings);
  ASSERT_EQ(response_of(alive).outcome, Outcome::stepped);
  settings.knockout = Knockout{Knockout::At::step, 0.0};
  const BakedClip out = baked(settings);
  ASSERT_TRUE(out.behaviour.knocked_out_s);
  EXPECT_NEAR(*out.behaviour.knocked_out_s, *alive.behaviour.steps.front().contact_s, 0.02);
  EXPECT_EQ(out.behaviour.steps.size(), 1u);
  EXPECT_EQ(response_of(out).outcome, Outcome::fell);
}

TEST(Knockout, OfABlowIsAtOnceAndOfALandingWhenTheBodyIsDown) {
  BakeSettings settings = kick("front", 0);
  settings.knockout = Knockout{Knockout::At::blow, 0.0};
  EXPECT_EQ(baked(settings).behaviour.knocked_out_s, 0.0);
  settings.knockout = Knockout{Knockout::At::landing, 0.0};
  const BakedClip landed = baked(settings);
  ASSERT_TRUE(landed.behaviour.fall.landed_s);
  EXPECT_EQ(landed.behaviour.knocked_out_s, landed.behaviour.fall.landed_s);
}

TEST(Knockout, OfALimpBodyIsRefused) {
  BakeSettings settings = kick("front", 0);
  settings.outputs = {"a.glb"};
  settings.knockout = Knockout{};
  EXPECT_TRUE(check_settings("mannequin", settings));
  settings.behaviour = Behaviour::limp;
  const Status status = check_settings("mannequin", settings);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().what.find("--knockout-at"), std::string::npos);
}

TEST(FirstContacts, OfAForwardFallAreMarks) {
  const BakedClip clip = baked(kick("back", 0));
  const Response response = response_of(clip);
  ASSERT_TRUE(response.contacts.knee && response.contacts.hand && response.contacts.head);
  EXPECT_LT(response.contacts.knee->time_s, response.contacts.hand->time_s);
  EXPECT_GT(response.contacts.knee->speed_m_s, 0.5);
  EXPECT_EQ(mark(clip, "knee_contact"), response.contacts.knee->time_s);
  EXPECT_EQ(mark(clip, "hand_contact"), response.contacts.hand->time_s);
  EXPECT_EQ(mark(clip, "head_contact"), response.contacts.head->time_s);
  ASSERT_TRUE(response.contacts.first);
  EXPECT_LE(response.contacts.first->time_s, response.contacts.knee->time_s);
}

TEST(FirstContacts, OfWhoStandsAreNone) {
  BakeSettings settings = kick("front", 6);
  settings.strength = 0.2;
  const BakedClip clip = baked(settings);
  EXPECT_FALSE(response_of(clip).contacts.first);
  EXPECT_FALSE(mark(clip, "hand_contact"));
}

/// A blow of so many N s to the chest, given at once.
BakeSettings impulse(double n_s, const char* from) {
  BakeSettings settings;
  settings.scene = SceneKind::impulse;
  settings.ball_mass_kg = 1.0;
  settings.ball_speed_m_s = n_s;
  settings.from = *parse_direction(from);
  return settings;
}

TEST(Walk, StopsFromAnyPhaseOfTheStrideWithoutABlow) {
  for (const double at_s : {0.1, 0.28, 0.46, 0.64, 0.81, 0.99}) {
    BakeSettings settings;
    settings.scene = SceneKind::none;
    settings.clip = "walk";
    settings.at_s = at_s;
    const BakedClip clip = baked(settings);
    EXPECT_FALSE(clip.behaviour.fall_begins_s) << at_s;
    EXPECT_EQ(response_of(clip).end_pose, EndPose::standing) << at_s;
    EXPECT_LE(clip.behaviour.steps.size(), 5u) << at_s;
    EXPECT_EQ(clip.limits.over_1deg, 0) << at_s;
  }
}

/// Walks of other characters, on the spot and with toes that drag on the floor.
TEST(Walk, OfOtherCharactersStopsToo) {
  const auto man = other_man();
  const auto library = extra_data().value_or("") / "animation_only/kaykit/Med_MovementBasic.glb";
  if (!man || !std::filesystem::exists(library)) GTEST_SKIP() << kNoExtraData;
  Diagnostics diagnostics;
  const auto stops = [&](const Character& character, const std::string& clip) {
    int up = 0;
    for (const double at_s : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      BakeSettings settings;
      settings.scene = SceneKind::none;
      settings.clip = clip;
      settings.at_s = at_s;
      const auto outcome = bake(character, settings, diagnostics);
      EXPECT_TRUE(outcome) << (outcome ? "" : outcome.error().message());
      up += outcome && !outcome->behaviour.fall_begins_s ? 1 : 0;
    }
    return up;
  };
  EXPECT_EQ(stops(*man, "HumanArmature|Man_Walk"), 5);
  EXPECT_EQ(stops(mannequin(), library.string() + "#Rig_Medium|Walking_B"), 5);
}

TEST(Walk, AModerateBlowIsWalkedOff) {
  int up = 0;
  for (const double at_s : {0.1, 0.278, 0.456, 0.633, 0.811, 0.989})
    for (const char* from : {"front", "left", "back", "right"}) {
      BakeSettings settings = impulse(20.0, from);
      settings.clip = "walk";
      settings.at_s = at_s;
      const BakedClip clip = baked(settings);
      up += clip.behaviour.fall_begins_s ? 0 : 1;
      EXPECT_EQ(clip.limits.over_1deg, 0) << at_s << from;
    }
  EXPECT_GE(up, 23) << "of 24";
}

TEST(Supine, NoHandStaysUpInTheAir) {
  int supine = 0;
  for (const char* from : {"front", "10", "135", "345"}) {
    const BakedClip clip = baked(impulse(90.0, from));
    if (response_of(clip).end_pose != EndPose::supine) continue;
    ++supine;
    for (const Segment hand : {Segment::hand_l, Segment::hand_r})
      EXPECT_LT(clip.timeline.trajectory.frames.back()[index(hand)].translation.y(), 0.24) << from;
  }
  EXPECT_GE(supine, 2);
}

TEST(Breath, IsSeenForASecondUnlessItIsSwitchedOff) {
  BakeSettings settings = kick("front", 0);
  settings.simulation.duration_s = 8.0;
  const BakedClip breathing = baked(settings);
  ASSERT_TRUE(breathing.figures.rest_time_s);
  EXPECT_GE(breathing.timeline.clip.duration_s(), *breathing.figures.rest_time_s + 1.0);
  settings.breathes = false;
  const BakedClip still = baked(settings);
  ASSERT_TRUE(still.figures.rest_time_s);
  EXPECT_LT(still.timeline.clip.duration_s(), *still.figures.rest_time_s + settings.hold_s + 0.02);
}

TEST(Warnings, TellOfAClipThatEndsBeforeRest) {
  BakeSettings settings;
  settings.scene = SceneKind::fall;
  settings.fall_height_m = 50.0;
  Diagnostics diagnostics;
  EXPECT_FALSE(baked(settings, diagnostics).figures.rest_time_s);
  const auto says = [&] {
    return std::any_of(diagnostics.warnings().begin(), diagnostics.warnings().end(), [](const Warning& w) {
      return w.what.find("before the body is at rest") != std::string::npos;
    });
  };
  EXPECT_TRUE(says());
  diagnostics = {};
  settings.simulation.duration_s = 1.0;  // asked for
  baked(settings, diagnostics);
  EXPECT_FALSE(says());
}

}  // namespace
}  // namespace ukemi
