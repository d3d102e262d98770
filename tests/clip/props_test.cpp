// Props before the impact and after the end of the simulation: they come as they were thrown and go on as
// they went.
#include <gtest/gtest.h>

#include "clip/lead.h"
#include "clip/recovery.h"
#include "export/puppet.h"

namespace ukemi {
namespace {

constexpr double kFps = 50.0;
constexpr double kGravity = 10.0;

/// The puppet at rest, and a clip of it with one prop.
struct Stage {
  test::Puppet puppet = test::make_puppet();
  Start start;
  ArticulatedBody body;
  Timeline timeline;

  explicit Stage(const Prop& prop) {
    const Skeleton& skeleton = puppet.character.skeleton;
    start.pose = rest_pose(skeleton);
    start.segments = canonical_segments_of(skeleton, puppet.humanoid, start.pose);
    start.state.segments = start.segments;
    Trajectory trajectory;
    trajectory.fps = kFps;
    trajectory.frames.assign(prop.poses.size(), start.segments);
    trajectory.props = {prop};
    ResampleError error;
    timeline = timeline_of(actor(), std::move(trajectory), "hit", error);
  }
  Actor actor() const { return {puppet.character, puppet.humanoid, start, body}; }
  const std::vector<Rigid>& poses() const { return timeline.trajectory.props[0].poses; }
};

/// A ball or box at some places, one frame after the other.
Prop moving(Prop::Kind kind, const std::vector<Vec3>& places) {
  Prop prop;
  prop.kind = kind;
  prop.radius = 0.1;
  prop.size = Vec3(0.4, 0.4, 0.4);
  for (const Vec3& place : places) prop.poses.push_back({Quat::Identity(), place});
  return prop;
}

Scene thrown(SceneKind kind) {
  Scene scene;
  scene.kind = kind;
  scene.direction = -Vec3::UnitX();
  scene.ball_speed_m_s = 6.0;
  scene.slope_rad = radians(30.0);
  return scene;
}

/// Places `time_s` before the impact, where a clip has 0.2 s of lead.
Vec3 before(SceneKind kind, const Prop& prop, double time_s) {
  Stage stage(prop);
  add_lead(stage.actor(), thrown(kind), kGravity, 0.2, stage.timeline);
  EXPECT_EQ(stage.poses().size(), prop.poses.size() + 10);
  EXPECT_EQ(stage.poses().size(), stage.timeline.clip.frames.size());
  EXPECT_EQ(stage.poses()[10].translation, prop.poses[0].translation) << "the impact stays as it is";
  return stage.poses()[static_cast<std::size_t>(std::lround((0.2 - time_s) * kFps))].translation;
}

void expect_near(const Vec3& is, const Vec3& wanted) {
  EXPECT_LT((is - wanted).norm(), 1e-9) << is.transpose() << ", wanted " << wanted.transpose();
}

TEST(PropsBefore, ABallFlewInAnArc) {
  const Prop ball = moving(Prop::Kind::ball, {{0.3, 1.4, 0.1}, {0.2, 1.4, 0.1}});
  expect_near(before(SceneKind::ball, ball, 0.2), {0.3 + 1.2, 1.4 - 0.2, 0.1});
  expect_near(before(SceneKind::ball, ball, 0.1), {0.3 + 0.6, 1.4 - 0.05, 0.1});
  const Prop low = moving(Prop::Kind::ball, {{0.3, 0.15, 0.1}, {0.2, 0.15, 0.1}});
  expect_near(before(SceneKind::ball, low, 0.2), {0.3 + 1.2, 0.1, 0.1});  // not through the floor
}

TEST(PropsBefore, ABoxSlidAndARampsBallRolledDown) {
  const Prop box = moving(Prop::Kind::box, {{0.3, 0.2, 0.1}, {0.2, 0.2, 0.1}});
  expect_near(before(SceneKind::box, box, 0.2), {0.3 + 1.2, 0.2, 0.1});
  const Prop ball = moving(Prop::Kind::ball, {{0.3, 0.1, 0.1}, {0.2, 0.1, 0.1}});
  expect_near(before(SceneKind::slope, ball, 0.2), {0.3 + 1.2 * std::cos(radians(30.0)), 0.1 + 0.6, 0.1});
}

TEST(PropsBefore, MarksAndImpactMoveWithTheLead) {
  Stage stage(moving(Prop::Kind::ball, {{0.3, 1.4, 0.1}, {0.2, 1.4, 0.1}}));
  add_lead(stage.actor(), thrown(SceneKind::ball), kGravity, 0.2, stage.timeline);
  EXPECT_DOUBLE_EQ(stage.timeline.impact_s, 0.2);
  std::map<std::string, double> marks;
  for (const Mark& mark : stage.timeline.clip.marks) marks[mark.name] = mark.time_s;
  EXPECT_EQ(marks, (std::map<std::string, double>{{"start", 0.0}, {"impact", 0.2}}));
}

/// Places after the end, where a clip goes back to its start in 1 s.
std::vector<Rigid> after(const Prop& prop) {
  Stage stage(prop);
  const Status status = add_recovery(stage.actor(), 1.0, {RecoverTo::rest, std::nullopt}, kGravity, stage.timeline);
  EXPECT_TRUE(status) << status.error().message();
  EXPECT_EQ(stage.poses().size(), prop.poses.size() + 50);
  EXPECT_EQ(stage.poses().size(), stage.timeline.clip.frames.size());
  return {stage.poses().begin() + static_cast<std::ptrdiff_t>(prop.poses.size()), stage.poses().end()};
}

TEST(PropsAfter, ABallFliesOnAndLiesOnTheFloor) {
  const std::vector<Rigid> poses =
      after(moving(Prop::Kind::ball, {{0.0, 1.4, 0.0}, {-0.04, 1.4, 0.02}}));     // 2 m/s, 1 m/s
  expect_near(poses[9].translation, {-0.04 - 2.0 * 0.2, 1.4 - 0.2, 0.02 + 0.2});  // 0.2 s later
  double low = 1e9;
  for (const Rigid& pose : poses) low = std::min(low, pose.translation.y());
  EXPECT_NEAR(low, 0.1, 1e-9) << "its radius above the floor";
  expect_near(poses.back().translation, poses[poses.size() - 2].translation);
  EXPECT_LT(poses.back().translation.x(), -1.0) << "falls for half a second at 2 m/s";
}

TEST(PropsAfter, WhatStandsStaysAndWhatNeverMovesHasOnePose) {
  const Vec3 place(0.5, 0.2, 0.0);
  expect_near(after(moving(Prop::Kind::box, {place, place})).back().translation, place);
}

}  // namespace
}  // namespace ukemi
