#include "judge/clip_limits.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ukemi
