#include "base/animation.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

/// A skeleton of two nodes, at rest one unit up.
Skeleton pair_of_nodes() {
  Skeleton skeleton;
  for (const int parent : {-1, 0})
    skeleton.nodes.push_back(
        {"n" + std::to_string(parent + 1), parent, {Vec3::UnitY(), Quat::Identity(), Vec3::Ones()}});
  EXPECT_TRUE(skeleton.sort());
  return skeleton;
}

Animation of(Track track) {
  Animation animation{"moves", track.times.front(), track.times.back(), 0.0, {}};
  animation.tracks.push_back(std::move(track));
  return animation;
}

LocalTransform root_at(const Animation& animation, double time_s) {
  return sample(pair_of_nodes(), animation, time_s)[0];
}

TEST(Sample, LinearRotationsTurnEvenlyOnTheShorterArc) {
  const Quat turned = exp_rotation(Vec3(0, 0, 1.2));
  const Animation animation = of({0,
                                  TrackPath::rotation,
                                  Interpolation::linear,
                                  {1.0, 3.0},
                                  {0, 0, 0, 1, -turned.x(), -turned.y(), -turned.z(), -turned.w()}});
  for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0})
    EXPECT_LT(
        angle_between(root_at(animation, 1.0 + 2.0 * share).rotation, exp_rotation(Vec3(0, 0, 1.2 * share))),
        1e-12)
        << share;
}

TEST(Sample, CubicTangentsArePerSecond) {
  // x = t^3, which one cubic piece holds exactly: in-tangent, value, out-tangent of each key.
  const Animation animation = of({0,
                                  TrackPath::translation,
                                  Interpolation::cubic,
                                  {0.0, 2.0},
                                  {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 12, 0, 0}});
  for (const double t : {0.0, 0.5, 1.0, 1.7, 2.0})
    EXPECT_NEAR(root_at(animation, t).translation.x(), t * t * t, 1e-12) << t;
}

TEST(Sample, StepsHoldAndEveryTrackIsClampedToItsKeys) {
  const Animation steps = of({0, TrackPath::scale, Interpolation::step, {1.0, 2.0}, {1, 1, 1, 3, 3, 3}});
  EXPECT_EQ(root_at(steps, 0.0).scale.x(), 1.0);
  EXPECT_EQ(root_at(steps, 1.99).scale.x(), 1.0);
  EXPECT_EQ(root_at(steps, 2.0).scale.x(), 3.0);
  EXPECT_EQ(root_at(steps, 9.0).scale.x(), 3.0);
}

TEST(Sample, WhatNoTrackMovesKeepsItsRestTransform) {
  const Skeleton skeleton = pair_of_nodes();
  const Animation animation =
      of({1, TrackPath::translation, Interpolation::linear, {0.0, 1.0}, {0, 0, 0, 2, 0, 0}});
  const Pose pose = sample(skeleton, animation, 0.5);
  EXPECT_EQ(pose[0].translation, Vec3::UnitY());
  EXPECT_EQ(pose[1].translation, Vec3::UnitX());
}

TEST(SampleClip, BeginsAtTheFirstKeyAndHoldsBothEnds) {
  const Animation animation =
      of({0, TrackPath::translation, Interpolation::linear, {2.0, 3.0}, {0, 0, 0, 1, 0, 0}});
  const Clip clip = sample_clip(pair_of_nodes(), animation, 10.0);
  ASSERT_EQ(clip.frames.size(), 11u);
  for (int f = 0; f <= 10; ++f) EXPECT_NEAR(clip.frames[f][0].translation.x(), 0.1 * f, 1e-12);
  EXPECT_NEAR(clip.duration_s(), 1.0, 1e-12);
}

}  // namespace
}  // namespace ukemi
