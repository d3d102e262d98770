// Outcomes that a director asks for: found among what a person might do, or said to be out of reach.
#include "bake/search.h"

#include <gtest/gtest.h>

#include "bake/bake.h"
#include "bake/take.h"
#include "base/character_path.h"
#include "load/load.h"

namespace ukemi {
namespace {

const Character& mannequin() {
  static const Character character = [] {
    Diagnostics diagnostics;
    return *load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
  }();
  return character;
}

/// A blow of so many N s, given at once, to the chest from a direction.
BakeSettings blow(double n_s, const std::string& from) {
  BakeSettings settings;
  settings.from = *parse_direction(from);
  settings.scene = SceneKind::impulse;
  settings.ball_mass_kg = 1.0;
  settings.ball_speed_m_s = n_s;
  settings.simulation.duration_s = 3.0;
  return settings;
}

struct Baked {
  BakedClip clip;
  Diagnostics diagnostics;
  bool fell() const { return clip.behaviour.fall_begins_s.has_value(); }
};

Baked baked(const BakeSettings& settings, const SearchRun& run = {}) {
  Baked result;
  auto clip = bake(mannequin(), settings, result.diagnostics, run);
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().message());
  if (clip) result.clip = std::move(*clip);
  return result;
}

TEST(Search, WhoWouldStandFallsWhereTheDirectorSaysSo) {
  BakeSettings settings = blow(25.0, "front");
  EXPECT_FALSE(baked(settings).fell());
  settings.outcome = Wanted::fall;
  const Baked fallen = baked(settings);
  EXPECT_TRUE(fallen.fell());
  EXPECT_GT(fallen.clip.trials, 1);
  EXPECT_EQ(fallen.clip.figures.help_n_s, 0.0);
  EXPECT_TRUE(fallen.diagnostics.warnings().empty());
}

TEST(Search, WhoWouldFallStandsWhereAPersonCould) {
  BakeSettings settings = blow(60.0, "120");
  EXPECT_TRUE(baked(settings).fell());
  settings.outcome = Wanted::stand;
  const Baked stood = baked(settings);
  EXPECT_FALSE(stood.fell());
  EXPECT_GT(stood.clip.trials, 1);
  EXPECT_EQ(stood.clip.limits.over_1deg, 0);
}

TEST(Search, WhatNoPersonCouldDoIsSaidOrHelpedTo) {
  BakeSettings settings = blow(100.0, "back");
  settings.outcome = Wanted::stand;
  const Baked fallen = baked(settings);
  EXPECT_TRUE(fallen.fell());
  ASSERT_EQ(fallen.diagnostics.warnings().size(), 1u);
  EXPECT_NE(fallen.diagnostics.warnings()[0].what.find("none of 5 trials stands"), std::string::npos);

  settings.assist = true;
  const Baked helped = baked(settings);
  EXPECT_FALSE(helped.fell());
  EXPECT_GT(helped.clip.figures.help_n_s, 10.0);
  EXPECT_LT(helped.clip.figures.help_n_s, 400.0);
  EXPECT_GT(helped.clip.trials, 5);
  EXPECT_LT(helped.clip.figures.energy_gain_max_j, 6.0);
}

/// Help for a blow: what the search gives, and the least of eight shares of a force that is enough, N s.
struct Helps {
  double searched = 0.0, least = 0.0;
};

Helps helps_for(double n_s, const std::string& from) {
  BakeSettings settings = blow(n_s, from);
  settings.outcome = Wanted::stand;
  settings.search = 1.0;
  settings.assist = true;
  Diagnostics diagnostics;
  const auto prepared = prepare_bake(mannequin(), settings, diagnostics);
  EXPECT_TRUE(prepared);
  // What a force gives from outside where it keeps the body up; nothing where he falls.
  const auto given_n_s = [&](double most_n) -> std::optional<double> {
    BehaviourSettings behaviour = prepared->behaviour;
    behaviour.choice.help = {most_n, false};
    behaviour.must_stand = true;
    const auto run = simulate_take(settings, *prepared, behaviour, diagnostics);
    EXPECT_TRUE(run);
    return run->behaviour.fall_begins_s ? std::nullopt : std::optional(run->figures.help_n_s);
  };
  double enough_n = 0.05 * prepared->body.mass_kg * settings.simulation.gravity;
  for (int i = 0; i < 5 && !given_n_s(enough_n); ++i) enough_n *= 2.0;
  std::optional<double> least;
  for (int i = 1; i <= 8 && !least; ++i) least = given_n_s(enough_n * (0.5 + i / 16.0));
  return {baked(settings).clip.figures.help_n_s, least.value_or(0.0)};
}

TEST(Search, HelpIsTheLeastOfEightShares) {
  for (const auto& [n_s, from] : {std::pair(100.0, "back"), {80.0, "back"}}) {
    const Helps helps = helps_for(n_s, from);
    EXPECT_GT(helps.least, 0.0) << n_s;
    EXPECT_NEAR(helps.searched, helps.least, 1e-9) << n_s;
  }
}

TEST(Search, ALimpBodyThatFellIsNotTakenForOneThatStood) {
  BakeSettings settings = blow(25.0, "front");
  settings.behaviour = Behaviour::limp;
  settings.outcome = Wanted::stand;
  const Baked fallen = baked(settings);
  ASSERT_EQ(fallen.diagnostics.warnings().size(), 2u);  // the other: an outcome is for a body that lives
  EXPECT_NE(fallen.diagnostics.warnings()[1].what.find("does not stand"), std::string::npos);
}

TEST(Search, HelpIsNotGivenWhereItIsNotNeeded) {
  BakeSettings settings = blow(25.0, "front");
  settings.outcome = Wanted::stand;
  settings.assist = true;
  EXPECT_EQ(baked(settings).clip.figures.help_n_s, 0.0);
}

TEST(Search, TheAnswerIsTheSameOnAnyNumberOfThreads) {
  BakeSettings settings = blow(60.0, "45");
  settings.outcome = Wanted::stand;
  SearchRun two;
  two.threads = 2;
  const Baked one = baked(settings), other = baked(settings, two);
  EXPECT_EQ(one.clip.figures.hash, other.clip.figures.hash);
  EXPECT_EQ(one.clip.trials, other.clip.trials);
  EXPECT_EQ(one.clip.score, other.clip.score);
}

TEST(Search, TheBestOfTheTrialsIsKept) {
  BakeSettings settings = blow(40.0, "back");
  const double alone = baked(settings).clip.score;
  settings.search = 6.0;
  const Baked best = baked(settings);
  EXPECT_EQ(best.clip.trials, 6);
  EXPECT_GE(best.clip.score, alone);
}

TEST(Search, ProgressIsToldAndAStopKeepsTheBestSoFar) {
  BakeSettings settings = blow(20.0, "front");
  settings.search = 8.0;
  std::vector<int> told;
  SearchRun run;
  run.after_each = [&told](int done, int most) {
    told.push_back(done);
    EXPECT_EQ(most, 8);
  };
  run.stopped = [&told] { return told.size() == 3; };
  const Baked stopped = baked(settings, run);
  EXPECT_EQ(told, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(stopped.clip.trials, 3);
  ASSERT_EQ(stopped.diagnostics.warnings().size(), 1u);
  EXPECT_NE(stopped.diagnostics.warnings()[0].what.find("stopped after 3 of 8 trials"), std::string::npos);
}

TEST(Search, FurtherChoicesComeFromTheSeed) {
  BakeSettings settings;
  settings.search = 9.0;
  const auto swing = [](const BakeSettings& s) { return choices_for(s).back().swing; };
  const double first = swing(settings);
  EXPECT_EQ(first, swing(settings));
  settings.seed = 4;
  EXPECT_NE(first, swing(settings));
  EXPECT_EQ(choices_for(settings).size(), 9u);
}

/// Largest turn of a segment against its parent from where it was at first, rad.
double most_turn(const BakedClip& clip, Segment child, Segment parent) {
  const auto relative = [&](const BodyPose& pose) {
    return pose[index(parent)].rotation.conjugate() * pose[index(child)].rotation;
  };
  double most = 0.0;
  for (const BodyPose& pose : clip.timeline.trajectory.frames)
    most = std::max(most, angle_between(relative(pose), relative(clip.timeline.trajectory.frames.front())));
  return most;
}

TEST(HoldingArms, AnArmThatHoldsSomethingNeitherSwingsNorCatches) {
  BakeSettings settings = blow(25.0, "front");
  const double free = most_turn(baked(settings).clip, Segment::forearm_l, Segment::upperarm_l);
  settings.arms = HoldingArms::left;
  const Baked holding = baked(settings);
  const double held = most_turn(holding.clip, Segment::forearm_l, Segment::upperarm_l);
  EXPECT_LT(held, 0.5 * free);
  EXPECT_GT(most_turn(holding.clip, Segment::forearm_r, Segment::upperarm_r), held);
}

}  // namespace
}  // namespace ukemi
