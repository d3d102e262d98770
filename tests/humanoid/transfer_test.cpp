#include "humanoid/transfer.h"

#include "figures.h"
#include "support/random.h"

namespace ukemi {
namespace {

using testing::figure;
using testing::FigureOptions;

Humanoid mapped(const Character& character) {
  Diagnostics diagnostics;
  auto humanoid = map_humanoid(character, {}, diagnostics);
  EXPECT_TRUE(humanoid);
  return *humanoid;
}

Pose waved(const Character& character, std::uint64_t seed) {
  Random random(seed);
  Pose pose = rest_pose(character.skeleton);
  for (int i = 1; i < character.skeleton.size(); ++i)
    pose[i].rotation = pose[i].rotation * exp_rotation(test::random_vector(random, 0.35));
  return pose;
}

TEST(Transfer, SameSkeletonInAnotherUnitTakesEveryLocalRotation) {
  const Character hero = figure({.twisted_nodes = true});
  const Character other = figure({.unit = 100.0, .twisted_nodes = true});
  const Humanoid hero_map = mapped(hero), other_map = mapped(other);
  const Transfer transfer(hero, hero_map, other, other_map);
  ASSERT_TRUE(transfer.same_skeleton());
  Pose pose = waved(other, 1);
  pose[other_map.root].translation += Vec3(30, 5, -20);
  const Pose taken = transfer(pose);
  for (int i = 0; i < hero.skeleton.size(); ++i)
    EXPECT_LT(angle_between(taken[i].rotation, pose[i].rotation), 1e-9) << hero.skeleton.nodes[i].name;
  const BodyPose mine = segments_of(hero.skeleton, hero_map, taken);
  const BodyPose theirs = segments_of(other.skeleton, other_map, pose);
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_LT((mine[s].translation - theirs[s].translation).norm(), 1e-9) << name(segment_at(s));
}

TEST(Transfer, AnotherSkeletonTakesTheSegmentsRotations) {
  Random random(2);
  for (const double size : {1.0, 0.6}) {
    const Character hero = figure({.unit = size, .spine_bones = 2, .twisted_nodes = true});
    const Character other = figure({.armature = exp_rotation(Vec3(0.5 * kPi, 0, 0)), .spine_bones = 3});
    const Humanoid hero_map = mapped(hero), other_map = mapped(other);
    const Transfer transfer(hero, hero_map, other, other_map);
    EXPECT_FALSE(transfer.same_skeleton());
    const Pose pose = waved(other, random.next());
    const BodyPose wanted = canonical_segments_of(other.skeleton, other_map, pose);
    const BodyPose taken = segments_of(hero.skeleton, hero_map, transfer(pose));
    for (int s = 0; s < kSegmentCount; ++s)
      EXPECT_LT(angle_between(taken[s].rotation, wanted[s].rotation), 1e-9) << name(segment_at(s));
    const double ratio = hero_map.height_m / other_map.height_m;
    EXPECT_NEAR(ratio, size, 1e-9);
    constexpr int pelvis = index(Segment::pelvis);
    EXPECT_LT((taken[pelvis].translation - ratio * wanted[pelvis].translation).norm(), 1e-9);
  }
}

TEST(Transfer, FusedSegmentsAreCarriedAndTheRestFollows) {
  const Character hero = figure({.spine_bones = 1, .clavicles = false, .hands = false});
  const Character other = figure();
  const Humanoid hero_map = mapped(hero), other_map = mapped(other);
  const Pose pose = waved(other, 3);
  const BodyPose wanted = canonical_segments_of(other.skeleton, other_map, pose);
  const BodyPose taken =
      segments_of(hero.skeleton, hero_map, Transfer(hero, hero_map, other, other_map)(pose));
  for (int s = 0; s < kSegmentCount; ++s) {
    if (hero_map.segments[s].fused()) continue;
    EXPECT_LT(angle_between(taken[s].rotation, wanted[s].rotation), 1e-9) << name(segment_at(s));
  }
}

}  // namespace
}  // namespace ukemi
