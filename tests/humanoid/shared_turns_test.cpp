// Several bones that share the turn of one segment.
#include <gtest/gtest.h>

#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

/// A pelvis and what a test hangs on it; every other segment is fused.
struct Rig {
  Skeleton skeleton;
  Humanoid humanoid;
  BodyPose at_rest;

  Rig() {
    add(-1, Vec3(0.0, 1.0, 0.0));
    humanoid.root = 0;
    humanoid.segments[index(Segment::pelvis)].chain = {0};
  }
  int add(int parent, const Vec3& offset) {
    skeleton.nodes.push_back({"node" + std::to_string(skeleton.size()), parent, {}});
    skeleton.nodes.back().rest.translation = offset;
    EXPECT_TRUE(skeleton.sort());
    return skeleton.size() - 1;
  }
  /// World rotations once a segment is turned.
  std::vector<Quat> turned(Segment segment, const Vec3& turn) const {
    BodyPose to = at_rest;
    to[index(segment)].rotation = exp_rotation(turn);
    const Pose pose = pose_skeleton(skeleton, humanoid, rest_pose(skeleton), at_rest, to);
    std::vector<Quat> rotations;
    for (const Affine& node : world_transforms(skeleton, pose))
      rotations.push_back(rotation_part(node.linear()));
    return rotations;
  }
};

void expect_turn(const Quat& is, const Vec3& wanted) {
  EXPECT_LT(degrees(angle_between(is, exp_rotation(wanted))), 1e-6)
      << log_rotation(is).transpose() << ", wanted " << wanted.transpose();
}

TEST(SharedTurns, TheBonesOfAChainTurnByEqualShares) {
  Rig rig;
  int bone = 0;
  std::vector<int> chain;
  for (int i = 0; i < 3; ++i) chain.push_back(bone = rig.add(bone, Vec3(0.0, 0.1, 0.0)));
  rig.humanoid.segments[index(Segment::abdomen)].chain = chain;
  const Vec3 turn(0.2, 0.3, -0.6);
  const std::vector<Quat> turned = rig.turned(Segment::abdomen, turn);
  for (int i = 0; i < 3; ++i) expect_turn(turned[chain[i]], (i + 1) / 3.0 * turn);
}

TEST(SharedTurns, ATwistBoneTakesTheTwistUpToWhereItLies) {
  Rig rig;
  const int upper = rig.add(0, Vec3(0.2, 0.5, 0.0));
  const int fore = rig.add(upper, Vec3(0.3, 0.0, 0.0));
  const int near = rig.add(upper, Vec3(0.075, 0.0, 0.0)), far = rig.add(upper, Vec3(0.225, 0.0, 0.0));
  rig.humanoid.segments[index(Segment::upperarm_l)].chain = {upper};
  rig.humanoid.segments[index(Segment::forearm_l)].chain = {fore};
  rig.humanoid.twist_bones = {{near, Segment::upperarm_l, 0.25}, {far, Segment::upperarm_l, 0.75}};
  rig.at_rest[index(Segment::upperarm_l)].translation = Vec3(0.2, 1.5, 0.0);
  rig.at_rest[index(Segment::forearm_l)].translation = Vec3(0.5, 1.5, 0.0);
  const std::vector<Quat> turned = rig.turned(Segment::upperarm_l, Vec3(1.2, 0.0, 0.0));
  expect_turn(turned[upper], Vec3(1.2, 0.0, 0.0));
  expect_turn(turned[near], Vec3(0.3, 0.0, 0.0));
  expect_turn(turned[far], Vec3(0.9, 0.0, 0.0));
}

}  // namespace
}  // namespace ukemi
