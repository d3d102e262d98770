#include "simulate/simulate.h"

#include <ode/ode.h>

#include <optional>

#include "physics/restriction.h"
#include "simulate/hand_on_wrist.h"
#include "simulate/standing_man.h"
#include "support/random.h"

namespace ukemi {
using test::simulate_limp;

namespace {

using test::run;
using test::StandingMan;

#ifdef __SANITIZE_ADDRESS__
constexpr std::uint64_t kRandomHits = 10;  // each takes seconds there
#else
constexpr std::uint64_t kRandomHits = 200;
#endif

Scene still() {
  Scene scene;
  scene.kind = SceneKind::impulse;
  scene.impulse_n_s = 0.0;
  scene.direction = Vec3::UnitX();
  return scene;
}

Scene random_hit(std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  scene.target = segment_at(static_cast<int>(test::random_below(random, kSegmentCount)));
  const double azimuth = random.uniform(0.0, 2.0 * kPi);
  scene.direction = Vec3(std::cos(azimuth), 0.0, std::sin(azimuth));
  scene.ball_mass_kg = random.uniform(5.0, 10.0);
  scene.ball_speed_m_s = random.uniform(5.0, 15.0);
  scene.ball_radius_m = 0.15;
  return scene;
}

Vec3 centre_of_mass(const StandingMan& man, const BodyPose& pose) {
  Vec3 sum = Vec3::Zero();
  for (int s = 0; s < kSegmentCount; ++s)
    sum += man.body.segments[s].mass_kg * (pose[s] * man.body.segments[s].centre_of_mass);
  return sum / man.body.mass_kg;
}

void raise(StandingMan& man, double height) {
  for (Rigid& segment : man.segments) segment.translation.y() += height;
}

/// The active restriction of a hand that spins about its centre.
class SpinningHand {
 public:
  SpinningHand(Active kind, double k, double threshold)
      : on_wrist_(Vec3(0.0, 0.0, 9.0), balanced),
        active_(on_wrist_.world(), on_wrist_.model(), on_wrist_.wrist(), kind, k, Vec3::Constant(threshold)) {
  }
  double step(double h) {
    active_.prepare(true);
    dWorldStep(on_wrist_.world().id(), h);
    return vec3(dBodyGetAngularVel(on_wrist_.hand().id)).z();
  }

 private:
  static void balanced(BodySegment& hand) {
    hand.mass_kg = 0.4;
    hand.inertia = Vec3(5e-4, 3e-4, 8e-4).asDiagonal();
    hand.centre_of_mass.setZero();
  }

  test::HandOnWrist on_wrist_;
  ActiveLimit active_;
};

TEST(ActiveLimit, ImplicitDecaysAsTheClosedFormUntilTheThreshold) {
  const double k = 40.0;
  const double h = 1.0 / 480.0;
  SpinningHand hand(Active::implicit, k, 2.0);
  double expected = 9.0;
  for (int n = 0; n < 60; ++n) {
    if (expected > 2.0) expected /= 1.0 + k * h;  // T = -k I omega at the end of the step
    EXPECT_NEAR(hand.step(h), expected, 1e-5) << n;
  }
  EXPECT_LT(expected, 2.0);
}

TEST(ActiveLimit, ExplicitDecaysAsTheClosedForm) {
  const double k = 20.0;
  const double h = 1.0 / 480.0;
  SpinningHand hand(Active::explicit_torque, k, 2.0);
  double expected = 9.0;
  for (int n = 0; n < 60; ++n) {
    if (expected > 2.0) expected *= 1.0 - k * h;
    EXPECT_NEAR(hand.step(h), expected, 1e-5) << n;
  }
}

TEST(LookAhead, OdeTreatsAStopAheadAsALimitOnTheStep) {
  EXPECT_TRUE(look_ahead_works()) << "seen with ODE 0.16.2; this is ODE " UKEMI_ODE_VERSION
                                     ", and --limits edges refuses to run with it";
}

TEST(Simulate, FreeFallIsTheSemiImplicitClosedForm) {
  StandingMan man;
  raise(man, 50.0);
  SimulationSettings settings;
  settings.fixed_hz = 480.0;
  settings.fps = 480.0;
  settings.duration_s = 1.0;
  const auto result = run(man, still(), settings);
  ASSERT_EQ(result.trajectory.frames.size(), 481u);
  const double h = 1.0 / 480.0;
  const double start = centre_of_mass(man, man.segments).y();
  for (int n = 0; n <= 480; n += 32)
    EXPECT_NEAR(centre_of_mass(man, result.trajectory.frames[n]).y(),
                start - 9.81 * h * h * n * (n + 1) / 2.0, 1e-9);
  EXPECT_NEAR(result.figures.airborne_mean_s, 1.0, 1.5 * h);
}

TEST(Simulate, MomentumInFlightIsKeptWhileLimitsAreHit) {
  StandingMan man;
  raise(man, 50.0);
  SimulationSettings settings;
  settings.gravity = 0.0;
  settings.fixed_hz = 480.0;
  settings.duration_s = 1.0;
  settings.limits = Limits::segments;  // no projection, which moves bodies without forces
  settings.active = Active::off;
  Scene kick = still();
  kick.target = Segment::hand_r;
  kick.impulse_n_s = 20.0;
  kick.direction = Vec3(0.6, 0.8, 0.0);
  const auto result = run(man, kick, settings);
  EXPECT_GT(result.limits.excess_max_deg, 0.0) << "no limit was hit";
  const Vec3 start = centre_of_mass(man, man.segments);
  for (std::size_t i = 0; i < result.trajectory.frames.size(); ++i) {
    const Vec3 moved = centre_of_mass(man, result.trajectory.frames[i]) - start;
    const Vec3 expected = static_cast<double>(i) / 60.0 * 20.0 / man.body.mass_kg * kick.direction;
    EXPECT_LT((moved - expected).norm(), 1e-12 + 1e-12 * static_cast<double>(i));
  }
}

TEST(Simulate, IndependentAxesLetJointsLeaveTheRange) {
  const StandingMan man;
  SimulationSettings edges;
  SimulationSettings axis;
  edges.fixed_hz = axis.fixed_hz = 480.0;
  axis.limits = Limits::axis;
  const double ours = run(man, random_hit(1001), edges).limits.excess_max_deg;
  const double theirs = run(man, random_hit(1001), axis).limits.excess_max_deg;
  EXPECT_LT(ours, 3.0);
  EXPECT_GT(theirs, 10.0);
}

TEST(Simulate, TheSameInputGivesTheSameBitsAtAnyFrameRate) {
  const StandingMan man;
  SimulationSettings settings;
  const auto first = run(man, random_hit(7), settings);
  EXPECT_EQ(first.figures.hash, run(man, random_hit(7), settings).figures.hash);
  settings.fps = 25.0;
  EXPECT_EQ(first.figures.hash, run(man, random_hit(7), settings).figures.hash);
  settings.active = Active::off;
  EXPECT_NE(first.figures.hash, run(man, random_hit(7), settings).figures.hash);
}

TEST(Simulate, FrameZeroIsTheStartAndFramesOnStepEndsAgreeAcrossRates) {
  const StandingMan man;
  SimulationSettings settings;
  const auto at60 = run(man, random_hit(3), settings);
  settings.fps = 120.0;
  const auto at120 = run(man, random_hit(3), settings);
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_LT((at60.trajectory.frames[0][s].translation - man.segments[s].translation).norm(), 1e-12);
  ASSERT_EQ(at120.trajectory.frames.size(), 2 * at60.trajectory.frames.size() - 1);
  for (std::size_t i = 0; i < at60.trajectory.frames.size(); ++i)
    EXPECT_EQ(at60.trajectory.frames[i][0].translation, at120.trajectory.frames[2 * i][0].translation);
}

TEST(Simulate, ExplicitActiveRestrictionIsRefusedWhereItExplodes) {
  const StandingMan man;
  SimulationSettings settings;
  settings.active = Active::explicit_torque;
  settings.fixed_hz = 480.0;
  settings.active_k = 60.0;
  Diagnostics diagnostics;
  const auto refused = simulate_limp(man.body, man.range, man.start(), random_hit(1), settings, diagnostics);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  EXPECT_NE(refused.error().what.find("k = 60"), std::string::npos);
  settings.active_k = 20.0;
  EXPECT_TRUE(simulate_limp(man.body, man.range, man.start(), random_hit(1), settings, diagnostics));
}

TEST(Simulate, TheBallStartsTouchingTheTargetAndPushesItAlong) {
  const StandingMan man;
  Scene scene;
  scene.target = Segment::chest;
  scene.direction = -Vec3::UnitX();  // from the front
  SimulationSettings settings;
  settings.duration_s = 0.3;
  const auto result = run(man, scene, settings);
  EXPECT_GT(result.trajectory.impact_point.x(), 0.05);
  EXPECT_LT(result.trajectory.impact_point.x(), 0.25);
  EXPECT_LT(result.trajectory.frames.back()[index(Segment::chest)].translation.x(), -0.05);
  EXPECT_NEAR(result.figures.momentum_n_s, 30.0, 1e-12);
}

TEST(Simulate, ToneHoldsTheBodyUpAtFirstAndThenGivesWay) {
  const StandingMan man;
  SimulationSettings limp;
  SimulationSettings toned;
  limp.tone = 0.0;
  toned.tone = 0.6;
  const auto sack = run(man, still(), limp);
  const auto person = run(man, still(), toned);
  const auto head_height = [](const SimulationResult& result, std::size_t frame) {
    return result.trajectory.frames[frame][index(Segment::head)].translation.y();
  };
  EXPECT_GT(head_height(person, 18), 1.4) << "0.3 s after the start";
  EXPECT_LT(head_height(sack, 18), head_height(person, 18));
  EXPECT_LT(head_height(person, 180), 0.8) << "tone goes";
  EXPECT_EQ(person.limits.over_1deg, 0);
  EXPECT_LT(person.figures.energy_gain_max_j, 6.0);
}

TEST(Simulate, TheAimMovesAwayFromAnArmInTheWay) {
  const StandingMan man;
  Scene scene;
  scene.target = Segment::head;
  scene.direction = Vec3::UnitZ();  // from the left
  SimulationSettings settings;
  settings.duration_s = 0.1;
  Diagnostics diagnostics;
  ASSERT_TRUE(simulate_limp(man.body, man.range, man.start(), scene, settings, diagnostics));
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings()[0].what;
  scene.target = Segment::pelvis;  // behind the hanging arm: no way round
  ASSERT_TRUE(simulate_limp(man.body, man.range, man.start(), scene, settings, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("first"), std::string::npos);
}

TEST(Simulate, ASlopeBallRollsIntoTheLegAlongItsRamp) {
  const StandingMan man;
  Scene scene;
  scene.kind = SceneKind::slope;
  scene.target = Segment::shank_l;
  scene.direction = -Vec3::UnitX();
  const auto result = run(man, scene, {});
  ASSERT_EQ(result.trajectory.props.size(), 2u);
  const Prop& ball = result.trajectory.props[0];
  const Prop& ramp = result.trajectory.props[1];
  EXPECT_FALSE(ramp.moves);
  EXPECT_NEAR(ball.poses[0].translation.y(), scene.ball_radius_m, 0.05) << "at the foot of the ramp";
  const Vec3 before = ramp.poses[0].inverse() * ball.poses[0].translation;
  EXPECT_NEAR(before.y(), 0.5 * ramp.size.y() + scene.ball_radius_m, 0.01) << "on the ramp";
  EXPECT_EQ(result.limits.over_1deg, 0);
}

TEST(Simulate, ATippedBodyFallsTheWayItIsTipped) {
  const StandingMan man;
  Scene scene;
  scene.kind = SceneKind::fall;
  scene.direction = Vec3::UnitZ();
  const auto result = run(man, scene, {});
  const BodyPose& last = result.trajectory.frames.back();
  EXPECT_GT(last[index(Segment::head)].translation.z(), 0.5);
  EXPECT_LT(last[index(Segment::head)].translation.y(), 0.5);
  scene.fall_height_m = 1.0;
  EXPECT_NEAR(run(man, scene, {}).trajectory.frames[0][0].translation.y(),
              man.segments[0].translation.y() + 1.0, 1e-9);
}

TEST(Simulate, AFastSmallBallDoesNotPassThroughAForearm) {
  const StandingMan man;
  Scene scene;
  scene.target = Segment::forearm_r;
  scene.direction = -Vec3::UnitX();
  scene.ball_mass_kg = 0.145;
  scene.ball_speed_m_s = 45.0;
  scene.ball_radius_m = 0.037;
  SimulationSettings settings;
  settings.duration_s = 0.05;
  const auto result = run(man, scene, settings);
  const Prop& ball = result.trajectory.props[0];
  const double travelled = ball.poses[0].translation.x() - ball.poses.back().translation.x();
  EXPECT_LT(travelled, 0.6 * 45.0 * 0.05) << "the arm took momentum";
  EXPECT_LT(result.trajectory.frames.back()[index(Segment::hand_r)].translation.x(), -0.02);
}

TEST(Simulate, WhatHitsAFootComesAboveTheFloor) {
  const StandingMan man;
  Scene scene;
  scene.target = Segment::foot_r;
  scene.ball_mass_kg = 9.6;
  scene.ball_radius_m = 0.15;
  SimulationSettings settings;
  settings.duration_s = 0.5;
  for (const SceneKind kind : {SceneKind::ball, SceneKind::box})
    for (const double elevation : {-15.0, 0.0, 15.0}) {
      SCOPED_TRACE(elevation);
      scene.kind = kind;
      scene.direction =
          Vec3(-std::cos(radians(elevation)), -std::sin(radians(elevation)), 0.0);  // from the front
      const auto result = run(man, scene, settings);
      EXPECT_GE(result.trajectory.props[0].poses[0].translation.y(), scene.ball_radius_m);
      EXPECT_LT(result.figures.energy_gain_max_j, 1.0) << "a floor that pushes it out does work";
    }
}

TEST(Simulate, ABlowStraightOutOfTheFloorIsSaid) {
  const StandingMan man;
  Scene scene;
  scene.target = Segment::foot_r;
  SimulationSettings settings;
  settings.duration_s = 0.1;
  for (const double up : {1.0, -1.0}) {
    scene.direction = Vec3(0.0, up, 0.0);
    Diagnostics diagnostics;
    ASSERT_TRUE(simulate_limp(man.body, man.range, man.start(), scene, settings, diagnostics));
    bool said = false;
    for (const Warning& warning : diagnostics.warnings())
      said = said || warning.what.find("out of the floor") != std::string::npos;
    EXPECT_EQ(said, up > 0.0);
  }
}

TEST(Simulate, ABoxSlidesIn) {
  const StandingMan man;
  Scene scene;
  scene.kind = SceneKind::box;
  scene.target = Segment::thigh_l;
  scene.direction = Vec3::UnitZ() * -1.0;
  scene.ball_mass_kg = 30.0;
  scene.ball_radius_m = 0.2;
  SimulationSettings settings;
  settings.duration_s = 0.5;
  const auto result = run(man, scene, settings);
  EXPECT_LT(result.trajectory.frames.back()[0].translation.z(), -0.1);
  EXPECT_EQ(result.limits.over_1deg, 0);
}

TEST(Simulate, AFallenBodyHardlyMovesOnWhereNothingHoldsIt) {
  const StandingMan man;
  SimulationSettings settings;
  settings.duration_s = 6.0;
  settings.stop_at_rest = false;
  for (const Vec3& direction : {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
    Scene scene;
    scene.direction = direction;
    const SimulationFigures figures = run(man, scene, settings).figures;
    EXPECT_LT(figures.jitter_rad_s, 0.02);
    EXPECT_GT(figures.jitter_rad_s, 0.0) << "held after all";
    EXPECT_LT(figures.floor_penetration_end_m, 0.003);
    EXPECT_GT(figures.floor_penetration_end_m, 0.0) << "what rests on soft ground dips into it";
    EXPECT_LT(figures.airborne_mean_s, 0.5);
  }
}

TEST(Simulate, AFallenBodyComesToRestAndIsHeld) {
  const StandingMan man;
  Scene scene;
  scene.direction = -Vec3::UnitX();
  SimulationSettings settings;
  settings.duration_s = 6.0;
  const auto result = run(man, scene, settings);
  ASSERT_TRUE(result.figures.rest_time_s);
  EXPECT_LT(*result.figures.rest_time_s, 6.0);
  EXPECT_EQ(result.trajectory.frames.size(), 361u);
  EXPECT_LT(result.trajectory.frames.back()[index(Segment::head)].translation.y(), 0.5);
}

TEST(Simulate, ARunThatGainsEnergyFromNowhereIsNoResult) {
  // A forearm that is thrown through the singularity of Euler stops.
  const StandingMan man;
  Scene scene;
  scene.target = Segment::forearm_l;
  scene.direction = Vec3(std::cos(22.0), 0.0, std::sin(22.0));
  scene.ball_mass_kg = 10.0;
  scene.ball_speed_m_s = 15.0;
  scene.ball_radius_m = 0.15;
  SimulationSettings settings;
  settings.limits = Limits::segments_euler;
  settings.active = Active::off;
  settings.duration_s = 1.0;
  for (const double rate_hz : {60.0, 120.0}) {
    settings.fixed_hz = rate_hz;
    Diagnostics diagnostics;
    const auto result = simulate_limp(man.body, man.range, man.start(), scene, settings, diagnostics);
    ASSERT_FALSE(result) << result->figures.energy_gain_max_j << " J at " << rate_hz << " Hz";
    EXPECT_NE(result.error().what.find("J of energy without a cause"), std::string::npos)
        << result.error().what;
  }
}

// The last of all, because it takes the longest.
TEST(Simulate, RandomHitsStayInsideTheRange) {
  const StandingMan man;
  long samples = 0;
  for (std::uint64_t seed = 0; seed < kRandomHits; ++seed) {
    const auto result = run(man, random_hit(seed), {});
    samples += result.limits.samples;
    EXPECT_EQ(result.limits.over_1deg, 0) << seed;
    EXPECT_LT(result.limits.excess_max_deg, 1.0) << seed;
    EXPECT_LT(result.limits.excess_projected_max_deg, 0.001) << seed;
    EXPECT_LT(result.figures.joint_separation_max_m, 0.010) << seed;
    EXPECT_LT(result.figures.energy_gain_max_j, 6.0) << seed;
    EXPECT_LT(result.figures.floor_penetration_max_m, 0.012) << seed;
    for (const BodyPose& frame : result.trajectory.frames)
      for (const Rigid& segment : frame) ASSERT_TRUE(segment.translation.allFinite());
  }
  EXPECT_GT(samples, static_cast<long>(kRandomHits) * 17 * 100);
}

}  // namespace
}  // namespace ukemi
