#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

using testing::figure;

/// A figure whose bodies can be set freely: the reference pose and what pose_skeleton makes of targets.
struct Puppet {
  Character character = figure({.arm_elevation_deg = 0.0, .spine_bones = 2});
  Humanoid humanoid;
  BodyPose from;

  Puppet() {
    Diagnostics diagnostics;
    humanoid = *map_humanoid(character, {}, diagnostics);
    from = segments_of(character.skeleton, humanoid, humanoid.reference);
    // Exactly neutral, so that relative rotations are what the tests say they are.
    for (Rigid& segment : from) segment.rotation = from[0].rotation;
  }
  /// Canonical segments of the pose whose segments have these rotations against the pelvis.
  BodyPose canonical(const std::map<Segment, Quat>& turns) const {
    BodyPose start = segments_of(character.skeleton, humanoid, humanoid.reference);
    BodyPose to = start;
    for (int s = 0; s < kSegmentCount; ++s) to[s].rotation = from[0].rotation;
    for (const auto& [segment, turn] : turns) to[index(segment)].rotation = from[0].rotation * turn;
    return canonical_segments_of(character.skeleton, humanoid,
                                 pose_skeleton(character.skeleton, humanoid, humanoid.reference, start, to));
  }
};

Quat relative(const BodyPose& body, Segment parent, Segment child) {
  return body[index(parent)].rotation.conjugate() * body[index(child)].rotation;
}
Quat about(const Vec3& axis, double degrees_) { return exp_rotation(axis * radians(degrees_)); }

TEST(CanonicalRolls, TheForearmTakesTheTwistOfTheHand) {
  const Puppet puppet;
  const Quat palmar = about(Vec3::UnitZ(), 20);
  const BodyPose body = puppet.canonical({{Segment::hand_r, about(Vec3::UnitY(), 50) * palmar}});
  EXPECT_NEAR(degrees(twist_angle(relative(body, Segment::forearm_r, Segment::hand_r), Vec3::UnitY())), 0.0,
              1e-6);
  EXPECT_NEAR(degrees(twist_angle(relative(body, Segment::upperarm_r, Segment::forearm_r), Vec3::UnitY())),
              50.0, 1e-6);
}

TEST(CanonicalRolls, TheTrunkIsSplitWhateverTheBonesDo) {
  const Puppet puppet;
  const BodyPose flexed =
      puppet.canonical({{Segment::chest, about(Vec3::UnitZ(), -40)}, {Segment::abdomen, Quat::Identity()}});
  EXPECT_LT(angle_between(relative(flexed, Segment::pelvis, Segment::abdomen), about(Vec3::UnitZ(), -21.6)),
            1e-9);
  const BodyPose turned = puppet.canonical({{Segment::chest, about(Vec3::UnitY(), 40)}});
  EXPECT_LT(angle_between(relative(turned, Segment::pelvis, Segment::abdomen), about(Vec3::UnitY(), 12)),
            1e-9);
  const BodyPose bent = puppet.canonical({{Segment::chest, about(Vec3::UnitX(), 30)}});
  EXPECT_LT(angle_between(relative(bent, Segment::pelvis, Segment::abdomen), about(Vec3::UnitX(), 13.8)),
            1e-9);
}

TEST(CanonicalRolls, ElbowAndKneeBendInThePlaneOfTheirHinges) {
  const Puppet puppet;
  // Forearm and shank bent 60 degrees about an axis that is 25 degrees off the hinge.
  const Quat off = about(Vec3::UnitY(), 25);
  const BodyPose body =
      puppet.canonical({{Segment::forearm_l, off * about(Vec3::UnitZ(), 60) * off.conjugate()},
                        {Segment::hand_l, off * about(Vec3::UnitZ(), 60) * off.conjugate()},
                        {Segment::shank_r, off * about(Vec3::UnitZ(), -60) * off.conjugate()},
                        {Segment::foot_r, off * about(Vec3::UnitZ(), -60) * off.conjugate()}});
  const Vec3 forearm = relative(body, Segment::upperarm_l, Segment::forearm_l) * -Vec3::UnitY();
  EXPECT_NEAR(forearm.z(), 0.0, 1e-9);
  EXPECT_NEAR(forearm.x(), std::sin(radians(60)), 1e-9);
  const Vec3 shank = relative(body, Segment::thigh_r, Segment::shank_r) * -Vec3::UnitY();
  EXPECT_NEAR(shank.z(), 0.0, 1e-9);
  EXPECT_NEAR(shank.x(), -std::sin(radians(60)), 1e-9);
}

TEST(CanonicalRolls, ABendToTheSideIsARollOfTheRig) {
  const Puppet puppet;
  // Bent by 50 degrees about an axis that is 100 degrees off the hinge: no elbow does that.
  const Quat off = about(Vec3::UnitY(), 100);
  const Quat bend = off * about(Vec3::UnitZ(), 50) * off.conjugate();
  const BodyPose body = puppet.canonical({{Segment::forearm_r, bend}, {Segment::hand_r, bend}});
  const Vec3 forearm = relative(body, Segment::upperarm_r, Segment::forearm_r) * -Vec3::UnitY();
  EXPECT_NEAR(forearm.x(), std::sin(radians(50)), 1e-9);
  EXPECT_NEAR(forearm.z(), 0.0, 1e-9);
}

TEST(CanonicalRolls, AStraightArmAndAHingeFarOffKeepTheirRolls) {
  const Puppet puppet;
  const Quat roll = about(Vec3::UnitY(), 30);
  const BodyPose straight =
      puppet.canonical({{Segment::upperarm_r, roll}, {Segment::forearm_r, roll}, {Segment::hand_r, roll}});
  EXPECT_LT(angle_between(relative(straight, Segment::chest, Segment::upperarm_r), roll), 1e-9);
  const Quat backwards = about(Vec3::UnitZ(), -40);
  const BodyPose wrong = puppet.canonical({{Segment::forearm_r, backwards}, {Segment::hand_r, backwards}});
  EXPECT_LT(angle_between(relative(wrong, Segment::chest, Segment::upperarm_r), Quat::Identity()), 1e-9);
}

TEST(CanonicalRolls, TheShankTakesSixtyPercentOfTheToeOutUpToItsLimit) {
  const Puppet puppet;
  // To the right is a negative turn about y.
  const BodyPose out = puppet.canonical(
      {{Segment::foot_r, about(Vec3::UnitY(), -20)}, {Segment::foot_l, about(Vec3::UnitY(), 20)}});
  EXPECT_NEAR(degrees(twist_angle(relative(out, Segment::thigh_r, Segment::shank_r), Vec3::UnitY())), -12.0,
              1e-6);
  EXPECT_NEAR(degrees(twist_angle(relative(out, Segment::thigh_l, Segment::shank_l), Vec3::UnitY())), 12.0,
              1e-6);
  const BodyPose in = puppet.canonical({{Segment::foot_r, about(Vec3::UnitY(), 60)}});
  EXPECT_NEAR(degrees(twist_angle(relative(in, Segment::thigh_r, Segment::shank_r), Vec3::UnitY())), 18.0,
              1e-6);
}

TEST(CanonicalRolls, PositionsStay) {
  const Puppet puppet;
  const Pose pose = start_pose(puppet.character, puppet.humanoid, StartPose::guard);
  const BodyPose raw = segments_of(puppet.character.skeleton, puppet.humanoid, pose);
  const BodyPose canonical = canonical_segments_of(puppet.character.skeleton, puppet.humanoid, pose);
  for (int s = 0; s < kSegmentCount; ++s) EXPECT_EQ(raw[s].translation, canonical[s].translation);
}

}  // namespace
}  // namespace ukemi
