// Figures that are only known from motion.
#include <gtest/gtest.h>

#include <algorithm>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

using testing::figure;

/// A motion of the figure's skeleton, given frame by frame.
void set_motion(Character& character, const std::vector<Pose>& frames) {
  character.format = SourceFormat::bvh;
  Animation animation;
  animation.fps = 30.0;
  animation.end_s = static_cast<double>(frames.size() - 1) / 30.0;
  for (int node = 0; node < character.skeleton.size(); ++node) {
    Track turn, place;
    turn.node = place.node = node;
    place.path = TrackPath::translation;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const LocalTransform& local = frames[i][node];
      for (Track* track : {&turn, &place}) track->times.push_back(static_cast<double>(i) / 30.0);
      for (int k = 0; k < 4; ++k) turn.values.push_back(local.rotation.coeffs()[k]);
      for (int k = 0; k < 3; ++k) place.values.push_back(local.translation[k]);
    }
    animation.tracks.push_back(turn);
    animation.tracks.push_back(place);
  }
  character.animations = {animation};
}

/// The same figure with a zero pose that is none: every bone lies along y of its parent and the rest pose has
/// no rotation, so that legs, trunk and arms all point up.
Character with_useless_zero_pose(const Character& character, Pose& standing) {
  Character result = character;
  const Skeleton& skeleton = character.skeleton;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  const auto children = skeleton.children();
  std::vector<Quat> turned(skeleton.nodes.size(), Quat::Identity());
  for (const int i : skeleton.order) {
    const bool is_bone = skeleton.nodes[i].name.find("Left") != std::string::npos ||
                         skeleton.nodes[i].name.find("Right") != std::string::npos;
    if (is_bone && !children[i].empty())
      turned[i] =
          shortest_rotation(Vec3::UnitY(), world[children[i][0]].translation() - world[i].translation());
  }
  standing = rest_pose(skeleton);
  for (const int i : skeleton.order) {
    const int parent = skeleton.nodes[i].parent;
    if (parent < 0) continue;
    LocalTransform& local = standing[i];
    local.translation = turned[parent].conjugate() * (world[i].translation() - world[parent].translation());
    local.rotation = turned[parent].conjugate() * turned[i];
    result.skeleton.nodes[i].rest.translation = local.translation;
    result.skeleton.nodes[i].rest.rotation = Quat::Identity();
  }
  return result;
}

Humanoid mapped(const Character& character) {
  Diagnostics diagnostics;
  const auto result = map_humanoid(character, {}, diagnostics);
  EXPECT_TRUE(result) << (result ? "" : result.error().message());
  return result ? *result : Humanoid{};
}

/// Angle between forearm and hand in the rest pose, against the neutral pose that the character is given.
double resting_wrist_bend_deg(const Character& character) {
  const BodyPose body = segments_of(character.skeleton, mapped(character), rest_pose(character.skeleton));
  return degrees(
      angle_between(body[index(Segment::forearm_r)].rotation, body[index(Segment::hand_r)].rotation));
}

TEST(Motion, ATPoseFrameReplacesAZeroPoseThatIsNone) {
  const Character original = figure();
  Pose standing;
  Character character = with_useless_zero_pose(original, standing);
  const int thigh = character.skeleton.find("mixamorig:LeftUpLeg");
  Pose kicking = standing;
  kicking[thigh].rotation = kicking[thigh].rotation * exp_rotation(Vec3(0.7, 0, 0));
  Pose lowered = standing;  // nearer to the neutral pose, but no T-pose: the shoulders are down
  for (const auto& [name, turn] : {std::pair("mixamorig:LeftArm", -1.5), {"mixamorig:RightArm", 1.5}}) {
    const int arm = character.skeleton.find(name);
    lowered[arm].rotation = exp_rotation(Vec3(0, 0, turn)) * lowered[arm].rotation;
  }
  set_motion(character, {lowered, kicking, standing, kicking});
  const Humanoid expected = mapped(original), found = mapped(character);
  EXPECT_EQ(found.rest_pose, RestPoseClass::other);
  const BodyPose want = segments_of(original.skeleton, expected, expected.reference);
  const BodyPose have = segments_of(character.skeleton, found, standing);
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_LT(angle_between(want[s].rotation, have[s].rotation), radians(1)) << name(segment_at(s));
}

TEST(Motion, TheMotionSaysWhichWayIsUp) {
  Character character = figure();
  const Quat lying(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));  // y to z
  Pose pose = rest_pose(character.skeleton);
  pose[0].rotation = lying * pose[0].rotation;
  pose[0].translation = lying * pose[0].translation;
  std::vector<Pose> walk(3, pose);
  walk[1][0].translation.y() -= 1.0;
  walk[2][0].translation.y() -= 2.0;
  set_motion(character, walk);
  const Humanoid humanoid = mapped(character);
  EXPECT_EQ(humanoid.up_axis, 'z');
  const BodyPose body = segments_of(character.skeleton, humanoid, humanoid.reference);
  EXPECT_LT((body[index(Segment::pelvis)].rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-6);
  EXPECT_GT(body[index(Segment::head)].translation.y(), body[index(Segment::foot_l)].translation.y() + 1.0);
}

/// Upright frames in which the right hand is always bent by 25 degrees and swings by 10 about that.
std::vector<Pose> frames_with_a_bent_hand(const Character& character, int count) {
  const Humanoid humanoid = mapped(character);
  const BodyPose from = segments_of(character.skeleton, humanoid, humanoid.reference);
  std::vector<Pose> frames;
  for (int i = 0; i < count; ++i) {
    BodyPose to = from;
    const double swing = 10.0 * std::sin(2.0 * kPi * i / count);
    to[index(Segment::hand_r)].rotation =
        to[index(Segment::forearm_r)].rotation * exp_rotation(Vec3(0, 0, radians(25.0 + swing)));
    frames.push_back(pose_skeleton(character.skeleton, humanoid, humanoid.reference, from, to));
  }
  return frames;
}

TEST(Motion, HandsThatTheMarkersPutAskewBecomeStraightOnAverage) {
  Character character = figure({.arm_elevation_deg = 5.0});
  const std::vector<Pose> frames = frames_with_a_bent_hand(character, 100);
  set_motion(character, frames);
  const Humanoid humanoid = mapped(character);
  Vec3 sum = Vec3::Zero();
  for (const Pose& pose : frames) {
    const BodyPose body = segments_of(character.skeleton, humanoid, pose);
    sum += log_rotation(body[index(Segment::forearm_r)].rotation.conjugate() *
                        body[index(Segment::hand_r)].rotation);
  }
  EXPECT_LT((sum / 100.0).norm(), radians(0.5));
}

/// Frames in which the right wrist swings by 30 degrees about an axis of the hand; in every fourth frame the
/// hand is folded back, as where a tracker loses it.
std::vector<Pose> frames_with_a_waving_hand(const Character& character, const Vec3& axis, bool lost) {
  const Humanoid humanoid = mapped(character);
  const BodyPose from = segments_of(character.skeleton, humanoid, humanoid.reference);
  std::vector<Pose> frames;
  for (int i = 0; i < 100; ++i) {
    BodyPose to = from;
    const double bend = lost && i % 4 == 3 ? 140.0 : 30.0 * std::sin(2.0 * kPi * i / 100.0);
    to[index(Segment::hand_r)].rotation =
        to[index(Segment::forearm_r)].rotation * exp_rotation(radians(bend) * axis);
    frames.push_back(pose_skeleton(character.skeleton, humanoid, humanoid.reference, from, to));
  }
  return frames;
}

/// Largest flexion (about x) and deviation (about z) of the right wrist over the frames, degrees.
Vec2 wrist_bends_deg(const Character& character, const std::vector<Pose>& frames) {
  const Humanoid humanoid = mapped(character);
  Vec2 largest = Vec2::Zero();
  for (const Pose& pose : frames) {
    const BodyPose body = canonical_segments_of(character.skeleton, humanoid, pose);
    const Vec3 bend = log_rotation(body[index(Segment::forearm_r)].rotation.conjugate() *
                                   body[index(Segment::hand_r)].rotation);
    largest = largest.cwiseMax(Vec2(degrees(std::abs(bend.x())), degrees(std::abs(bend.z()))));
  }
  return largest;
}

TEST(Motion, TheAxisAWristBendsAboutMostIsThatOfFlexion) {
  Character character = figure({.arm_elevation_deg = 5.0});
  const Vec3 oblique = Vec3(std::cos(radians(20)), 0.0, std::sin(radians(20)));
  const std::vector<Pose> frames = frames_with_a_waving_hand(character, oblique, false);
  EXPECT_NEAR(wrist_bends_deg(character, frames).y(), 30.0 * std::sin(radians(20)), 0.5) << "at first";
  set_motion(character, frames);
  EXPECT_NEAR(wrist_bends_deg(character, frames).x(), 30.0, 0.5);
  EXPECT_LT(wrist_bends_deg(character, frames).y(), 0.5);
}

TEST(Motion, NoHandIsRolledThatTurnsItsForearmToTheEndOfPronation) {
  Character character = figure({.arm_elevation_deg = 5.0});
  const std::vector<Pose> frames = frames_with_a_waving_hand(character, Vec3::UnitZ(), false);
  set_motion(character, frames);
  EXPECT_NEAR(wrist_bends_deg(character, frames).y(), 30.0, 0.5);
}

TEST(Motion, FramesInWhichTheTrackerLosesAHandDoNotMoveIt) {
  Character character = figure({.arm_elevation_deg = 5.0});
  set_motion(character, frames_with_a_waving_hand(character, Vec3::UnitX(), true));
  EXPECT_LT(resting_wrist_bend_deg(character), 1.0);
}

TEST(Motion, TheNeutralPoseMayBeKeptThatOfTheRestPose) {
  Character character = figure({.arm_elevation_deg = 5.0});
  const Humanoid before = mapped(character);
  set_motion(character, frames_with_a_bent_hand(character, 100));
  HumanoidOptions options;
  options.neutral_from_motion = false;
  Diagnostics diagnostics;
  const auto kept = map_humanoid(character, options, diagnostics);
  ASSERT_TRUE(kept);
  const int hand = index(Segment::hand_r);
  EXPECT_LT(angle_between(kept->node_from_segment[hand], before.node_from_segment[hand]), 1e-9);
  EXPECT_GT(angle_between(mapped(character).node_from_segment[hand], before.node_from_segment[hand]),
            radians(20.0));
}

TEST(Motion, ACharacterWithAMeshKeepsItsOwnNeutralPose) {
  Character character = figure({.arm_elevation_deg = 5.0});
  set_motion(character, frames_with_a_bent_hand(character, 100));
  character.format = SourceFormat::gltf;
  MeshPart part;
  part.node = 0;
  character.parts.push_back(part);
  EXPECT_LT(resting_wrist_bend_deg(character), 1.0);
}

TEST(Motion, TheElbowsBendShowsItsAxis) {
  Character character = figure({.arm_elevation_deg = 5.0});
  const Humanoid first = mapped(character);
  const BodyPose from = segments_of(character.skeleton, first, first.reference);
  // The rig's elbow is a hinge 30 degrees off what the resting figure shows.
  const Quat off = exp_rotation(Vec3(0, radians(30), 0));
  std::vector<Pose> frames;
  for (int i = 0; i < 40; ++i) {
    BodyPose to = from;
    const Quat bend = off * exp_rotation(Vec3(0, 0, radians(20.0 + i))) * off.conjugate();
    for (const Segment s : {Segment::forearm_l, Segment::hand_l})
      to[index(s)].rotation = to[index(Segment::upperarm_l)].rotation * bend;
    frames.push_back(pose_skeleton(character.skeleton, first, first.reference, from, to));
  }
  set_motion(character, frames);
  const Humanoid humanoid = mapped(character);
  const BodyPose body = segments_of(character.skeleton, humanoid, frames.back());
  const Vec3 link = body[index(Segment::upperarm_l)].rotation.conjugate() *
                    (body[index(Segment::forearm_l)].rotation * -Vec3::UnitY());
  EXPECT_NEAR(link.z(), 0.0, 0.01);
  EXPECT_GT(link.x(), 0.8);
}

TEST(Motion, ABindPoseServesWhereTheCharacterRestsInACrouch) {
  Character character = figure();
  const Character original = character;
  Skeleton& skeleton = character.skeleton;
  Skin skin;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  for (int i = 1; i < skeleton.size(); ++i) {
    skin.joints.push_back(i);
    skin.inverse_bind.push_back(world[i].inverse());
  }
  character.skins.push_back(skin);
  MeshPart part;
  part.node = 0;
  character.parts.push_back(part);
  for (const auto& [name, bend] : {std::pair("mixamorig:LeftUpLeg", -0.8),
                                   {"mixamorig:RightUpLeg", -0.8},
                                   {"mixamorig:LeftLeg", 1.4},
                                   {"mixamorig:RightLeg", 1.4}})
    skeleton.nodes[skeleton.find(name)].rest.rotation = exp_rotation(Vec3(bend, 0, 0));
  const Humanoid humanoid = mapped(character);
  EXPECT_EQ(humanoid.rest_pose, RestPoseClass::other);
  const Humanoid expected = mapped(original);
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_LT(angle_between(humanoid.node_from_segment[s], expected.node_from_segment[s]), 1e-6)
        << name(segment_at(s));
}

/// Frames in which the whole figure is turned and its hips lie at a place.
std::vector<Pose> laid(const Character& character, const Quat& turn, const Vec3& hips, int count) {
  Pose pose = rest_pose(character.skeleton);
  const int root = character.skeleton.find("mixamorig:Hips");
  pose[root].rotation = turn * pose[root].rotation;
  pose[root].translation = hips;
  return std::vector<Pose>(static_cast<std::size_t>(count), pose);
}

Humanoid with_motion(Character character, const std::vector<Pose>& frames, Diagnostics& diagnostics,
                     SourceFormat format = SourceFormat::bvh) {
  set_motion(character, frames);
  character.format = format;
  const auto result = map_humanoid(character, {}, diagnostics);
  EXPECT_TRUE(result) << (result ? "" : result.error().message());
  return result ? *result : Humanoid{};
}

TEST(UpAxis, WhoeverLiesInAMotionLiesByTheAxesOfHisSkeleton) {
  const Character character = figure({.arm_elevation_deg = 90.0});
  for (const Vec3& about : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    for (const double along : {0.0, -0.9, 2.0}) {
      const Quat turn = exp_rotation(0.5 * kPi * about);
      const Vec3 hips = Vec3(0, 0.12, 0) + along * (turn * Vec3::UnitY());
      Diagnostics diagnostics;
      EXPECT_EQ(with_motion(character, laid(character, turn, hips, 30), diagnostics).up_axis, 'y');
      EXPECT_EQ(diagnostics.warnings().size(), 1u) << "a guess";
      // A fall and a get-up stand at one end.
      std::vector<Pose> frames = laid(character, turn, hips, 90);
      const Pose standing = laid(character, Quat::Identity(), Vec3(0, 1, 0), 1).front();
      for (int i = 0; i < 5; ++i) frames[static_cast<std::size_t>(i)] = standing;
      Diagnostics of_fall, of_get_up;
      EXPECT_EQ(with_motion(character, frames, of_fall).up_axis, 'y');
      std::reverse(frames.begin(), frames.end());
      EXPECT_EQ(with_motion(character, frames, of_get_up).up_axis, 'y');
      EXPECT_TRUE(of_fall.warnings().empty() && of_get_up.warnings().empty());
    }
}

TEST(UpAxis, OfGltfIsYHoweverTheFigureLies) {
  const Character character = figure();
  for (const Vec3& about : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
    Diagnostics diagnostics;
    const auto frames = laid(character, exp_rotation(0.5 * kPi * about), Vec3(0, 0, 0.9), 30);
    EXPECT_EQ(with_motion(character, frames, diagnostics, SourceFormat::gltf).up_axis, 'y');
  }
}

TEST(UpAxis, AWalkOnAnotherFloorIsBelievedWithAWarning) {
  const Character character = figure();
  std::vector<Pose> frames;
  for (int i = 0; i < 60; ++i) {
    const Vec3 hips(0.3, 0.04 * i - 3.0, 1.0);
    frames.push_back(laid(character, exp_rotation(Vec3(0.5 * kPi, 0, 0)), hips, 1).front());
  }
  Diagnostics diagnostics;
  EXPECT_EQ(with_motion(character, frames, diagnostics).up_axis, 'z');
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("--up"), std::string::npos);
}

TEST(UpAxis, OfASkeletonWithZUpIsZ) {
  const Character character = figure({.armature = Quat(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()))});
  Diagnostics diagnostics;
  const std::vector<Pose> frames(30, rest_pose(character.skeleton));
  EXPECT_EQ(with_motion(character, frames, diagnostics).up_axis, 'z');
  EXPECT_TRUE(diagnostics.warnings().empty());
}

TEST(Motion, FeetThatSwingBackwardsExchangeNothing) {
  Character character = figure({.arm_elevation_deg = 10.0});
  std::vector<Pose> frames(40, rest_pose(character.skeleton));
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (const char* foot : {"mixamorig:LeftFoot", "mixamorig:RightFoot"})
      if (i < 10) frames[i][character.skeleton.find(foot)].rotation = exp_rotation(Vec3(2.2, 0, 0));
  for (Node& node : character.skeleton.nodes) node.name.clear();
  Diagnostics diagnostics;
  const Humanoid humanoid = with_motion(character, frames, diagnostics);
  const int thigh = humanoid.carrier_node(Segment::thigh_l);
  EXPECT_GT(world_transforms(character.skeleton, rest_pose(character.skeleton))[thigh].translation().x(),
            0.0);
}

}  // namespace
}  // namespace ukemi
