#include "base/skeleton.h"

#include <gtest/gtest.h>

#include "base/animation.h"
#include "base/segments.h"

namespace ukemi {
namespace {

Skeleton chain(std::vector<int> parents) {
  Skeleton skeleton;
  for (const int parent : parents)
    skeleton.nodes.push_back(
        {"n" + std::to_string(skeleton.nodes.size()), parent, {{0, 1, 0}, Quat::Identity(), Vec3::Ones()}});
  return skeleton;
}

TEST(Skeleton, SortsParentsBeforeChildrenAndRefusesCycles) {
  Skeleton good = chain({2, 0, -1});
  ASSERT_TRUE(good.sort());
  EXPECT_EQ(good.order, (std::vector<int>{2, 0, 1}));
  Skeleton cycle = chain({1, 0, -1});
  EXPECT_FALSE(cycle.sort());
  Skeleton outside = chain({-1, 7});
  EXPECT_FALSE(outside.sort());
}

TEST(Skeleton, FindsUniqueNamesAndIndices) {
  Skeleton skeleton = chain({-1, 0, 0});
  skeleton.nodes[2].name = "n1";
  EXPECT_EQ(skeleton.find("n0"), 0);
  EXPECT_EQ(skeleton.find("n1"), -1) << "two nodes share the name";
  EXPECT_EQ(skeleton.find("#2"), 2);
  EXPECT_EQ(skeleton.find("#3"), -1);
  EXPECT_EQ(skeleton.find(skeleton.label(1)), 1);
}

TEST(Skeleton, WorldTransformsFollowTheHierarchy) {
  Skeleton skeleton = chain({2, 0, -1});
  ASSERT_TRUE(skeleton.sort());
  skeleton.nodes[2].rest.rotation = exp_rotation(Vec3(0, 0, kPi / 2));
  const auto world = world_transforms(skeleton, rest_pose(skeleton));
  EXPECT_LT((world[1].translation() - Vec3(-2, 1, 0)).norm(), 1e-12);
}

TEST(Animation, SamplesStepLinearAndCubic) {
  Skeleton skeleton = chain({-1});
  ASSERT_TRUE(skeleton.sort());
  Animation animation{"a", 0, 1, 0, {}};
  animation.tracks.push_back({0, TrackPath::translation, Interpolation::linear, {0, 1}, {0, 0, 0, 2, 0, 0}});
  EXPECT_DOUBLE_EQ(sample(skeleton, animation, 0.25)[0].translation.x(), 0.5);
  animation.tracks[0].interpolation = Interpolation::step;
  EXPECT_DOUBLE_EQ(sample(skeleton, animation, 0.99)[0].translation.x(), 0.0);
  // Cubic with tangents of a straight line is the line.
  animation.tracks[0].interpolation = Interpolation::cubic;
  animation.tracks[0].values = {2, 0, 0, 0, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0};
  EXPECT_NEAR(sample(skeleton, animation, 0.25)[0].translation.x(), 0.5, 1e-15);
  EXPECT_DOUBLE_EQ(sample(skeleton, animation, 5.0)[0].translation.x(), 2.0);
}

TEST(Segments, EverySegmentHasItsJointAndItsMirror) {
  for (int j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(joint_named(name(joint_at(j))), joint_at(j));
    EXPECT_EQ(mirror_of(mirror_of(joint_at(j))), joint_at(j));
    EXPECT_EQ(is_left(joint_at(j)), is_right(mirror_of(joint_at(j))));
    EXPECT_LT(index(parent_of(joint_at(j))), index(child_of(joint_at(j))));
  }
  EXPECT_EQ(parent_of(Segment::clavicle_r), Segment::chest);
  EXPECT_EQ(mirror_of(Joint::knee_l), Joint::knee_r);
}

TEST(Animation, ADayIsSampledAsOftenAsMemoryAllows) {
  const Skeleton skeleton = [] {
    Skeleton made = chain(std::vector<int>(50, -1));
    EXPECT_TRUE(made.sort());
    return made;
  }();
  Animation day{"day", 0.0, 86400.0, 0.0, {}};
  day.tracks.push_back(
      {0, TrackPath::translation, Interpolation::linear, {0.0, 86400.0}, {0, 0, 0, 1, 0, 0}});
  const Clip clip = sample_clip(skeleton, day, 60.0);
  EXPECT_EQ(clip.frames.size(), 100001u);
  EXPECT_NEAR(clip.duration_s(), 86400.0, 1e-6);
  EXPECT_NEAR(clip.frames.back()[0].translation.x(), 1.0, 1e-9);
}

TEST(Skeleton, NodesGoByNamesThatABvhCanHold) {
  EXPECT_EQ(plain_name("Left Arm{1}\t"), "Left_Arm_1__");
  Skeleton skeleton;
  for (const char* name : {"Chest", "Left Arm", "Left_Arm", "", "Chest"})
    skeleton.nodes.push_back({name, -1, {}});
  const auto all = nodes_by_plain_name(skeleton);
  EXPECT_EQ(all.at("Chest"), -1) << "two have it";
  EXPECT_EQ(all.at("Left_Arm"), -1);
  EXPECT_EQ(all.size(), 2u);
  EXPECT_EQ(nodes_by_plain_name(skeleton, {1, 1, 0, 1, 0}).at("Chest"), 0);
}

}  // namespace
}  // namespace ukemi
