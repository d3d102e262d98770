#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"
#include "humanoid/rotations.h"
#include "restrict/range_of_motion.h"

namespace ukemi {
namespace {

using testing::figure;
using testing::FigureOptions;

struct Standing {
  Character character;
  Humanoid humanoid;
  Pose pose;
  BodyPose body;

  Standing(Character c, StartPose kind, const StanceOptions& stance = {}) : character(std::move(c)) {
    Diagnostics diagnostics;
    const auto result = map_humanoid(character, {}, diagnostics);
    EXPECT_TRUE(result);
    humanoid = *result;
    pose = start_pose(character, humanoid, kind, stance);
    body = canonical_segments_of(character.skeleton, humanoid, pose);
  }
  const Rigid& at(Segment s) const { return body[index(s)]; }
  Quat relative(Segment parent, Segment child) const {
    return at(parent).rotation.conjugate() * at(child).rotation;
  }
};

std::vector<FigureOptions> all_figures() {
  std::vector<FigureOptions> result;
  for (const double elevation : {90.0, 45.0, 8.0}) {
    result.push_back({.arm_elevation_deg = elevation});
    result.push_back({.arm_elevation_deg = elevation,
                      .unit = 100.0,
                      .spine_bones = 1,
                      .clavicles = false,
                      .hands = false,
                      .toes = false});
    result.push_back(
        {.arm_elevation_deg = elevation, .armature_scale = 100.0, .spine_bones = 5, .twisted_nodes = true});
  }
  return result;
}

TEST(StartPose, StandAndGuardLieInsideTheHumanRangeWithThreeDegreesToSpare) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range) << range.error().message();
  int looked_at = 0;
  for (const FigureOptions& options : all_figures())
    for (const StartPose kind : {StartPose::stand, StartPose::guard}) {
      const Standing standing(figure(options), kind);
      const PerJoint<SwingTwist> charts = charts_of(*range, rotations_of(standing.body));
      for (int j = 0; j < kJointCount; ++j) {
        const JointRange& joint = range->joints[j];
        EXPECT_LT(polygon_distance(joint.polygon, charts[j].swing), radians(-3)) << name(joint_at(j));
        EXPECT_GT(charts[j].twist, joint.twist_min + radians(3)) << name(joint_at(j));
        EXPECT_LT(charts[j].twist, joint.twist_max - radians(3)) << name(joint_at(j));
        ++looked_at;
      }
    }
  EXPECT_EQ(looked_at, 9 * 2 * kJointCount);
}

TEST(StartPose, StandsOnFlatFeetUnderTheHips) {
  for (const FigureOptions& options : all_figures()) {
    const Standing standing(figure(options), StartPose::stand);
    for (const Segment foot : {Segment::foot_l, Segment::foot_r}) {
      EXPECT_LT((standing.at(foot).rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 0.02);
      EXPECT_NEAR(standing.at(foot).translation.z(), standing.at(Segment::pelvis).translation.z(), 0.02);
    }
    EXPECT_NEAR(standing.at(Segment::foot_l).translation.y(), standing.at(Segment::foot_r).translation.y(),
                1e-9);
    const double width =
        (standing.at(Segment::foot_l).translation - standing.at(Segment::foot_r).translation).norm();
    EXPECT_GT(width, 0.18);
    EXPECT_LT(width, 0.24);
    // Knees are soft, not locked.
    for (const auto& [thigh, shank] :
         {std::pair(Segment::thigh_l, Segment::shank_l), {Segment::thigh_r, Segment::shank_r}}) {
      const double bend = std::acos(
          (standing.at(thigh).rotation * Vec3::UnitY()).dot(standing.at(shank).rotation * Vec3::UnitY()));
      EXPECT_GT(bend, radians(3));
      EXPECT_LT(bend, radians(8));
    }
  }
}

TEST(StartPose, StandIsMirrorSymmetricAndFacesAsTheReference) {
  const Standing standing(figure(), StartPose::stand);
  const auto mirrored = [](const Quat& q) { return Quat(q.w(), -q.x(), -q.y(), q.z()); };
  for (int s = 0; s < kSegmentCount; ++s) {
    const Segment other = mirror_of(segment_at(s));
    const Quat here = standing.relative(Segment::pelvis, segment_at(s)),
               there = standing.relative(Segment::pelvis, other);
    EXPECT_LT(angle_between(mirrored(here), there), 1e-9) << name(segment_at(s));
  }
  EXPECT_LT((standing.at(Segment::head).rotation * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-9);
}

TEST(StartPose, ArmsHangWithBentElbows) {
  const Standing standing(figure(), StartPose::stand);
  const Vec3 arm = standing.at(Segment::upperarm_r).rotation * -Vec3::UnitY();
  EXPECT_NEAR(degrees(std::asin(-arm.x())), 9.0, 1.0);  // facing +z, the right is -x
  const double elbow =
      angle_between(standing.at(Segment::upperarm_r).rotation, standing.at(Segment::forearm_r).rotation);
  EXPECT_GT(elbow, radians(12));
  EXPECT_LT(elbow, radians(20));
}

TEST(StartPose, GuardHoldsTheFistsHighAndTheLeftFootForward) {
  const Standing guard(figure(), StartPose::guard);
  const double chin = guard.at(Segment::head).translation.y();
  for (const Segment hand : {Segment::hand_l, Segment::hand_r}) {
    EXPECT_GT(guard.at(hand).translation.y(), chin - 0.25);
    EXPECT_LT(guard.at(hand).translation.y(), chin + 0.15);
    EXPECT_GT(guard.at(hand).translation.z(), guard.at(Segment::chest).translation.z() + 0.15);
  }
  EXPECT_GT(guard.at(Segment::foot_l).translation.z() - guard.at(Segment::foot_r).translation.z(), 0.25);
  for (const auto& [upper, lower] :
       {std::pair(Segment::upperarm_l, Segment::forearm_l), {Segment::upperarm_r, Segment::forearm_r}}) {
    const double bend =
        std::acos((guard.at(upper).rotation * Vec3::UnitY()).dot(guard.at(lower).rotation * Vec3::UnitY()));
    EXPECT_NEAR(degrees(bend), 115.0, 6.0);
  }
}

TEST(StartPose, LeavesFingersAsTheyAre) {
  const Standing standing(figure({.twisted_nodes = true}), StartPose::guard);
  const int finger = standing.character.skeleton.find("mixamorig:RightHandMiddle1");
  EXPECT_EQ(standing.pose[finger].rotation.coeffs(),
            standing.character.skeleton.nodes[finger].rest.rotation.coeffs());
}

Vec3 heading_forward(const Quat& pelvis) {
  const Vec3 forward = pelvis * Vec3::UnitX();
  return Vec3(forward.x(), 0.0, forward.z()).normalized();
}

/// A skin of one sole vertex 2 cm below each toe joint, one `heel_m` behind each ankle and one on top of the
/// head.
void add_skin(Character& character, double heel_m = 0.06) {
  const Skeleton& skeleton = character.skeleton;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  Skin skin;
  MeshPart part;
  part.node = 0;
  part.skin = 0;
  const auto add = [&](const char* name, const Vec3& offset) {
    const int node = skeleton.find(name);
    skin.joints.push_back(node);
    skin.inverse_bind.push_back(world[node].inverse());
    part.positions.push_back((world[node].translation() + offset).cast<float>());
    part.joints.push_back({static_cast<std::uint16_t>(skin.joints.size() - 1), 0, 0, 0});
    part.weights.push_back({1, 0, 0, 0});
  };
  add("mixamorig:LeftToeBase", Vec3(0, -0.02, 0));
  add("mixamorig:RightToeBase", Vec3(0, -0.02, 0));
  add("mixamorig:LeftFoot", Vec3(0, 0, -heel_m));
  add("mixamorig:RightFoot", Vec3(0, 0, -heel_m));
  add("mixamorig:HeadTop_End", Vec3::Zero());
  character.skins.push_back(skin);
  character.parts.push_back(part);
}

/// A head that is a cube of that half edge, from 10 cm below the head joint upwards, of many small triangles.
void add_cubic_head(Character& character, double half_edge) {
  constexpr std::uint32_t kSquares = 20;  // along an edge
  const int head = character.skeleton.find("mixamorig:Head");
  const Affine world = world_transforms(character.skeleton, rest_pose(character.skeleton))[head];
  character.skins.push_back({{head}, {world.inverse()}});
  const Vec3 centre = world.translation() + Vec3(0, half_edge - 0.1, 0);
  MeshPart part;
  part.node = 0;
  part.skin = 0;
  for (int face = 0; face < 6; ++face) {
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    for (std::uint32_t i = 0; i <= kSquares; ++i)
      for (std::uint32_t j = 0; j <= kSquares; ++j) {
        Vec3 at = Vec3::Constant(face < 3 ? 1.0 : -1.0);
        at[(face + 1) % 3] = 2.0 * i / kSquares - 1.0;
        at[(face + 2) % 3] = 2.0 * j / kSquares - 1.0;
        part.positions.push_back((centre + half_edge * at).cast<float>());
        part.joints.push_back({0, 0, 0, 0});
        part.weights.push_back({1, 0, 0, 0});
      }
    for (std::uint32_t i = 0; i < kSquares; ++i)
      for (std::uint32_t j = 0; j < kSquares; ++j) {
        const std::uint32_t corner = first + i * (kSquares + 1) + j, next = corner + kSquares + 1;
        for (const std::uint32_t index : {corner, next, corner + 1, next, next + 1, corner + 1})
          part.indices.push_back(index);
      }
  }
  character.parts.push_back(part);
}

TEST(StartPose, GuardHoldsTheFistsOutOfALargeHead) {
  for (const double half_edge : {0.1, 0.25, 0.3, 0.8}) {
    Character character = figure();
    add_cubic_head(character, half_edge);
    const Standing guard(character, StartPose::guard);
    const Rigid& head = guard.at(Segment::head);
    for (const Segment segment : {Segment::hand_l, Segment::hand_r}) {
      const Rigid& hand = guard.at(segment);
      const Vec3 fist = head.inverse() * (hand * Vec3(0, -0.08, 0));  // x forwards, y up from the head joint
      EXPECT_TRUE(fist.x() > half_edge || fist.y() < -0.1)
          << half_edge << ": " << name(segment) << " " << fist.transpose();
    }
  }
}

TEST(StartPose, OfTheLivingIsFartherAheadOfTheAnklesWhereHeelsAreShort) {
  const auto ahead_m = [](double heel_m) {
    Character character = figure();
    add_skin(character, heel_m);
    StanceOptions options;
    options.living = true;
    const Standing man(character, StartPose::stand, options);
    const Vec3 ankles = 0.5 * (man.at(Segment::foot_l).translation + man.at(Segment::foot_r).translation);
    const Vec3 forward = heading_forward(man.at(Segment::pelvis).rotation);
    return std::pair((man.at(Segment::pelvis).translation - ankles).dot(forward), man.humanoid.height_m);
  };
  const auto [usual, height] = ahead_m(0.07);
  EXPECT_NEAR(ahead_m(0.09).first, usual, 1e-9);
  EXPECT_NEAR(ahead_m(0.02).first - usual, 0.036 * height - 0.02, 0.004);
}

TEST(StartPose, TheLowestSolePointOfTheSkinStandsOnTheFloor) {
  for (const StartPose kind : {StartPose::rest, StartPose::stand, StartPose::guard}) {
    Character character = figure();
    add_skin(character);
    const Standing standing(character, kind);
    const std::vector<Affine> world = world_transforms(standing.character.skeleton, standing.pose);
    double lowest = 1e300;
    for (const char* name : {"mixamorig:LeftToeBase", "mixamorig:RightToeBase"})
      lowest = std::min(lowest, (world[standing.character.skeleton.find(name)] * Vec3(0, -0.02, 0)).y());
    EXPECT_NEAR(lowest, 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace ukemi
