// Every figure that the simulation reports reads what it should: each test knows the value beforehand and
// fails where the figure stays 0 or is twice as large.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/collision.h"
#include "simulate/figures.h"
#include "simulate/hand_on_wrist.h"
#include "support/limp_run.h"

namespace ukemi {
namespace {

constexpr double kStep_s = 1.0 / 240.0;
constexpr double kGravity = 9.81;

/// A hand that turns, on everything else, which stands.
class Meters : public ::testing::Test {
 protected:
  void step(const Contacts& contacts = {}, double work_j = 0.0, double props_j = 0.0) {
    time_s_ += kStep_s;
    recorder_.step(time_s_, kStep_s, contacts, props_j, work_j, hand_.model().separation(hand_.wrist()));
  }
  void move_hand(const Vec3& by) {
    RigidState state = read_state(hand_.hand().id);
    state.position += by;
    write_state(hand_.hand().id, state);
  }
  void throw_hand(double m_s) {
    RigidState state = read_state(hand_.hand().id);
    state.linear_velocity = Vec3(m_s, 0.0, 0.0);
    write_state(hand_.hand().id, state);
  }
  SimulationFigures figures() const { return recorder_.figures(); }

  static constexpr double kSpin = 3.0;  // rad/s
  test::HandOnWrist hand_{Vec3(0.0, 0.0, kSpin)};
  Recorder recorder_{hand_.model(), kGravity};
  double time_s_ = 0.0;
};

TEST_F(Meters, SeparationOfAJointPulledFiveMillimetresApart) {
  step();
  EXPECT_NEAR(figures().joint_separation_max_m, 0.0, 1e-9);
  move_hand({0.0, 0.003, 0.004});
  step();
  move_hand({0.0, -0.003, -0.004});
  step();
  EXPECT_NEAR(figures().joint_separation_max_m, 0.005, 1e-9);
}

TEST_F(Meters, EnergyThatComesFromNowhere) {
  step();
  throw_hand(std::sqrt(2.0 * 3.0 / hand_.hand().mass_kg));
  step();
  EXPECT_NEAR(figures().energy_gain_max_j, 3.0, 0.02);  // beside bodies of 1e9 times the mass
}

TEST_F(Meters, EnergyWithACauseIsNone) {
  step();
  throw_hand(std::sqrt(2.0 * 3.0 / hand_.hand().mass_kg));
  step({}, 2.0, 1.0 - 3.0);  // 2 J of muscles; a prop that was given -3 J of the scene's and lost 1 J
  EXPECT_LT(figures().energy_gain_max_j, 1e-6);
}

TEST_F(Meters, EnergyOfHeight) {
  step();
  move_hand({0.0, 0.1, 0.0});
  step();
  EXPECT_NEAR(figures().energy_gain_max_j, hand_.hand().mass_kg * kGravity * 0.1, 0.005);
}

TEST_F(Meters, DepthsAreTheLargestAndTheLast) {
  Contacts contacts;
  contacts.floor_penetration = 0.020;
  contacts.self_penetration = 0.015;
  step(contacts);
  contacts.floor_penetration = 0.004;
  contacts.self_penetration = 0.0;
  step(contacts);
  EXPECT_DOUBLE_EQ(figures().floor_penetration_max_m, 0.020);
  EXPECT_DOUBLE_EQ(figures().floor_penetration_end_m, 0.004);
  EXPECT_DOUBLE_EQ(figures().self_penetration_max_m, 0.015);
}

TEST_F(Meters, TimeInTheAir) {
  Contacts ground;
  ground.ground = true;
  for (int i = 0; i < 10; ++i) step(i < 6 ? ground : Contacts{});
  EXPECT_NEAR(figures().airborne_mean_s, 4.0 * kStep_s, 1e-12);
}

TEST_F(Meters, TurningOfOneOfTwoBodies) {
  for (int i = 0; i < 10; ++i) step();
  EXPECT_NEAR(figures().turning_mean_rad_s, kSpin / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(figures().jitter_rad_s, kSpin / std::sqrt(2.0), 1e-9);
}

TEST_F(Meters, JitterIsThatOfTheLastHalfSecond) {
  for (int i = 0; i < 240; ++i) step();
  RigidState state = read_state(hand_.hand().id);
  state.angular_velocity.setZero();
  write_state(hand_.hand().id, state);
  for (int i = 0; i < 240; ++i) step();
  EXPECT_NEAR(figures().jitter_rad_s, 0.0, 1e-9);
  EXPECT_NEAR(figures().turning_mean_rad_s, kSpin / std::sqrt(2.0), 1e-9);  // of the first second
}

TEST_F(Meters, AngularMomentumAboutTheCentre) {
  const Vec3 spin(0.0, 0.0, kSpin);
  const Quat rotation = read_state(hand_.hand().id).rotation;
  const double expected = (rotation * (hand_.hand().inertia * (rotation.conjugate() * spin))).norm();
  ASSERT_GT(expected, 1e-4);
  const double momentum = angular_momentum_about_centre(hand_.model().bodies()).norm();
  // The hand's centre moves where it turns about the wrist: its share is m r^2 at most.
  EXPECT_GE(momentum, 0.999 * expected);
  step();
  EXPECT_NEAR(figures().angular_momentum_mean_kg_m2_s, momentum, 1e-9);
}

TEST_F(Meters, ExcessesOfJoints) {
  std::vector<double> excess(hand_.model().joints().size(), 0.0);
  ASSERT_EQ(excess.size(), 1u);
  for (int i = 1; i <= 10000; ++i) {
    excess[0] = i > 9950 ? radians(0.1 * (i - 9950)) : 0.0;  // 50 samples: 0.1 to 5 degrees
    recorder_.excess_of_step(excess, i == 9960 ? radians(0.3) : 0.0);
  }
  const LimitFigures limits = recorder_.limits(true);
  EXPECT_EQ(limits.samples, 10000);
  EXPECT_EQ(limits.over_1deg, 40);
  EXPECT_NEAR(limits.excess_max_deg, 5.0, 1e-9);
  EXPECT_NEAR(limits.excess_p999_deg, 4.0, 1e-9);  // 10 samples are larger
  EXPECT_NEAR(limits.excess_projected_max_deg, 0.3, 1e-9);
  EXPECT_EQ(limits.worst_joint, Joint::wrist_r);
  EXPECT_EQ(recorder_.excesses().size(), 50u);
}

TEST_F(Meters, FirstTouchesWithTheirSpeeds) {
  Senses senses;
  const auto touches = [&senses](Segment segment) {
    SegmentContact contact;
    contact.segment = segment;
    contact.place = senses.centre[index(segment)];
    senses.contacts.push_back(contact);
  };
  touches(Segment::foot_l);
  recorder_.touches(senses);  // it stands
  senses.time_s = 0.5;
  senses.velocity[index(Segment::hand_r)] = Vec3(1.0, -2.0, 0.0);
  recorder_.touches(senses);
  senses.time_s = 0.6;
  senses.velocity[index(Segment::hand_r)] = Vec3::Zero();  // the floor has stopped it
  touches(Segment::hand_r);
  recorder_.touches(senses);
  const SimulationFigures read = figures();
  EXPECT_FALSE(read.touch_down[index(Segment::foot_l)]);
  ASSERT_TRUE(read.touch_down[index(Segment::hand_r)]);
  EXPECT_DOUBLE_EQ(read.touch_down[index(Segment::hand_r)]->time_s, 0.6);
  EXPECT_DOUBLE_EQ(read.touch_down[index(Segment::hand_r)]->speed_m_s, 2.0);
  ASSERT_TRUE(read.first_ground_contact_s);
  EXPECT_DOUBLE_EQ(*read.first_ground_contact_s, 0.6);
}

TEST_F(Meters, WhatABlowGaveWhileItLasted) {
  recorder_.delivered(0.1, 7.0);
  recorder_.delivered(0.2, 12.0);
  recorder_.delivered(2.0, 30.0);  // rolled against later
  EXPECT_DOUBLE_EQ(figures().delivered_n_s, 12.0);
}

TEST_F(Meters, MusclesAndHelp) {
  recorder_.muscles(0.4, 30.0);
  recorder_.muscles(0.2, 50.0);
  recorder_.help(7.0);
  recorder_.help(12.0);
  EXPECT_DOUBLE_EQ(figures().muscle_share_max, 0.4);
  EXPECT_DOUBLE_EQ(figures().muscle_work_j, 50.0);
  EXPECT_DOUBLE_EQ(figures().help_n_s, 12.0);
}

TEST_F(Meters, StepsThatCountAndStepsThatWereTakenBack) {
  for (int i = 0; i < 5; ++i) step();
  for (int i = 0; i < 3; ++i) recorder_.rejected();
  EXPECT_EQ(figures().steps, 5);
  EXPECT_EQ(figures().rejected_steps, 3);
}

/// Contacts of a man moved by a segment's shift from his stand.
Contacts contacts_of(const test::StandingMan& man, const BodyPose& pose) {
  OdeWorld world;
  Model model(world, man.body, man.range);
  Collision collision(world, model, man.body, true);
  PerSegment<Vec3> still;
  still.fill(Vec3::Zero());
  model.place(pose, still, still);
  return collision.find();
}

TEST(Depth, OfFeetInTheFloor) {
  const test::StandingMan man;
  BodyPose pose = man.segments;
  for (Rigid& segment : pose) segment.translation.y() -= 0.01;
  const double before = contacts_of(man, pose).floor_penetration;
  ASSERT_GT(before, 0.0);
  for (Rigid& segment : pose) segment.translation.y() -= 0.03;
  EXPECT_NEAR(contacts_of(man, pose).floor_penetration, before + 0.03, 1e-9);
  EXPECT_TRUE(contacts_of(man, pose).ground);
  for (Rigid& segment : pose) segment.translation.y() += 0.2;
  EXPECT_FALSE(contacts_of(man, pose).ground);
}

TEST(Depth, AFootThatHasComeOutOfTheFloorMeetsItAgain) {
  const test::StandingMan man;
  OdeWorld world;
  Model model(world, man.body, man.range);
  Collision collision(world, model, man.body, true);
  PerSegment<Vec3> still;
  still.fill(Vec3::Zero());
  const auto at = [&](double down_m) {
    BodyPose pose = man.segments;
    for (Rigid& segment : pose) segment.translation.y() -= down_m;
    model.place(pose, still, still);
    return collision.find();
  };
  at(0.05);
  collision.accept_overlaps();
  EXPECT_EQ(at(0.05).floor_penetration, 0.0);
  EXPECT_NEAR(at(0.06).floor_penetration, 0.01, 1e-9);
  collision.forget_overlaps(at(0.02));
  EXPECT_NEAR(at(0.06).floor_penetration, 0.04, 1e-9);
  collision.forget_overlaps(at(-0.5));
  EXPECT_NEAR(at(0.06).floor_penetration - at(0.02).floor_penetration, 0.04, 1e-9);
  EXPECT_GT(at(0.02).floor_penetration, 0.0);
}

TEST(Depth, OfAHandInTheBelly) {
  const test::StandingMan man;
  const Shape& belly = man.body.segments[index(Segment::abdomen)].shapes.front();
  const Shape& hand = man.body.segments[index(Segment::hand_l)].shapes.front();
  BodyPose pose = man.segments;
  const Rigid world_from_belly = pose[index(Segment::abdomen)] * belly.segment_from_shape;
  // The hand's capsule stands upright before the belly's, which lies across.
  const double apart = belly.radius + hand.radius - 0.02;
  const Vec3 wanted = world_from_belly.translation + Vec3(apart, 0.0, 0.0);
  Rigid& at = pose[index(Segment::hand_l)];
  at.translation += wanted - (at * hand.segment_from_shape).translation;
  const double before = contacts_of(man, man.segments).self_penetration;
  ASSERT_LT(before, 0.019);
  EXPECT_NEAR(contacts_of(man, pose).self_penetration, 0.02, 1e-6);
}

/// A body that hangs in the air without weight, given a blow.
SimulationResult adrift(Scene scene) {
  test::StandingMan man;
  for (Rigid& segment : man.segments) segment.translation.y() += 5.0;
  SimulationSettings settings;
  settings.gravity = 0.0;
  settings.duration_s = 0.4;
  settings.tone = 0.0;
  settings.stop_at_rest = false;
  scene.direction = Vec3::UnitX();
  return test::run(man, scene, settings);
}

TEST(Blow, GivesWhatItSays) {
  Scene scene;
  scene.kind = SceneKind::impulse;
  scene.impulse_n_s = 25.0;
  EXPECT_NEAR(adrift(scene).figures.momentum_n_s, 25.0, 1e-9);
  EXPECT_NEAR(adrift(scene).figures.delivered_n_s, 25.0, 1e-9);
  scene.kind = SceneKind::push;
  scene.push_force_n = 150.0;
  scene.push_duration_s = 0.2;
  EXPECT_NEAR(adrift(scene).figures.momentum_n_s, 30.0, 1e-9);
  EXPECT_NEAR(adrift(scene).figures.delivered_n_s, 30.0, 0.7);  // whole steps
}

TEST(Blow, WorkOfAPushIsNoEnergyFromNowhere) {
  Scene scene;
  scene.kind = SceneKind::push;
  scene.push_force_n = 500.0;
  scene.push_duration_s = 0.2;
  const SimulationResult run = adrift(scene);
  // A body of 78 kg that has got 100 N s moves with at least 64 J.
  EXPECT_LT(run.figures.energy_gain_max_j, 3.0);
}

}  // namespace
}  // namespace ukemi
