// Additive clips that this program wrote, read as the poses that they make.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace ukemi {
namespace {

const Quat kFrom(Eigen::AngleAxisd(0.9, Vec3::UnitX()));  // the spine in the pose that is differed from
const Quat kBy(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));    // and by how much

/// The spine of a square turns by kBy, on top of what the extras say.
Pose read_pose(const test::Json& extras) {
  test::Document d = test::skinned_square();
  const auto turn = [](const Quat& q) {
    return std::vector<float>{static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                              static_cast<float>(q.w())};
  };
  std::vector<float> keys;
  for (int i = 0; i < 3; ++i)
    for (const float value : turn(kBy)) keys.push_back(value);
  d.json["animations"][0]["samplers"][0]["output"] = d.floats(keys, "VEC4", 4);
  d.json["animations"][0]["extras"] = {{"ukemi", extras}};
  const auto character = test::read(d.glb());
  EXPECT_TRUE(character) << character.error().message();
  return sample(character->skeleton, character->animations.at(0), 1.0);
}

test::Json from_pose() {
  return {
      {"spine", {{"translation", {0, 0.6, 0}}, {"rotation", {kFrom.x(), kFrom.y(), kFrom.z(), kFrom.w()}}}}};
}

TEST(Additive, ADifferenceIsTurnedInTheFrameOfWhatItStandsOn) {
  const Pose pose = read_pose({{"additive", true}, {"from", from_pose()}});
  EXPECT_LT(angle_between(pose[1].rotation, kFrom * kBy), 1e-6);
  EXPECT_GT(angle_between(pose[1].rotation, kBy * kFrom), 0.1) << "the other side";
}

TEST(Additive, WhatDoesNotDifferStaysAsInThePose) {
  const Pose pose = read_pose({{"additive", true}, {"from", from_pose()}});
  EXPECT_LT((pose[1].translation - Vec3(0, 0.6, 0)).norm(), 1e-6);
  EXPECT_LT((pose[0].translation - Vec3(0, 1, 0)).norm(), 1e-6) << "of the rest pose";
}

TEST(Additive, OnlyWhereTheExtrasSaySo) {
  EXPECT_LT(angle_between(read_pose({{"additive", false}, {"from", from_pose()}})[1].rotation, kBy), 1e-6);
  EXPECT_LT(angle_between(read_pose({{"from", from_pose()}})[1].rotation, kBy), 1e-6);
}

}  // namespace
}  // namespace ukemi
