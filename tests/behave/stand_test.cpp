// A standing body under blows, in the simulation.
#include <gtest/gtest.h>

#include "behave/behaviour.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

struct Blow {
  Segment segment = Segment::chest;
  Vec3 way = -Vec3::UnitX();  // from the front
  double n_s = 0.0;
};

SimulationResult lives(const Blow& blow, const BehaviourSettings& behaviour = {}, double duration_s = 4.0,
                       const test::StandingMan& man = test::StandingMan()) {
  Scene scene;
  scene.kind = blow.n_s > 0.0 ? SceneKind::impulse : SceneKind::none;
  scene.target = blow.segment;
  scene.direction = blow.way;
  scene.impulse_n_s = blow.n_s;
  SimulationSettings settings;
  settings.duration_s = duration_s;
  settings.stop_at_rest = false;
  static const auto thresholds = load_active_thresholds("");
  const auto strength = muscle_strength(man.body, Sex::male, 1.0);
  const StartState start = man.start();
  Diagnostics diagnostics;
  auto result =
      simulate({man.body, man.range, *thresholds, *strength, start, scene, settings,
                behaviour_of(man.body, man.range, *strength, start.segments, scene, behaviour, settings)},
               diagnostics);
  EXPECT_TRUE(result) << result.error().message();
  return result ? std::move(*result) : SimulationResult{};
}

double pelvis_height(const SimulationResult& run) { return run.trajectory.frames.back()[0].translation.y(); }

double most_moved(const SimulationResult& run, Segment segment) {
  double most = 0.0;
  const Vec3 from = run.trajectory.frames.front()[index(segment)].translation;
  for (const BodyPose& frame : run.trajectory.frames)
    most = std::max(most, (frame[index(segment)].translation - from).norm());
  return most;
}

TEST(Stand, QuietlyForTenSecondsWithoutABlow) {
  const SimulationResult run = lives({}, {}, 10.0);
  EXPECT_TRUE(run.behaviour.steps.empty());
  EXPECT_FALSE(run.behaviour.fall_begins_s);
  EXPECT_LT(most_moved(run, Segment::foot_l), 0.003);
  EXPECT_LT(most_moved(run, Segment::chest), 0.02);
  EXPECT_LT(run.figures.jitter_rad_s, 0.02);
  EXPECT_EQ(run.figures.rejected_steps, 0);
  EXPECT_EQ(run.limits.over_1deg, 0);
  EXPECT_GT(run.figures.muscle_share_max, 0.02);
}

/// When two runs first differ, s.
double apart_from_s(const SimulationResult& a, const SimulationResult& b) {
  for (std::size_t f = 0; f < a.trajectory.frames.size(); ++f)
    for (int s = 0; s < kSegmentCount; ++s)
      if ((a.trajectory.frames[f][s].translation - b.trajectory.frames[f][s].translation).norm() > 1e-6)
        return static_cast<double>(f) / a.trajectory.fps;
  return 1e9;
}

TEST(Stand, BalanceActsAfterItsLatency) {
  const auto with = [](double latency_s) {
    BehaviourSettings behaviour;
    behaviour.latency_s = latency_s;
    return lives({Segment::chest, -Vec3::UnitX(), 10.0}, behaviour, 0.4);
  };
  const SimulationResult late = with(0.30);
  EXPECT_NEAR(apart_from_s(with(0.10), late), 0.10, 0.03);
  EXPECT_NEAR(apart_from_s(with(0.20), late), 0.20, 0.03);
}

TEST(Stand, SwaysBackFromAWeakBlowWithPlantedFeet) {
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
    const SimulationResult run = lives({Segment::chest, way, 8.0});
    EXPECT_TRUE(run.behaviour.steps.empty());
    EXPECT_GT(most_moved(run, Segment::head), 0.03);
    EXPECT_LT(most_moved(run, Segment::foot_l), 0.02);
    const BodyPose& end = run.trajectory.frames.back();
    const BodyPose& start = run.trajectory.frames.front();
    EXPECT_LT((end[0].translation - start[0].translation).norm(), 0.015);
  }
}

TEST(Stand, ARobeThatTouchesTheFloorIsNoFall) {
  test::StandingMan man;
  man.body.segments[index(Segment::thigh_l)].floor_points = {{0.12, -0.915, -0.15}, {-0.12, -0.915, -0.15}};
  const SimulationResult run = lives({Segment::chest, Vec3::UnitZ(), 8.0}, {}, 4.0, man);
  EXPECT_TRUE(run.figures.touch_down[index(Segment::thigh_l)].has_value());
  EXPECT_FALSE(run.behaviour.fall_begins_s);
}

TEST(Stand, StepsFromAStrongerBlowAndStaysUp) {
  const SimulationResult run = lives({Segment::chest, -Vec3::UnitX(), 30.0});
  ASSERT_FALSE(run.behaviour.steps.empty());
  EXPECT_LE(run.behaviour.steps.size(), 6u);
  EXPECT_FALSE(run.behaviour.fall_begins_s);
  EXPECT_GT(pelvis_height(run), 0.8);
  const StepTaken& first = run.behaviour.steps.front();
  EXPECT_GT(first.lift_s, 0.12);
  EXPECT_LT(first.lift_s, 0.45);
  ASSERT_TRUE(first.contact_s);
  EXPECT_LT(*first.contact_s, 0.9);
  EXPECT_GT(first.length_m, 0.08);
  EXPECT_EQ(run.limits.over_1deg, 0);
  EXPECT_LE(run.figures.muscle_share_max, 1.0 + 1e-9);
  EXPECT_GT(run.figures.muscle_work_j, 20.0);
}

TEST(Stand, AdmitsThatAHopelessBlowIsLostAndFalls) {
  const SimulationResult run = lives({Segment::chest, -Vec3::UnitX(), 200.0});
  ASSERT_TRUE(run.behaviour.fall_begins_s);
  EXPECT_LT(*run.behaviour.fall_begins_s, 0.5);
  EXPECT_LT(pelvis_height(run), 0.5);
}

TEST(Stand, WithoutStepsKeepsItsFeetOrFalls) {
  BehaviourSettings planted;
  planted.most_steps = 0;
  EXPECT_TRUE(lives({Segment::chest, -Vec3::UnitX(), 60.0}, planted).behaviour.steps.empty());
  const SimulationResult weak = lives({Segment::chest, Vec3::UnitX(), 10.0}, planted);
  EXPECT_TRUE(weak.behaviour.steps.empty());
  EXPECT_GT(pelvis_height(weak), 0.8);
}

TEST(Stand, DazedIsWorseAtIt) {
  BehaviourSettings dazed;
  dazed.kind = Behaviour::dazed;
  const SimulationResult run = lives({Segment::chest, -Vec3::UnitX(), 35.0}, dazed);
  EXPECT_LE(run.behaviour.steps.size(), 1u);
  EXPECT_TRUE(run.behaviour.fall_begins_s);
  EXPECT_FALSE(lives({Segment::chest, -Vec3::UnitX(), 35.0}).behaviour.fall_begins_s);
}

TEST(Stand, TheSameAgainIsTheSameToTheLastBit) {
  const Blow blow{Segment::pelvis, Vec3(0, 0, 1), 30.0};
  EXPECT_EQ(lives(blow).figures.hash, lives(blow).figures.hash);
}

TEST(Stand, SeedsGiveOtherTakes) {
  BehaviourSettings other;
  other.seed = 7;
  const Blow blow{Segment::chest, -Vec3::UnitX(), 30.0};
  EXPECT_NE(lives(blow).figures.hash, lives(blow, other).figures.hash);
  EXPECT_FALSE(lives(blow, other).behaviour.fall_begins_s);
}

TEST(Stand, MirroredBlowsEndAlike) {
  const SimulationResult left = lives({Segment::chest, Vec3(0, 0, 1), 25.0});
  const SimulationResult right = lives({Segment::chest, Vec3(0, 0, -1), 25.0});
  ASSERT_EQ(left.behaviour.steps.size(), right.behaviour.steps.size());
  for (std::size_t i = 0; i < left.behaviour.steps.size(); ++i)
    EXPECT_NE(left.behaviour.steps[i].foot, right.behaviour.steps[i].foot) << i;
}

TEST(Stand, ABodyOfStrangeMassOrGravityStaysFinite) {
  for (const double gravity : {0.5, 3.7, 25.0, -2.0, 0.0}) {
    static const test::StandingMan man;
    Scene scene;
    scene.kind = SceneKind::impulse;
    scene.direction = Vec3::UnitX();
    scene.impulse_n_s = 30.0;
    SimulationSettings settings;
    settings.duration_s = 1.0;
    settings.gravity = gravity;
    const auto thresholds = load_active_thresholds("");
    const auto strength = muscle_strength(man.body, Sex::male, 1.0);
    const StartState start = man.start();
    Diagnostics diagnostics;
    const auto result =
        simulate({man.body, man.range, *thresholds, *strength, start, scene, settings,
                  behaviour_of(man.body, man.range, *strength, start.segments, scene, {}, settings)},
                 diagnostics);
    if (!result) continue;
    for (const Rigid& segment : result->trajectory.frames.back())
      EXPECT_TRUE(segment.translation.allFinite()) << gravity;
  }
}

}  // namespace
}  // namespace ukemi
