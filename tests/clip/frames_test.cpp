#include "clip/frames.h"

#include <gtest/gtest.h>

#include "clip/extras.h"
#include "judge/rom_figures.h"

namespace ukemi {
namespace {

/// One node per segment, each on its parent's.
struct Puppet {
  Skeleton skeleton;
  Humanoid humanoid;

  Puppet() {
    for (int i = 0; i < kSegmentCount; ++i) {
      const Segment segment = segment_at(i);
      const int parent = segment == Segment::pelvis ? -1 : index(parent_of(segment));
      skeleton.nodes.push_back({std::string(name(segment)), parent, {}});
      humanoid.segments[i].chain = {i};
    }
    EXPECT_TRUE(skeleton.sort());
    humanoid.node_from_segment.fill(Quat::Identity());
  }
};

TEST(Frames, ComeBackFromTheExtras) {
  Puppet puppet;
  puppet.humanoid.segments[index(Segment::hand_l)].chain.clear();
  BodyPose segments;
  for (int i = 0; i < kSegmentCount; ++i) segments[i].rotation = exp_rotation(Vec3(0.1 * i, 0.2, -0.05 * i));
  const Pose pose = rest_pose(puppet.skeleton);
  const SegmentFrames frames = segment_frames(puppet.skeleton, puppet.humanoid, pose, segments);
  const auto read = frames_in_extras(puppet.skeleton, animation_extras(puppet.skeleton, frames));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->node, frames.node);
  EXPECT_EQ(read->node[index(Segment::hand_l)], -1);
  const PerSegment<Quat> rotations = rotations_of(puppet.skeleton, *read, pose);
  for (int i = 0; i < kSegmentCount; ++i) {
    if (frames.node[i] < 0) continue;
    EXPECT_LT(angle_between(rotations[i], segments[i].rotation), 1e-12) << i;
  }
  EXPECT_LT(angle_between(rotations[index(Segment::hand_l)], rotations[index(Segment::forearm_l)]), 1e-12);
}

TEST(Frames, RangesThatAreNotTheHumanOnesComeBackFromTheExtras) {
  const Puppet puppet;
  const auto human = load_range_of_motion("human");
  ASSERT_TRUE(human);
  JointRange wide = human->joints[index(Joint::elbow_l)];
  EXPECT_GT(widen_to_hold(wide, {Vec2(0.3, -0.6), 0.0}, 0.05), 0.0);
  ClipFacts facts;
  facts.ranges = {{Joint::elbow_l, wide}};
  const std::string extras = animation_extras(puppet.skeleton, {}, {}, facts);
  const RangeOfMotion read = range_in_extras(*human, extras);
  EXPECT_EQ(read.joints[index(Joint::elbow_l)].polygon, wide.polygon);
  EXPECT_EQ(read.joints[index(Joint::elbow_r)].polygon, human->joints[index(Joint::elbow_r)].polygon);
  EXPECT_EQ(excess(read.joints[index(Joint::elbow_l)], {Vec2(0.3, -0.6), 0.0}), 0.0);
  for (const char* bad : {"", "[]", R"({"ukemi":{"ranges":7}})", R"({"ukemi":{"ranges":{"elbow_l":{}}}})",
                          R"({"ukemi":{"ranges":{"elbow_l":{"polygon":[[1,1],[2,1],[2,2]],"twist":[0,0],)"
                          R"("parent_from_joint":[0,0,0,1],"reference":[0,0,0,1]}}}})"})
    EXPECT_EQ(range_in_extras(*human, bad).joints[index(Joint::elbow_l)].polygon,
              human->joints[index(Joint::elbow_l)].polygon)
        << bad;
}

TEST(Frames, OfASkeletonWithOtherAxesGiveTheSameSegments) {
  const Puppet puppet;
  const Pose pose = rest_pose(puppet.skeleton);
  BodyPose segments{};
  for (int i = 0; i < kSegmentCount; ++i) segments[i].rotation = exp_rotation(Vec3(0.1 * i, 0.2, -0.05 * i));
  const SegmentFrames frames = segment_frames(puppet.skeleton, puppet.humanoid, pose, segments);
  Skeleton second = puppet.skeleton;  // stands in another world, with bones that have other axes
  const Quat turn = exp_rotation(Vec3(0.3, -0.4, 0.5));
  for (Node& node : second.nodes) node.rest.rotation = exp_rotation(Vec3(0.2, 0.7, 0.1)) * node.rest.rotation;
  std::vector<int> nodes;
  for (int i = 0; i < second.size(); ++i) nodes.push_back(i);
  const SegmentFrames moved =
      moved_frames(puppet.skeleton, frames, pose, turn, nodes, second, rest_pose(second));
  const auto first = rotations_of(puppet.skeleton, frames, pose);
  const auto other = rotations_of(second, moved, rest_pose(second));
  for (int i = 0; i < kSegmentCount; ++i) EXPECT_LT(angle_between(other[i], turn * first[i]), 1e-9) << i;
  nodes.pop_back();
  nodes.assign(nodes.size(), -5);
  EXPECT_EQ(moved_frames(puppet.skeleton, frames, pose, turn, nodes, second, pose).node[0], -1);
}

TEST(Frames, TheRateOfTheBakeGoesBesideThem) {
  const Puppet puppet;
  const std::string extras = animation_extras(puppet.skeleton, {}, {{"impact", 0.25}}, ClipFacts{});
  EXPECT_EQ(extras.find("fps"), std::string::npos);
  const std::string told = with_fps(extras, 30.0);
  EXPECT_NE(told.find(R"("fps":30.0)"), std::string::npos) << told;
  EXPECT_EQ(marks_in_extras(told).size(), 1u);
}

TEST(Frames, OfOtherExtrasAreNone) {
  const Puppet puppet;
  const SegmentFrames frames =
      segment_frames(puppet.skeleton, puppet.humanoid, rest_pose(puppet.skeleton), {});
  std::string extras = animation_extras(puppet.skeleton, frames);
  Skeleton other = puppet.skeleton;
  other.nodes[index(Segment::head)].name = "skull";
  EXPECT_FALSE(frames_in_extras(other, extras)) << "a node that is not there";
  EXPECT_FALSE(frames_in_extras(puppet.skeleton, ""));
  EXPECT_FALSE(frames_in_extras(puppet.skeleton, "[1]"));
  EXPECT_FALSE(frames_in_extras(puppet.skeleton, R"({"ukemi":{"segments":{"pelvis":null}}})"));
  EXPECT_FALSE(frames_in_extras(puppet.skeleton, extras.substr(1)));
  const auto rotation = extras.find("\"segment_from_node\":[");
  extras.insert(rotation + 21, "7");
  EXPECT_FALSE(frames_in_extras(puppet.skeleton, extras)) << "not a unit quaternion";
}

// The left knee bends about an axis that is not the hinge's: canonical rolls follow it from frame to frame,
// stored ones see the side bend.
TEST(Frames, MarksComeBackFromTheExtras) {
  SegmentFrames none;
  none.node.fill(-1);
  const std::vector<Mark> marks =
      marks_in_extras(animation_extras({}, none, {{"impact", 0.25}, {"rest", 2.0}}));
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].name, "impact");
  EXPECT_EQ(marks[1].time_s, 2.0);
  for (const char* other :
       {"", "[1]", "{}", R"({"ukemi":{"marks":3}})", R"({"ukemi":{"marks":[{"name":"a"}]}})",
        R"({"ukemi":{"marks":[{"name":1,"time_s":0}]}})"})
    EXPECT_TRUE(marks_in_extras(other).empty()) << other;
}

TEST(Frames, StoredRollsAreKeptOverTheClip) {
  const Puppet puppet;
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  const Pose still = rest_pose(puppet.skeleton);
  const SegmentFrames stored = segment_frames(puppet.skeleton, puppet.humanoid, still, BodyPose{});
  Pose bent = still;
  bent[index(Segment::shank_l)].rotation = exp_rotation(radians(60.0) * Vec3(0.5, 0, -0.8).normalized());
  const auto excess_of = [&](const std::optional<SegmentFrames>& frames) {
    const RomPaths paths = rom_paths(puppet.skeleton, puppet.humanoid, *range, {bent}, frames);
    return rom_figures(paths.joints[index(Joint::knee_l)]).excess_max_deg;
  };
  EXPECT_GT(excess_of(stored), 10.0);
  EXPECT_LT(excess_of({}), 5.0);
  EXPECT_EQ(rom_paths(puppet.skeleton, puppet.humanoid, *range, {bent}, stored).rolls, Rolls::stored);
}

TEST(RomFigures, CountTheFramesOfEachJoint) {
  RomPaths paths;
  paths.joints[index(Joint::neck)] = {std::vector<SwingTwist>(4), {0.0, 0.5, 2.0, 6.0}};
  paths.joints[index(Joint::spine)] = {std::vector<SwingTwist>(4), {0.0, 0.0, 0.0, 0.0}};
  const RomFigures figures = rom_figures(paths);
  EXPECT_DOUBLE_EQ(figures.joints[index(Joint::neck)]->over_1deg_fraction, 0.5);
  EXPECT_DOUBLE_EQ(figures.joints[index(Joint::neck)]->over_5deg_fraction, 0.25);
  EXPECT_DOUBLE_EQ(figures.over_1deg_fraction, 0.25) << "of the samples of both joints";
  EXPECT_DOUBLE_EQ(figures.excess_max_deg, 6.0);
  EXPECT_EQ(figures.worst_joint, Joint::neck);
  EXPECT_FALSE(figures.joints[index(Joint::chest)]);
}

}  // namespace
}  // namespace ukemi
