#include "study/compare.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/character_path.h"
#include "base/parallel.h"
#include "load/load.h"
#include "study/compare_pictures.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

const Character& mannequin() {
  static const Character character = [] {
    Diagnostics diagnostics;
    auto loaded = load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
    EXPECT_TRUE(loaded);
    return *loaded;
  }();
  return character;
}

Comparison compared(const CompareSettings& settings) {
  Diagnostics diagnostics;
  auto comparison = compare("mannequin", mannequin(), settings, diagnostics, {});
  if (!comparison) throw std::runtime_error(comparison.error().message());
  return std::move(*comparison);
}

CompareSettings short_settings() {
  CompareSettings settings;
  settings.hits = 3;
  settings.seed = 5;
  settings.duration_s = 0.4;
  return settings;
}

const MethodFigures& method(const Comparison& comparison, const std::string& name) {
  for (const MethodFigures& figures : comparison.methods)
    if (figures.method.name == name) return figures;
  throw std::runtime_error("no method " + name);
}

/// Without what differs from run to run.
std::string repeatable_json(const Comparison& comparison) {
  Json json = Json::parse(comparison_json(comparison));
  for (Json& figures : json["methods"]) {
    EXPECT_GT(figures["us_per_step"], 0.0);
    figures.erase("us_per_step");
    figures.erase("cpu_s_per_s");
  }
  return json.dump();
}

// The published first numbers of SplitMix64 for the seed 1234567: 6457827717110365317 3203168211198807973
// 9817491932198370423 4593380528125082431 16408922859458223821.
TEST(RandomHits, AreMadeOfTheNumbersOfSplitMix64) {
  const RandomHit hit = random_hits(1234567, 1).front();
  constexpr double k = 1.0 / 18446744073709551616.0;
  EXPECT_EQ(hit.segment, segment_at(static_cast<int>(18 * (6457827717110365317.0 * k))));
  EXPECT_NEAR(hit.from.azimuth, 2.0 * kPi * (3203168211198807973.0 * k), 1e-12);
  EXPECT_NEAR(hit.from.elevation, radians(-15.0 + 30.0 * (9817491932198370423.0 * k)), 1e-12);
  EXPECT_NEAR(hit.mass_kg, 5.0 + 5.0 * (4593380528125082431.0 * k), 1e-12);
  EXPECT_NEAR(hit.speed_m_s, 5.0 + 10.0 * (16408922859458223821.0 * k), 1e-12);
}

TEST(RandomHits, OfMoreHitsBeginWithTheSameOnesAndReachEverySegment) {
  const auto few = random_hits(9, 3);
  const auto many = random_hits(9, 300);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].segment, many[i].segment);
    EXPECT_EQ(few[i].speed_m_s, many[i].speed_m_s);
  }
  PerSegment<int> count{};
  for (const RandomHit& hit : many) ++count[index(hit.segment)];
  for (const int n : count) EXPECT_GT(n, 0);
}

#ifdef __SANITIZE_ADDRESS__
constexpr int kHitsOnTheMannequin = 4;  // each takes seconds there
#else
constexpr int kHitsOnTheMannequin = 200;
#endif

void expect_human(const Trial& trial) {
  ASSERT_FALSE(trial.failure);
  const LimitFigures& limits = trial.result.limits;
  const SimulationFigures& figures = trial.result.figures;
  EXPECT_GT(limits.samples, 50 * kJointCount);
  EXPECT_EQ(limits.over_1deg, 0);
  EXPECT_LT(limits.excess_max_deg, 1.0);
  EXPECT_LT(limits.excess_projected_max_deg, 0.001);
  EXPECT_LT(figures.joint_separation_max_m, 0.010);
  EXPECT_LT(figures.energy_gain_max_j, 6.0);
  for (const BodyPose& frame : trial.result.trajectory.frames)
    for (const Rigid& segment : frame)
      ASSERT_TRUE(segment.translation.allFinite() && segment.rotation.coeffs().allFinite());
}

TEST(RandomHits, KeepTheMannequinHumanWithDefaultSettings) {
  Diagnostics diagnostics;
  const auto prepared = prepare_bake(mannequin(), BakeSettings{}, diagnostics);
  ASSERT_TRUE(prepared) << prepared.error().message();
  const std::vector<RandomHit> hits = random_hits(CompareSettings{}.seed, kHitsOnTheMannequin);
  const Quat& pelvis = prepared->start.segments[index(Segment::pelvis)].rotation;
  std::vector<std::optional<Trial>> trials(hits.size());
  const auto work = [&](std::size_t i) -> Status {
    Diagnostics unsaid;
    const Scene scene = scene_of(hits[i], pelvis);
    const SimulationSettings settings;
    auto trial = simulate_trial(simulation_input(*prepared, scene, settings), prepared->range, unsaid);
    if (!trial) return trial.error();
    trials[i] = std::move(*trial);
    return Done{};
  };
  const Status status = for_each_parallel(hits.size(), 2, work);
  ASSERT_TRUE(status) << status.error().message();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    SCOPED_TRACE(fmt::format("hit {}: {}", i, describe(hits[i])));
    ASSERT_TRUE(trials[i]);
    expect_human(*trials[i]);
  }
}

TEST(Compare, ChangesAreThoseOfTheSameHitsWithTheirInterval) {
  MethodFigures b, c;
  b.airborne_by_hit_s = {0.2, 0.1, 0.0, 9.0};
  c.airborne_by_hit_s = {0.1, 0.1, 0.1, 0.0};
  b.exploded_hits = {false, false, false, true};
  c.exploded_hits = {false, false, false, false};
  const PairedChange change = paired_change(c, b, &MethodFigures::airborne_by_hit_s);
  EXPECT_NEAR(change.fraction, 0.0, 1e-12);
  EXPECT_EQ(change.less, 1);
  EXPECT_EQ(change.more, 1);
  // Differences -0.1, 0, 0.1: standard deviation 0.1, standard error 0.1 / sqrt(3), mean of b 0.1.
  EXPECT_NEAR(change.high, 1.96 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(change.low, -change.high, 1e-12);
  const PairedChange none = paired_change(b, b, &MethodFigures::airborne_by_hit_s);
  EXPECT_EQ(none.fraction, 0.0);
  EXPECT_EQ(none.high, 0.0);
}

TEST(Compare, RunsTheMethodsOfThePaperAndOurs) {
  std::vector<std::string> names;
  for (const Method& m : methods_to_compare(3.0)) names.push_back(m.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"a", "b", "b-euler", "c", "c-k1", "ours", "ours-limp", "living"}));
  const auto methods = methods_to_compare(3.0);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(methods[i].simulation.fixed_hz, 480.0);
    EXPECT_EQ(tone_of(methods[i].simulation), 0.0);
    EXPECT_EQ(damping_of(methods[i].simulation), 0.0);
    EXPECT_FALSE(methods[i].simulation.stop_at_rest);
  }
  EXPECT_EQ(methods[3].simulation.active_k, 20.0);
  EXPECT_EQ(methods[4].simulation.active_k, 1.0);
}

TEST(Compare, AnExceptionInAThreadEndsTheComparisonNotTheProgram) {
  CompareSettings settings = short_settings();
  settings.duration_s = 0.02;
  settings.threads = 2;
  Diagnostics diagnostics;
  const auto refused = compare("mannequin", mannequin(), settings, diagnostics,
                               [](int, int) { throw std::runtime_error("no terminal"); });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::internal);
  EXPECT_EQ(refused.error().what, "unexpected failure: no terminal");
}

TEST(Compare, FindsJointsOutsideTheirRangeWithStopsPerAxisAndNoneWithOurs) {
  CompareSettings settings = short_settings();
  settings.duration_s = 1.5;
  const Comparison comparison = compared(settings);
  const MethodFigures& axis = method(comparison, "a");
  EXPECT_EQ(axis.samples, 3 * 720 * kJointCount);
  EXPECT_GT(axis.over_1deg, 0);
  EXPECT_GT(axis.excess_max_deg, axis.excess_p999_deg);
  EXPECT_TRUE(axis.worst_joint);
  for (const char* name : {"ours", "ours-limp", "living"}) {
    const MethodFigures& ours = method(comparison, name);
    EXPECT_GT(ours.samples, 3 * 100 * kJointCount) << name;
    EXPECT_EQ(ours.over_1deg, 0) << name;
    EXPECT_LT(ours.excess_max_deg, 1.0) << name;
    EXPECT_EQ(ours.exploded, 0) << name;
  }
  EXPECT_LT(method(comparison, "c").angular_momentum_mean_kg_m2_s,
            method(comparison, "b").angular_momentum_mean_kg_m2_s);
}

TEST(Compare, CountsTheRunsThatExplodedAndLeavesThemOutOfTheMeans) {
  CompareSettings settings;
  settings.hits = 14;
  settings.duration_s = 1.0;
  const Comparison comparison = compared(settings);
  const MethodFigures& euler = method(comparison, "b-euler");
  EXPECT_EQ(euler.exploded, 1);
  for (const MethodFigures& figures : comparison.methods) {
    double sum = 0.0;
    int exploded = 0;
    for (int i = 0; i < settings.hits; ++i) {
      exploded += figures.exploded_hits[i];
      if (!figures.exploded_hits[i]) sum += figures.turning_by_hit_rad_s[i];
    }
    EXPECT_EQ(figures.exploded, exploded) << figures.method.name;
    EXPECT_NEAR(figures.turning_mean_rad_s, sum / (settings.hits - exploded), 1e-9) << figures.method.name;
  }
}

TEST(Compare, GivesTheSameFiguresForTheSameSeedOnAnyNumberOfThreads) {
  CompareSettings settings = short_settings();
  settings.threads = 1;
  const std::string one = repeatable_json(compared(settings));
  settings.threads = 2;
  EXPECT_EQ(repeatable_json(compared(settings)), one);
  settings.seed = 6;
  EXPECT_NE(repeatable_json(compared(settings)), one);
}

TEST(Compare, JudgesEveryRegionAgainstTheHumanOne) {
  CompareSettings settings = short_settings();
  settings.duration_s = 1.0;
  settings.region = "box";
  const Comparison comparison = compared(settings);
  EXPECT_EQ(comparison.judged.name, "human");
  // Held exactly, the box lets joints go where no human joint goes.
  EXPECT_GT(method(comparison, "ours").over_1deg, 0);
}

TEST(Compare, CallsARunExplodedThatDivergedGainedEnergyOrCameApart) {
  Trial calm;
  EXPECT_FALSE(exploded(calm));
  Trial trial = calm;
  trial.failure = Error{ErrorKind::simulation, "", 0, 0, "", "diverged", ""};
  EXPECT_TRUE(exploded(trial));
  trial = calm;
  trial.result.figures.energy_gain_max_j = 1001.0;
  EXPECT_TRUE(exploded(trial));
  trial = calm;
  trial.result.figures.joint_separation_max_m = 0.21;
  EXPECT_TRUE(exploded(trial));
}

TEST(Compare, PrintsATableWhoseLinesAreOneMethodEach) {
  Comparison comparison;
  comparison.character = "x.glb";
  MethodFigures figures;
  figures.method = methods_to_compare(3.0).front();
  figures.samples = 1000000;
  figures.over_1deg = 34567;
  figures.excess_max_deg = 71.25;
  figures.worst_joint = Joint::elbow_l;
  comparison.methods = {figures};
  const std::string text = comparison_text(comparison);
  EXPECT_NE(text.find("34567  3.46 %"), std::string::npos) << text;
  EXPECT_NE(text.find("71.25  elbow_l    0.0"), std::string::npos) << text;
}

TEST(ComparePictures, ShowTheHitInWhichTheFirstMethodBendsAJointFarthestOutAmongThoseThatHold) {
  Comparison comparison;
  MethodFigures a, b;
  a.excess_max_by_hit_deg = {10, 90, 40};
  a.exploded_hits = {false, false, false};
  b.exploded_hits = {false, true, false};
  comparison.methods = {a, b};
  EXPECT_EQ(hit_to_show(comparison), 2);
}

}  // namespace
}  // namespace ukemi
