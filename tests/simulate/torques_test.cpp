// What tone, muscles and damping give, seen on what it does: torque = inertia times change of speed.
#include <ode/ode.h>

#include <functional>

#include "body/muscles.h"
#include "physics/muscles.h"
#include "physics/physics.h"
#include "physics/restriction.h"
#include "simulate/hand_on_wrist.h"

namespace ukemi {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

/// A hand that turns about its centre alone.
std::function<void(BodySegment&)> balanced(double inertia) {
  return [inertia](BodySegment& hand) {
    hand.mass_kg = 0.4;
    hand.inertia = inertia * Mat3::Identity();
    hand.centre_of_mass.setZero();
  };
}

double speed_of(const test::HandOnWrist& hand) { return vec3(dBodyGetAngularVel(hand.hand().id)).norm(); }

/// Torque of tone on a heavy hand that rests `error_rad` from its goal.
double torque_of_tone(double error_rad, double cap_n_m) {
  constexpr double kHeavy = 50.0;  // kg m^2: hardly turns in the step
  test::HandOnWrist hand(Vec3::Zero(), balanced(kHeavy));
  Tone tone(hand.world(), hand.model(), hand.wrist());
  tone.prepare(kStep_s, SoftGoal{exp_rotation(Vec3(0.0, 0.0, error_rad)), cap_n_m});
  dWorldStep(hand.world().id(), kStep_s);
  return kHeavy * speed_of(hand) / kStep_s;
}

TEST(Tone, IsASpringWhoseTorqueStaysBelowItsCap) {
  EXPECT_NEAR(torque_of_tone(0.07, 5.0), 5.0 * 0.07 / 0.35, 0.01);
  EXPECT_NEAR(torque_of_tone(0.14, 5.0), 5.0 * 0.14 / 0.35, 0.01);
  EXPECT_NEAR(torque_of_tone(0.7, 5.0), 5.0, 0.05) << "a linear spring gives 10";
  EXPECT_NEAR(torque_of_tone(1.4, 5.0), 5.0, 0.05);
}

TEST(Tone, WorkIsTheEnergyThatTheHandGets) {
  constexpr double kLight = 0.05;
  test::HandOnWrist hand(Vec3::Zero(), balanced(kLight));
  Tone tone(hand.world(), hand.model(), hand.wrist());
  double work = 0.0;
  for (int i = 0; i < 10; ++i) {
    tone.prepare(kStep_s, SoftGoal{exp_rotation(Vec3(0.0, 0.0, 0.5)), 5.0});
    dWorldStep(hand.world().id(), kStep_s);
    work += tone.work(kStep_s);
  }
  const double energy = 0.5 * kLight * speed_of(hand) * speed_of(hand);
  ASSERT_GT(energy, 0.05);
  EXPECT_NEAR(work, energy, 0.001 * energy);
}

TEST(Damping, IsByTheLighterOfTheTwoBodies) {
  constexpr double k = 10.0;
  test::HandOnWrist hand(Vec3(0.0, 0.0, 9.0), balanced(0.05));
  double expected = 9.0;
  for (int i = 0; i < 10; ++i) {
    apply_damping(hand.model(), hand.wrist(), k);
    dWorldStep(hand.world().id(), kStep_s);
    expected *= 1.0 - k * kStep_s;
    EXPECT_NEAR(speed_of(hand), expected, 1e-5);
  }
}

double energy_of(const Physics& physics) {
  double energy = 0.0;
  for (const ModelBody& body : physics.model().bodies())
    energy += kinetic_energy(body.mass_kg, body.inertia, read_state(body.id));
  return energy;
}

TEST(Muscles, WorkIsTheEnergyThatTheBodyGets) {
  const test::StandingMan man;
  const auto strength = muscle_strength(man.body, Sex::male, 1.0);
  ASSERT_TRUE(strength);
  Scene scene;
  scene.kind = SceneKind::none;
  scene.direction = Vec3::UnitX();
  PhysicsSettings settings;
  settings.gravity = 0.0;
  settings.active = Active::off;
  Physics physics(man.body, man.range, *load_active_thresholds(""), *strength, man.start(), scene, settings);
  JointGoal pull;
  pull.feed_forward_n_m = Vec3(0.0, 0.0, 20.0);
  pull.least_n_m.setConstant(-1e6);
  pull.most_n_m.setConstant(1e6);
  Goals asked;
  asked.joints[index(Joint::hip_r)] = {pull};
  double work = 0.0;
  for (int i = 0; i < 8; ++i) {
    physics.save();
    physics.step(i * kStep_s, kStep_s, asked, {});
    work += physics.accept(i * kStep_s, kStep_s);
  }
  ASSERT_GT(energy_of(physics), 0.5);
  EXPECT_NEAR(work, energy_of(physics), 0.03 * energy_of(physics));
  EXPECT_NEAR(physics.muscle_work_j(), work, 1e-9);
}

TEST(Physics, WorkOfAPushIsTheEnergyThatTheBodyGets) {
  const test::StandingMan man;
  Scene scene;
  scene.kind = SceneKind::push;
  scene.direction = Vec3::UnitX();
  scene.loads = {{Segment::hand_r, Vec3::UnitX()}};
  scene.push_force_n = 60.0;
  PhysicsSettings settings;
  settings.gravity = 0.0;
  settings.active = Active::off;
  Physics physics(man.body, man.range, *load_active_thresholds(""), MuscleStrength{}, man.start(), scene,
                  settings);
  double work = 0.0;
  for (int i = 0; i < 4; ++i) {
    physics.save();
    physics.step(i * kStep_s, kStep_s, {}, {});
    work += physics.accept(i * kStep_s, kStep_s);
  }
  ASSERT_GT(energy_of(physics), 0.5);
  EXPECT_NEAR(work, energy_of(physics), 0.03 * energy_of(physics));
}

/// Way of the right foot of a man who stands and moves forward at 1 m/s as a whole, in 25 ms.
double way_of_a_foot(const Goals& goals) {
  const test::StandingMan man;
  StartState start = man.start();
  for (Rigid& segment : start.segments) segment.translation.y() -= 0.002;  // on the floor
  start.linear_velocity.fill(Vec3::UnitX());
  Physics physics(man.body, man.range, *load_active_thresholds(""), MuscleStrength{}, start, Scene{}, {});
  const double from = physics.segments()[index(Segment::foot_r)].translation.x();
  for (int i = 0; i * kStep_s < 0.025; ++i) {
    physics.save();
    physics.step(i * kStep_s, kStep_s, goals, physics.find_contacts());
    physics.accept(i * kStep_s, kStep_s);
  }
  return physics.segments()[index(Segment::foot_r)].translation.x() - from;
}

TEST(Physics, AFootThatSwingsGlidesOverTheFloorAndAFirmOneDoesNot) {
  Goals stands, swings;
  stands.firm_soles = swings.firm_soles = true;
  swings.glides[index(Segment::foot_r)] = true;
  EXPECT_LT(way_of_a_foot(stands), 0.005);
  EXPECT_GT(way_of_a_foot(swings), 0.015);
}

TEST(Physics, PutsWhatHitsBackWithTheBody) {
  test::StandingMan man;
  Scene scene;
  scene.kind = SceneKind::ball;
  scene.target = Segment::chest;
  scene.direction = -Vec3::UnitX();
  Physics physics(man.body, man.range, *load_active_thresholds(""), MuscleStrength{}, man.start(), scene, {});
  Diagnostics diagnostics;
  physics.begin(diagnostics);
  const Rigid before = physics.prop_poses().at(0);
  physics.save();
  physics.step(0.0, kStep_s, {}, physics.find_contacts());
  EXPECT_GT((physics.prop_poses()[0].translation - before.translation).norm(), 0.005);
  physics.restore();
  EXPECT_LT((physics.prop_poses()[0].translation - before.translation).norm(), 1e-12);
  EXPECT_GT(physics.scene().prop_energy(),
            0.4 * scene.ball_mass_kg * scene.ball_speed_m_s * scene.ball_speed_m_s)
      << "as fast as it came";
}

TEST(Ramp, IsAsLongAsTheBallNeedsFromRestUpToThreeMetres) {
  const auto length = [](double speed_m_s, double slope_deg) {
    Scene scene;
    scene.kind = SceneKind::slope;
    scene.target = Segment::shank_l;
    scene.direction = -Vec3::UnitX();
    scene.ball_speed_m_s = speed_m_s;
    scene.slope_rad = radians(slope_deg);
    SimulationSettings settings;
    settings.duration_s = 0.02;
    return test::run(test::StandingMan(), scene, settings).trajectory.props.at(1).size.x();
  };
  // v^2 = 10/7 g height.
  EXPECT_NEAR(length(3.0, 20.0), 0.7 * 9.0 / 9.81 / std::sin(radians(20.0)), 1e-9);
  EXPECT_NEAR(length(9.0, 20.0), 3.0, 1e-9);
}

}  // namespace
}  // namespace ukemi
