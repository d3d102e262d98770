#include "behave/fall.h"

#include <gtest/gtest.h>

#include "behave/fallen_man.h"

namespace ukemi {
namespace {

using test::Faller;
using test::mirrored;

/// Tipped by `angle` towards `azimuth` (0: to the front, 90: to the right) and moving that way.
Senses tipped(const Faller& faller, double angle, double azimuth, double speed, double time_s = 0.0) {
  const Vec3 way(std::cos(radians(azimuth)), 0.0, std::sin(radians(azimuth)));
  return faller.senses(angle * Vec3::UnitY().cross(way), speed * way - 0.8 * Vec3::UnitY(), time_s);
}

FallWay way_of(const FallBody& body, const Senses& senses) {
  FallDirection direction;
  direction.update(body, senses, 0.0);
  return direction.way();
}

PerJoint<double> at_once(double time_s) {
  PerJoint<double> times;
  times.fill(time_s);
  return times;
}

/// Goals after half a second of the same senses.
Goals goals_after(Falling& falling, const Senses& start, double span_s = 0.5) {
  Senses senses = start;
  falling.start(senses);
  falling.begin(senses, at_once(senses.time_s));
  for (; senses.time_s < start.time_s + span_s; senses.time_s += 0.01) falling.observe(senses, 0.01);
  Goals goals;
  falling.drive(senses.time_s, goals);
  return goals;
}

TEST(FallDirection, is_the_side_that_goes_down) {
  const Faller faller;
  const FallBody body = faller.body();
  const FallWay front = way_of(body, tipped(faller, 0.4, 0.0, 1.0));
  EXPECT_NEAR(front.forward, 1.0, 1e-6);
  EXPECT_GT(front.along.x(), 0.99);
  const FallWay back = way_of(body, tipped(faller, 0.4, 180.0, 1.0));
  EXPECT_NEAR(back.backward, 1.0, 1e-6);
  EXPECT_GT(back.beyond_m, 0.1);
  const FallWay right = way_of(body, tipped(faller, 0.4, 90.0, 1.0));
  EXPECT_GT(right.sideways, 0.99);
  EXPECT_EQ(right.side, 1.0);
  EXPECT_EQ(way_of(body, tipped(faller, 0.4, -90.0, 1.0)).side, -1.0);
}

TEST(FallDirection, weights_sum_to_one_all_round) {
  const Faller faller;
  const FallBody body = faller.body();
  for (int azimuth = 0; azimuth < 360; azimuth += 15) {
    const FallWay way = way_of(body, tipped(faller, 0.3, azimuth, 1.0));
    EXPECT_NEAR(way.forward + way.backward + way.sideways, 1.0, 1e-9);
    EXPECT_NEAR(way.along.norm(), 1.0, 1e-9);
  }
}

TEST(FallDirection, keeps_its_way_once_something_but_a_foot_is_down) {
  const Faller faller;
  const FallBody body = faller.body();
  FallDirection direction;
  direction.update(body, tipped(faller, 0.4, 0.0, 1.0), 0.01);
  Senses senses = tipped(faller, 0.4, 180.0, 2.0);
  senses.contacts.push_back(test::touches_floor(senses, Segment::hand_l));
  direction.update(body, senses, 0.01);
  EXPECT_GT(direction.way().along.x(), 0.99);
}

TEST(FallArms, reach_where_they_are_told_to) {
  const Faller faller;
  const FallBody body = faller.body();
  const Senses senses = tipped(faller, 0.9, 20.0, 2.0);
  for (const BodySide side : kSides) {
    const int upper = index(on(side, Segment::upperarm_r));
    HandTarget target;
    target.wrist = senses.pose[upper].translation + Vec3(0.25, -0.3, 0.1 * sign(side));
    target.elbow_way = Vec3(0.0, 0.2, sign(side));
    const ArmPose pose = arm_reaching(body, senses, target, side);
    const Rigid clavicle = senses.pose[index(on(side, Segment::clavicle_r))];
    const Quat upper_arm = clavicle.rotation * pose.shoulder;
    const Quat forearm = upper_arm * pose.elbow;
    const Vec3 elbow =
        senses.pose[upper].translation + upper_arm * body.anchor[index(on(side, Joint::elbow_r))];
    const Vec3 wrist = elbow + forearm * body.anchor[index(on(side, Joint::wrist_r))];
    // The bones are not quite along the segments' axes.
    EXPECT_LT((wrist - target.wrist).norm(), 0.05) << name(on(side, Segment::hand_r));
    EXPECT_GT((elbow - senses.pose[upper].translation).dot(target.elbow_way), 0.0);
  }
}

TEST(FallArms, are_never_straight_and_land_ahead_of_the_shoulder) {
  const Faller faller;
  const FallBody body = faller.body();
  const Senses senses = tipped(faller, 1.0, 0.0, 2.0);
  const FallWay way = way_of(body, senses);
  const HandTarget place = landing_place(body, senses, way, {}, BodySide::right);
  const Vec3 shoulder = senses.pose[index(Segment::upperarm_r)].translation;
  EXPECT_GT(place.wrist.x() - shoulder.x(), 0.15);
  HandTarget far = place;
  far.wrist = shoulder - 5.0 * Vec3::UnitY();
  const ArmPose pose = arm_reaching(body, senses, far, BodySide::right);
  EXPECT_GT(log_rotation(pose.elbow).norm(), radians(30.0));
}

TEST(Falling, asks_for_nothing_before_it_begins) {
  const Faller faller;
  Falling falling({}, faller.man.body, faller.man.range, faller.strength);
  const Senses senses = tipped(faller, 0.2, 0.0, 1.0);
  falling.start(senses);
  falling.watch(senses, 0.01);
  Goals goals;
  falling.drive(senses.time_s, goals);
  for (const auto& joint : goals.joints) EXPECT_TRUE(joint.empty());
  EXPECT_TRUE(falling.done());
}

TEST(Falling, goals_lie_inside_the_range) {
  const Faller faller;
  for (int azimuth = 0; azimuth < 360; azimuth += 30) {
    Falling falling({}, faller.man.body, faller.man.range, faller.strength);
    const Goals goals = goals_after(falling, tipped(faller, 0.7, azimuth, 1.5));
    for (int j = 0; j < kJointCount; ++j) {
      ASSERT_EQ(goals.joints[j].size(), 1u) << name(joint_at(j));
      const JointRange& range = faller.man.range.joints[j];
      const Quat joint = range.frame.joint_from_relative(goals.joints[j][0].parent_from_child);
      EXPECT_LT(degrees(excess(range, swing_twist(joint))), 0.5) << name(joint_at(j)) << " at " << azimuth;
    }
  }
}

TEST(Falling, stays_within_what_the_joints_can_give) {
  const Faller faller;
  Falling falling({}, faller.man.body, faller.man.range, faller.strength);
  const Goals goals = goals_after(falling, tipped(faller, 0.7, 180.0, 1.5));
  for (int j = 0; j < kJointCount; ++j)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(goals.joints[j][0].most_n_m[axis], faller.strength[j].most_n_m[axis]);
      EXPECT_GE(goals.joints[j][0].least_n_m[axis], faller.strength[j].least_n_m[axis]);
    }
}

/// What differs by seed, without it.
TEST(Crouch, of_a_mirrored_fall_is_mirrored) {
  const Faller faller;
  const FallBody body = faller.body();
  FallVariation none;
  none.leg_bend = 0.0;
  for (int azimuth = 0; azimuth < 360; azimuth += 45) {
    const Senses senses = tipped(faller, 0.5, azimuth + 10, 1.2);
    PerJoint<Quat> here;
    PerJoint<Quat> there;
    crouch(way_of(body, senses), none, body.lambda, 0.0, here);
    crouch(way_of(body, mirrored(senses)), none, body.lambda, 0.0, there);
    for (int j = 0; j < kJointCount; ++j) {
      if (is_left(joint_at(j)) ||
          (j >= index(Joint::clavicle_r) && j <= index(Joint::wrist_r) && j != index(Joint::clavicle_r)))
        continue;
      const Quat other = mirrored(there[index(mirror_of(joint_at(j)))]);
      EXPECT_LT(angle_between(here[j], other), 1e-6) << name(joint_at(j)) << " at " << azimuth;
    }
  }
}

TEST(Dive, is_a_level_trunk_over_knees_that_are_up) {
  const Faller faller;
  const FallBody body = faller.body();
  const auto dive_at = [&](double angle, double azimuth, double height) {
    Senses senses = tipped(faller, angle, azimuth, 2.0);
    for (Rigid& segment : senses.pose) segment.translation.y() += height;
    return dive(body, senses, way_of(body, senses));
  };
  EXPECT_EQ(dive_at(0.3, 0.0, 0.0), 0.0);              // still upright
  EXPECT_GT(dive_at(radians(85.0), 0.0, 0.4), 0.99);   // level, all of it in the air
  EXPECT_EQ(dive_at(radians(85.0), 0.0, 0.0), 0.0);    // level, and the knees are down
  EXPECT_EQ(dive_at(radians(85.0), 180.0, 0.4), 0.0);  // on to the back
}

TEST(Crouch, of_a_dive_has_straight_hips) {
  const Faller faller;
  const FallBody body = faller.body();
  const FallWay way = way_of(body, tipped(faller, 0.8, 0.0, 2.0));
  PerJoint<Quat> goals;
  crouch(way, {}, body.lambda, 1.0, goals);
  EXPECT_LT(log_rotation(goals[index(Joint::hip_l)]).z(), radians(1.0));
  crouch(way, {}, body.lambda, 0.0, goals);
  EXPECT_GT(log_rotation(goals[index(Joint::hip_l)]).z(), radians(20.0));
}

TEST(Falling, brakes_with_the_legs_to_the_side_more_than_to_the_front) {
  const Faller faller;
  const auto stiffness = [&](double azimuth) {
    Falling falling({}, faller.man.body, faller.man.range, faller.strength);
    const Goals goals = goals_after(falling, tipped(faller, 0.5, azimuth, 1.5));
    return goals.joints[index(Joint::knee_r)][0].stiffness_n_m_rad;
  };
  EXPECT_GT(stiffness(90.0), 2.0 * stiffness(0.0));
}

/// From its start on; what it senses may be changed on the way.
struct ForwardFall {
  Faller faller;
  Falling falling{{}, faller.man.body, faller.man.range, faller.strength};
  Senses senses = tipped(faller, 0.7, 0.0, 1.5);

  ForwardFall() {
    falling.start(senses);
    falling.begin(senses, at_once(0.0));
  }
  Goals after(double until_s) {
    for (; senses.time_s < until_s; senses.time_s += 0.01) falling.observe(senses, 0.01);
    Goals goals;
    falling.drive(senses.time_s, goals);
    return goals;
  }
};

TEST(Falling, over_the_knees_stretches_the_hips_and_lets_the_knees_go) {
  ForwardFall fall;
  const Goals before = fall.after(0.4);
  fall.senses.contacts.push_back(test::touches_floor(fall.senses, Segment::shank_l));
  const Goals kneeling = fall.after(0.7);
  const auto hip = [](const Goals& goals) {
    return log_rotation(goals.joints[index(Joint::hip_l)][0].parent_from_child).z();
  };
  const auto knee = [](const Goals& goals) {
    return goals.joints[index(Joint::knee_l)][0].stiffness_n_m_rad;
  };
  EXPECT_GT(hip(before), radians(20.0));
  EXPECT_LT(hip(kneeling), 0.0);
  EXPECT_LT(knee(kneeling), 0.2 * knee(before));
}

TEST(Falling, lays_its_arms_down_within_six_tenths_of_a_second_on_the_belly) {
  ForwardFall fall;
  const auto shoulder_at = [&](double until_s) {
    return fall.after(until_s).joints[index(Joint::shoulder_l)][0].parent_from_child;
  };
  shoulder_at(0.4);
  fall.senses.contacts.push_back(test::touches_floor(fall.senses, Segment::chest));
  const Quat landing = shoulder_at(0.42), soon = shoulder_at(1.0), at_last = shoulder_at(2.0);
  EXPECT_GT(angle_between(landing, at_last), radians(20.0));
  EXPECT_LT(angle_between(soon, at_last), radians(2.0));
}

TEST(ArmLanding, brakes_what_sinks_and_yields_to_what_hardly_does) {
  const Faller faller;
  const FallBody body = faller.body();
  Senses senses = tipped(faller, 1.2, 0.0, 1.0);
  const FallWay way = way_of(body, senses);
  Landing landing;
  senses.contacts.push_back(test::touches_floor(senses, Segment::hand_r));
  const auto brake_at = [&](double sink) {
    senses.velocity[index(Segment::upperarm_r)] = Vec3(0.0, -sink, 0.0);
    for (int i = 0; i < 40; ++i) {
      senses.time_s += 0.01;
      landing.observe(body, senses, way, 0.01);
    }
    return landing.arm(BodySide::right).brake;
  };
  EXPECT_GT(brake_at(1.5), 0.99);
  EXPECT_LT(brake_at(0.3), 0.01);
  EXPECT_GT(brake_at(1.5), 0.9);
}

TEST(LandingPlace, of_a_mirrored_fall_is_mirrored) {
  const Faller faller;
  const FallBody body = faller.body();
  for (int azimuth = 0; azimuth < 360; azimuth += 45) {
    const Senses senses = tipped(faller, 0.6, azimuth + 10, 1.2);
    const HandTarget here = landing_place(body, senses, way_of(body, senses), {}, BodySide::right);
    const HandTarget there =
        landing_place(body, mirrored(senses), way_of(body, mirrored(senses)), {}, BodySide::left);
    EXPECT_LT((here.wrist - mirrored(there.wrist)).norm(), 1e-6) << azimuth;
    EXPECT_LT((here.elbow_way - mirrored(there.elbow_way)).norm(), 1e-6) << azimuth;
  }
}

TEST(Falling, two_seeds_fall_differently_and_one_seed_alike) {
  const Faller faller;
  const auto knees = [&](std::uint64_t seed) {
    FallSettings settings;
    settings.seed = seed;
    Falling falling(settings, faller.man.body, faller.man.range, faller.strength);
    const Goals goals = goals_after(falling, tipped(faller, 0.7, 180.0, 1.5));
    return std::pair(goals.joints[index(Joint::knee_l)][0].parent_from_child,
                     goals.joints[index(Joint::knee_r)][0].parent_from_child);
  };
  EXPECT_EQ(angle_between(knees(1).first, knees(1).first), 0.0);
  EXPECT_GT(angle_between(knees(1).first, knees(4).first), radians(0.5));
  EXPECT_GT(angle_between(knees(1).first, knees(1).second), radians(4.0));
}

TEST(Falling, changes_its_state_in_observe_alone) {
  const Faller faller;
  Falling falling({}, faller.man.body, faller.man.range, faller.strength);
  goals_after(falling, tipped(faller, 0.7, 45.0, 1.5));
  Goals once;
  Goals twice;
  falling.drive(0.5, once);
  falling.drive(0.5, twice);
  falling.drive(0.7, twice);  // and not by looking ahead
  twice.clear();
  falling.drive(0.5, twice);
  for (int j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(once.joints[j][0].parent_from_child.coeffs(), twice.joints[j][0].parent_from_child.coeffs());
    EXPECT_EQ(once.joints[j][0].stiffness_n_m_rad, twice.joints[j][0].stiffness_n_m_rad);
  }
}

TEST(Falling, fades_in_joint_by_joint) {
  const Faller faller;
  Falling falling({}, faller.man.body, faller.man.range, faller.strength);
  const Senses senses = tipped(faller, 0.3, 180.0, 1.0, 1.0);
  falling.start(senses);
  PerJoint<double> times = at_once(1.0);
  times[index(Joint::knee_l)] = std::numeric_limits<double>::infinity();
  falling.begin(senses, times);
  EXPECT_EQ(falling.faded(Joint::neck, 1.0), 0.0);
  EXPECT_NEAR(falling.faded(Joint::neck, 1.05), 0.5, 1e-9);
  EXPECT_EQ(falling.faded(Joint::neck, 1.1), 1.0);
  EXPECT_EQ(falling.faded(Joint::knee_l, 2.0), 0.0);
  falling.fade_in(Joint::knee_l, 2.0);
  EXPECT_NEAR(falling.faded(Joint::knee_l, 2.05), 0.5, 1e-9);
}

TEST(Falling, notes_what_touches_first_and_how_fast) {
  const Faller faller;
  Falling falling({}, faller.man.body, faller.man.range, faller.strength);
  Senses senses = tipped(faller, 1.2, 0.0, 1.0, 0.4);
  falling.start(senses);
  falling.begin(senses, at_once(0.4));
  senses.velocity[index(Segment::hand_r)] = Vec3(0.0, -3.0, 0.0);
  senses.time_s = 0.5;
  falling.observe(senses, 0.01);
  senses.time_s = 0.51;
  senses.velocity[index(Segment::hand_r)] = Vec3::Zero();  // stopped by the floor: the state before counts
  senses.contacts.push_back(test::touches_floor(senses, Segment::hand_r));
  falling.observe(senses, 0.01);
  ASSERT_TRUE(falling.report().fall.hand);
  EXPECT_EQ(falling.report().fall.first->segment, Segment::hand_r);
  EXPECT_NEAR(falling.report().fall.hand->speed_m_s, 3.0, 1e-9);
  EXPECT_NEAR(falling.report().fall.hand->time_s, 0.51, 1e-9);
  EXPECT_FALSE(falling.report().fall.head);
}

Senses lying(const Faller& faller, const Vec3& turn) {
  Senses senses = faller.senses(turn, Vec3::Zero());
  for (const Segment s : {Segment::chest, Segment::pelvis})
    senses.contacts.push_back(test::touches_floor(senses, s));
  return senses;
}

TEST(EndPose, is_named_by_the_chest) {
  const Faller faller;
  EXPECT_EQ(end_pose_of(lying(faller, {0.0, 0.0, 0.5 * kPi})), EndPose::supine);
  EXPECT_EQ(end_pose_of(lying(faller, {0.0, 0.0, -0.5 * kPi})), EndPose::prone);
  EXPECT_EQ(end_pose_of(lying(faller, {0.5 * kPi, 0.0, 0.0})), EndPose::right_side);
  EXPECT_EQ(end_pose_of(lying(faller, {-0.5 * kPi, 0.0, 0.0})), EndPose::left_side);
  EXPECT_EQ(end_pose_of(faller.senses(Vec3::Zero(), Vec3::Zero())), EndPose::standing);
}

TEST(Lying, body_breathes_and_then_is_done) {
  const Faller faller;
  FallSettings settings;
  settings.breathes = true;
  Falling falling(settings, faller.man.body, faller.man.range, faller.strength);
  Senses senses = lying(faller, {0.0, 0.0, 0.5 * kPi});
  falling.start(senses);
  falling.begin(senses, at_once(0.0));
  double least = 1e9;
  double most = -1e9;
  double done_s = 0.0;
  for (int i = 1; i < 900; ++i) {
    senses.time_s = 0.01 * i;
    falling.observe(senses, 0.01);
    if (falling.done() && done_s == 0.0) done_s = senses.time_s;
    if (!falling.report().fall.settled_s) continue;
    Goals goals;
    falling.drive(senses.time_s, goals);
    const double turn = log_rotation(goals.joints[index(Joint::chest)][0].parent_from_child).z();
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  ASSERT_TRUE(falling.report().fall.settled_s);
  EXPECT_NEAR(degrees(most - least), 1.6, 0.2);
  EXPECT_GT(done_s, *falling.report().fall.settled_s + 1.0);
  EXPECT_LT(done_s, 4.0);
}

}  // namespace
}  // namespace ukemi
