#include "judge/clip_limits.h"

#include <gtest/gtest.h>

#include <optional>

namespace ukemi {
namespace {

/// Every joint swings and twists by a tenth of a radian either way.
RangeOfMotion narrow() {
  RangeOfMotion range;
  for (JointRange& joint : range.joints) {
    joint.polygon = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    joint.twist_min = -0.1;
    joint.twist_max = 0.1;
  }
  return range;
}

/// A hand bent at the wrist, everything else straight.
BodyPose bent(Segment hand, double angle) {
  BodyPose pose;
  pose[index(hand)].rotation = exp_rotation(Vec3(0.0, angle, 0.0));
  return pose;
}

TEST(ClipLimits, CountSamplesThatLieMoreThanADegreeOutside) {
  Humanoid humanoid;
  for (SegmentNodes& segment : humanoid.segments) segment.chain = {0};
  const std::vector<BodyPose> poses = {bent(Segment::hand_l, 0.1 + radians(0.9)), bent(Segment::hand_l, 0.09),
                                       bent(Segment::hand_r, 0.1 + radians(1.1)),
                                       bent(Segment::hand_l, -0.1 - radians(5.0))};
  const ClipLimits limits = clip_limits(humanoid, narrow(), poses);
  EXPECT_EQ(limits.samples, 4 * kJointCount);
  EXPECT_EQ(limits.over_1deg, 2);
  EXPECT_NEAR(limits.excess_max_deg, 5.0, 1e-9);
  EXPECT_EQ(limits.worst_joint, Joint::wrist_l);
  humanoid.segments[index(Segment::hand_l)].chain.clear();  // fused: has no joint
  const ClipLimits without = clip_limits(humanoid, narrow(), poses);
  EXPECT_EQ(without.samples, 4 * (kJointCount - 1));
  EXPECT_NEAR(without.excess_max_deg, 1.1, 1e-9);
}

/// A forearm and a hand on it, whose wrist lies so far outside its range in the whole clip's only frame.
struct Wrist {
  Skeleton skeleton;
  SegmentFrames frames;
  std::optional<RangeKeeper> keeper;

  explicit Wrist(double outside_deg) {
    skeleton.nodes = {{"forearm", -1, {}}, {"hand", 0, {}}};
    skeleton.order = {0, 1};
    frames.node.fill(-1);
    frames.node[index(Segment::pelvis)] = 0;
    frames.node[index(Segment::forearm_l)] = 0;
    frames.node[index(Segment::hand_l)] = 1;
    for (Quat& turn : frames.segment_from_node) turn = Quat::Identity();
    keeper.emplace(skeleton, frames, narrow(), std::vector<Pose>{pose(outside_deg)});
  }
  Pose pose(double outside_deg) const {
    Pose pose = rest_pose(skeleton);
    pose[1].rotation = exp_rotation(Vec3(0.0, 0.1 + radians(outside_deg), 0.0));
    return pose;
  }
  bool is_mended(double outside_deg) const { return !keeper->to_mend(0, pose(outside_deg)).empty(); }
};

TEST(RangeKeeper, AJointInsideMayComeATwentiethOfADegreeOutside) {
  const Wrist inside(-2.0);
  EXPECT_FALSE(inside.is_mended(0.04));
  EXPECT_TRUE(inside.is_mended(0.06));
}

TEST(RangeKeeper, AJointOutsideStaysAsFarOutsideAsItIs) {
  const Wrist outside(3.0);
  EXPECT_FALSE(outside.is_mended(3.04));
  EXPECT_FALSE(outside.is_mended(2.96));
  EXPECT_TRUE(outside.is_mended(3.06));
  EXPECT_TRUE(outside.is_mended(2.94));
}

TEST(RangeKeeper, NoSampleCrossesOneOrFiveDegrees) {
  for (const double threshold_deg : {1.0, 5.0}) {
    EXPECT_TRUE(Wrist(threshold_deg - 0.01).is_mended(threshold_deg + 0.01)) << threshold_deg;
    EXPECT_TRUE(Wrist(threshold_deg + 0.01).is_mended(threshold_deg - 0.01)) << threshold_deg;
    EXPECT_FALSE(Wrist(threshold_deg + 0.01).is_mended(threshold_deg + 0.04)) << threshold_deg;
  }
}

}  // namespace
}  // namespace ukemi
