#include "clip/resample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "export/puppet.h"

namespace ukemi {
namespace {

/// The puppet with one node for every segment.
test::Puppet single_bones() {
  test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  puppet.humanoid.segments[index(Segment::abdomen)].chain = {skeleton.find("Spine")};
  puppet.humanoid.segments[index(Segment::head)].chain = {skeleton.find("Neck")};
  return puppet;
}

/// Segments whose joints hold together: every segment turns about the joint above it.
Trajectory swinging(const BodyPose& start, int frames, double fps) {
  Trajectory trajectory;
  trajectory.fps = fps;
  for (int f = 0; f < frames; ++f) {
    const double t = f / fps;
    BodyPose now = start;
    for (int s = 0; s < kSegmentCount; ++s) {
      const Vec3 axis = Vec3(std::sin(1.0 + s), std::cos(2.0 * s), std::sin(3.0 * s)).normalized();
      const Quat turn = exp_rotation(axis * (0.2 * s * t + 0.8 * std::sin(5 * t)));
      now[s].rotation = turn * start[s].rotation;
      const int parent = index(parent_of(segment_at(s)));
      if (s == parent)
        now[s].translation += Vec3(t, 0.3 * t * t, -t);
      else
        now[s].translation = now[parent] * (start[parent].inverse() * start[s].translation);
    }
    trajectory.frames.push_back(now);
  }
  return trajectory;
}

TEST(Resample, TurnsAndMovesEveryNodeAsItsSegmentDoes) {
  const test::Puppet puppet = single_bones();
  const Skeleton& skeleton = puppet.character.skeleton;
  Pose start = rest_pose(skeleton);
  for (std::size_t i = 1; i < start.size(); ++i)
    start[i].rotation = start[i].rotation * exp_rotation(Vec3(0.3 * std::sin(i), 0.2, 0.1));
  const BodyPose segments = segments_of(skeleton, puppet.humanoid, start);
  const Trajectory trajectory = swinging(segments, 61, 30);
  ResampleError error;
  const Clip clip = resample(puppet.character, puppet.humanoid, start, segments, trajectory, error);
  ASSERT_EQ(clip.frames.size(), 61u);
  EXPECT_EQ(clip.fps, 30.0);
  EXPECT_LT(error.position_max_m, 1e-9);
  EXPECT_LT(error.rotation_max_deg, 1e-6);
  const auto before = world_transforms(skeleton, start);
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    const auto now = world_transforms(skeleton, clip.frames[f]);
    for (int s = 0; s < kSegmentCount; ++s) {
      const int node = puppet.humanoid.segments[s].node();
      const Rigid motion = trajectory.frames[f][s] * segments[s].inverse();
      EXPECT_LT((now[node].translation() - motion * Vec3(before[node].translation())).norm(), 1e-9);
      EXPECT_LT((now[node].linear() - motion.rotation * before[node].linear()).norm(), 1e-9);
    }
  }
}

TEST(Resample, BeginsWithTheStartPoseToTheBitAndKeepsSigns) {
  const test::Puppet puppet = single_bones();
  const Skeleton& skeleton = puppet.character.skeleton;
  Pose start = rest_pose(skeleton);
  start[3].rotation = exp_rotation(Vec3(0.1, 0.2, 0.3));
  start[3].rotation.coeffs() = -start[3].rotation.coeffs();
  const BodyPose segments = segments_of(skeleton, puppet.humanoid, start);
  ResampleError error;
  const Clip clip =
      resample(puppet.character, puppet.humanoid, start, segments, swinging(segments, 601, 60), error);
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(clip.frames[0][i].rotation.coeffs(), start[i].rotation.coeffs());
    EXPECT_EQ(clip.frames[0][i].translation, start[i].translation);
    for (std::size_t f = 1; f < clip.frames.size(); ++f)
      ASSERT_GT(clip.frames[f][i].rotation.dot(clip.frames[f - 1][i].rotation), 0.0)
          << i << " at frame " << f;
  }
}

TEST(Resample, MeasuresHowFarTheSimulatedJointsComeApart) {
  const test::Puppet puppet = single_bones();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Pose start = rest_pose(skeleton);
  const BodyPose segments = segments_of(skeleton, puppet.humanoid, start);
  Trajectory trajectory = swinging(segments, 10, 60);
  trajectory.frames[7][index(Segment::hand_l)].translation += Vec3(0, 0.005, 0);
  ResampleError error;
  const Clip clip = resample(puppet.character, puppet.humanoid, start, segments, trajectory, error);
  EXPECT_NEAR(error.position_max_m, 0.005, 1e-9);
  EXPECT_NEAR(error.position_single_bones_max_m, 0.005, 1e-9);
  EXPECT_LT(error.rotation_max_deg, 1e-6);
}

/// A node of three scales cannot turn what hangs on it without shearing it.
TEST(Resample, MeasuresTheTurnsThatARigCannotTake) {
  test::Puppet puppet = single_bones();
  Skeleton& skeleton = puppet.character.skeleton;
  skeleton.nodes[skeleton.find("LeftArm")].rest.scale = Vec3(1.0, 1.4, 1.0);
  const Pose start = rest_pose(skeleton);
  const BodyPose segments = segments_of(skeleton, puppet.humanoid, start);
  const Trajectory trajectory = swinging(segments, 10, 60);
  ResampleError error;
  const Clip clip = resample(puppet.character, puppet.humanoid, start, segments, trajectory, error);
  double seen_deg = 0.0;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    const BodyPose rig = segments_of(skeleton, puppet.humanoid, clip.frames[f]);
    for (int s = 0; s < kSegmentCount; ++s)
      seen_deg =
          std::max(seen_deg, degrees(angle_between(rig[s].rotation, trajectory.frames[f][s].rotation)));
  }
  EXPECT_GT(seen_deg, 0.5);
  EXPECT_NEAR(error.rotation_max_deg, seen_deg, 1e-6);
}

TEST(Resample, SharesABendAmongTheBonesOfASegment) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Pose start = rest_pose(skeleton);
  const BodyPose segments = segments_of(skeleton, puppet.humanoid, start);
  Trajectory trajectory;
  trajectory.frames = {segments};
  // The trunk above the pelvis and the arms bend forward as one about the joint of the abdomen.
  BodyPose& bent = trajectory.frames[0];
  const Rigid bend{exp_rotation(Vec3(0.6, 0, 0)), Vec3::Zero()};
  const Rigid about{Quat::Identity(), segments[index(Segment::abdomen)].translation};
  for (int s = index(Segment::abdomen); s <= index(Segment::hand_r); ++s)
    bent[s] = about * bend * about.inverse() * segments[s];
  ResampleError error;
  const Clip clip = resample(puppet.character, puppet.humanoid, start, segments, trajectory, error);
  const auto turned = [&](const char* name) {
    const int i = skeleton.find(name);
    return angle_between(clip.frames[0][i].rotation, start[i].rotation);
  };
  EXPECT_NEAR(turned("Spine"), 0.3, 1e-9);
  EXPECT_NEAR(turned("Spine1"), 0.3, 1e-9);
  EXPECT_NEAR(turned("Spine2"), 0.0, 1e-7);
  // 12 cm between the bones of the abdomen, 9 cm between those of the head, which does not bend on the chest.
  EXPECT_NEAR(error.position_max_m, 0.12 * (1 - std::cos(0.3)), 1e-9);
  EXPECT_LT(error.position_single_bones_max_m, 1e-9);
  EXPECT_LT(error.rotation_max_deg, 1e-6) << "the last bone carries the segment's rotation";
}

}  // namespace
}  // namespace ukemi
