#include "export/vrma.h"

#include <gtest/gtest.h>

#include "load/load.h"

namespace ukemi {
namespace {

/// Somebody who stands along the axes: the neutral pose, turned to face +z, arms hanging.
BodyPose standing() {
  BodyPose pose;
  Mat3 axes;
  axes.col(0) = Vec3::UnitZ();
  axes.col(1) = Vec3::UnitY();
  axes.col(2) = -Vec3::UnitX();
  for (Rigid& segment : pose) segment.rotation = Quat(axes);
  const auto put = [&](Segment s, double x, double y) { pose[index(s)].translation = Vec3(x, y, 0); };
  put(Segment::pelvis, 0, 0.95), put(Segment::abdomen, 0, 1.05), put(Segment::chest, 0, 1.2);
  put(Segment::head, 0, 1.5);
  put(Segment::clavicle_l, 0.03, 1.42), put(Segment::upperarm_l, 0.18, 1.42),
      put(Segment::forearm_l, 0.18, 1.12);
  put(Segment::hand_l, 0.18, 0.86);
  put(Segment::clavicle_r, -0.03, 1.42), put(Segment::upperarm_r, -0.18, 1.42);
  put(Segment::forearm_r, -0.18, 1.12), put(Segment::hand_r, -0.18, 0.86);
  put(Segment::thigh_l, 0.09, 0.93), put(Segment::shank_l, 0.09, 0.5), put(Segment::foot_l, 0.09, 0.08);
  put(Segment::thigh_r, -0.09, 0.93), put(Segment::shank_r, -0.09, 0.5), put(Segment::foot_r, -0.09, 0.08);
  return pose;
}

TEST(WriteVrma, RestsInATPoseAndPlaysTheSegments) {
  BodyPose turned = standing();
  const Quat yaw = exp_rotation(Vec3(0, 0.7, 0));
  for (Rigid& segment : turned) segment = Rigid{yaw, Vec3(0.5, 0, 0)} * segment;
  Diagnostics diagnostics;
  const auto bytes = write_vrma("hit", {standing(), turned}, 30.0);
  ASSERT_TRUE(bytes);
  const auto file = read_gltf(*bytes, "hit.vrma", diagnostics);
  ASSERT_TRUE(file) << file.error().message();
  const Skeleton& skeleton = file->skeleton;
  ASSERT_EQ(skeleton.size(), 18);
  const auto rest = world_transforms(skeleton, rest_pose(skeleton));
  const auto at = [&](const std::vector<Affine>& world, const char* name) {
    return world[skeleton.find(name)].translation();
  };
  const Vec3 arm = at(rest, "leftHand") - at(rest, "leftUpperArm");
  EXPECT_LT((arm - Vec3(0.56, 0, 0)).norm(), 1e-9) << "level, to the left, which is +x";
  ASSERT_EQ(file->animations.size(), 1u);
  EXPECT_EQ(file->animations[0].name, "hit");
  const BodyPose* frames[] = {nullptr, &turned};
  const BodyPose first = standing();
  frames[0] = &first;
  for (int f = 0; f < 2; ++f) {
    const auto world = world_transforms(skeleton, sample(skeleton, file->animations[0], f / 30.0));
    for (const auto& [name, segment] :
         {std::pair("leftHand", Segment::hand_l), std::pair("head", Segment::head),
          std::pair("rightFoot", Segment::foot_r)})
      EXPECT_LT((at(world, name) - (*frames[f])[index(segment)].translation).norm(), 1e-6) << name << f;
  }
}

}  // namespace
}  // namespace ukemi
