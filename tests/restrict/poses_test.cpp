// Poses that people can and cannot take, against the regions.
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <map>
#include <string>
#include <vector>

#include "restrict/range_of_motion.h"

namespace ukemi {
namespace {

struct KnownPose {
  std::string name;
  std::optional<bool> inside;  // nothing: borderline
  std::map<Joint, SwingTwist> joints;
};

std::vector<KnownPose> known_poses() {
  const toml::table document = toml::parse_file(UKEMI_TEST_DATA "/poses.toml");
  std::vector<KnownPose> poses;
  for (const toml::node& node : *document["pose"].as_array()) {
    const toml::table& table = *node.as_table();
    KnownPose pose{table["name"].value_or<std::string>(""), table["inside"].value<bool>(), {}};
    for (const auto& [key, value] : table)
      if (const auto joint = joint_named(key.str())) {
        const toml::array& a = *value.as_array();
        const auto angle = [&](std::size_t i) { return radians(a[i].value_or<double>(0.0)); };
        pose.joints[*joint] = {{angle(0), angle(1)}, angle(2)};
      }
    poses.push_back(std::move(pose));
  }
  return poses;
}

/// Degrees outside, of the joint that is furthest outside.
double excess_deg(const RangeOfMotion& range, const KnownPose& pose) {
  double worst = 0.0;
  for (const auto& [joint, chart] : pose.joints)
    worst = std::max(worst, degrees(excess(range.joints[index(joint)], chart)));
  return worst;
}

struct Judged {
  int ordinary_rejected = 0, impossible_accepted = 0;
};

Judged judge(const std::string& region) {
  const auto range = load_range_of_motion(region);
  EXPECT_TRUE(range);
  Judged judged;
  for (const KnownPose& pose : known_poses()) {
    if (!pose.inside) continue;
    const bool inside = excess_deg(*range, pose) == 0.0;
    judged.ordinary_rejected += *pose.inside && !inside;
    judged.impossible_accepted += !*pose.inside && inside;
  }
  return judged;
}

TEST(Poses, TheHumanRegionJudgesEveryKnownPoseRight) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  const std::vector<KnownPose> poses = known_poses();
  EXPECT_EQ(poses.size(), 55u);
  for (const KnownPose& pose : poses) {
    ASSERT_FALSE(pose.joints.empty()) << pose.name;
    if (!pose.inside) continue;
    EXPECT_EQ(excess_deg(*range, pose) == 0.0, *pose.inside) << pose.name;
  }
}

TEST(Poses, IndependentRangesOfTheAxesLetImpossiblePosesPass) {
  EXPECT_GE(judge("box").impossible_accepted, 4);
}

TEST(Poses, FourTrianglesRejectOrdinaryPoses) { EXPECT_GE(judge("diamond").ordinary_rejected, 7); }

TEST(Poses, AMeaningChangesSidesWithTheJoint) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  const JointRange& right = range->joints[index(Joint::hip_r)];
  EXPECT_EQ(right.meanings[0].positive, "adduction");
  EXPECT_EQ(right.meanings[1].negative, "extension");
  const JointRange other = mirrored(right);
  EXPECT_EQ(other.meanings[0].positive, "abduction");
  EXPECT_EQ(other.meanings[1].positive, "flexion");
  EXPECT_EQ(other.meanings[2].positive, "internal rotation");
  for (int j = 0; j < kJointCount; ++j) {
    const JointRange mirror = mirrored(range->joints[index(mirror_of(joint_at(j)))]);
    for (int axis = 0; axis < 3 && mirror_of(joint_at(j)) != joint_at(j); ++axis)
      EXPECT_EQ(range->joints[j].meanings[axis].positive, mirror.meanings[axis].positive)
          << name(joint_at(j));
  }
}

TEST(Poses, AMeaningWithoutBothSignsIsRefused) {
  const auto range = parse_range_of_motion(R"(base = "human"
[[joint]]
name = "elbow_r"
meaning_a_y = "play"
)",
                                           "mine.toml");
  ASSERT_FALSE(range);
  EXPECT_EQ(range.error().line, 4);
  EXPECT_EQ(range.error().joint, "elbow_r");
}

TEST(Poses, ThePolygonsAreaIsThatOfItsTriangles) {
  EXPECT_NEAR(polygon_area({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}), 2.0, 1e-15);
  EXPECT_NEAR(polygon_area({{2, -1}, {2, 1}, {-2, 1}, {-2, -1}}), 8.0, 1e-15);
}

}  // namespace
}  // namespace ukemi
