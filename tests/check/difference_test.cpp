#include "check/difference.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/animation.h"
#include "base/native_rate.h"
#include "check/inspect.h"

namespace ukemi {
namespace {

/// hips - spine - head, each a metre above the other; the hips walk, the spine bends about z.
Character chain(double bend_rad, const std::string& ancestor = "") {
  Character character;
  character.path = "chain.glb";
  const auto add = [&](const std::string& name, int parent, const Vec3& offset) {
    character.skeleton.nodes.push_back({name, parent, {offset, Quat::Identity(), Vec3::Ones()}});
    return character.skeleton.size() - 1;
  };
  int parent = -1;
  if (!ancestor.empty()) parent = add(ancestor, -1, Vec3::Zero());
  const int hips = add("hips", parent, Vec3(0, 1, 0));
  const int spine = add("spine", hips, Vec3(0, 1, 0));
  add("head", spine, Vec3(0, 1, 0));
  EXPECT_TRUE(character.skeleton.sort());
  const Quat bend = exp_rotation(Vec3(0, 0, bend_rad));
  Animation animation{"bend", 0.0, 1.0, 30.0, {}};
  animation.tracks.push_back(
      {hips, TrackPath::translation, Interpolation::linear, {0, 1}, {0, 1, 0, 2, 1, 0}});
  animation.tracks.push_back({spine,
                              TrackPath::rotation,
                              Interpolation::linear,
                              {0, 1},
                              {0, 0, 0, 1, bend.x(), bend.y(), bend.z(), bend.w()}});
  character.animations.push_back(animation);
  return character;
}

PlacedClip placed(const Character& character) { return {&character, &character.animations.front(), {}}; }

TEST(Difference, OfAClipWithItselfIsNone) {
  const Character a = chain(0.5);
  const auto difference = difference_of(placed(a), placed(a), {});
  ASSERT_TRUE(difference);
  EXPECT_TRUE(difference->within_tolerance);
  EXPECT_EQ(difference->samples, 31);
  ASSERT_EQ(difference->joints.size(), 3u);
  for (const JointDifference& joint : difference->joints) {
    EXPECT_EQ(joint.position_mm, 0.0);
    EXPECT_EQ(joint.rotation_deg, 0.0);
  }
}

TEST(Difference, OfTwoFiguresWithTheSameNamesTheOneThatMovesHasThem) {
  const Character alone = chain(0.5);
  Character both = chain(0.5);
  for (int i = 0; i < 3; ++i) {
    Node node = both.skeleton.nodes[i];
    if (node.parent >= 0) node.parent += 3;
    both.skeleton.nodes.push_back(node);
  }
  ASSERT_TRUE(both.skeleton.sort());
  const auto difference = difference_of(placed(both), placed(alone), {});
  ASSERT_TRUE(difference) << difference.error().what;
  EXPECT_TRUE(difference->within_tolerance);
  EXPECT_EQ(difference->joints.size(), 3u);
  EXPECT_TRUE(difference->only_in_b.empty());
}

TEST(Difference, OfABendIsTheAngleAtTheJointAndTheArcAboveIt) {
  const Character a = chain(radians(10));
  const Character b = chain(radians(12));
  const auto difference = difference_of(placed(a), placed(b), {});
  ASSERT_TRUE(difference);
  EXPECT_FALSE(difference->within_tolerance);
  for (const JointDifference& joint : difference->joints) {
    if (joint.joint == "spine") {
      EXPECT_NEAR(joint.rotation_deg, 2.0, 1e-9);
      EXPECT_NEAR(joint.rotation_at_s, 1.0, 1e-9);
      EXPECT_NEAR(joint.position_mm, 0.0, 1e-9);
    } else if (joint.joint == "head") {
      EXPECT_NEAR(joint.rotation_deg, 0.0, 1e-6) << "turns with the spine in both";
      EXPECT_NEAR(joint.position_mm, 2000.0 * std::sin(radians(1.0)), 1e-6) << "chord of 2 degrees at 1 m";
    }
  }
  EXPECT_EQ(difference->joints.back().joint, "hips") << "worst first";
}

TEST(Difference, LooksThroughAncestorsThatOnlyOneFileHas) {
  Character a = chain(0.3);
  Character b = chain(0.3, "armature");
  // The armature turns the figure and the hips turn it back.
  const Quat turn = exp_rotation(Vec3(0, 1.0, 0));
  b.skeleton.nodes[0].rest.rotation = turn;
  const Quat back = turn.conjugate();
  b.animations[0].tracks.push_back(
      {1, TrackPath::rotation, Interpolation::linear, {0}, {back.x(), back.y(), back.z(), back.w()}});
  b.animations[0].tracks[0].values.clear();
  for (const Vec3& p : {Vec3(0, 1, 0), Vec3(2, 1, 0)}) {
    const Vec3 local = back * p;
    b.animations[0].tracks[0].values.insert(b.animations[0].tracks[0].values.end(),
                                            {local.x(), local.y(), local.z()});
  }
  const auto difference = difference_of(placed(a), placed(b), {});
  ASSERT_TRUE(difference);
  EXPECT_TRUE(difference->within_tolerance) << difference->joints.front().joint;
  EXPECT_EQ(difference->only_in_b, std::vector<std::string>{"armature"});
}

// The same motion told in other bone axes: every node turned by `axes` about its own origin, in the rest pose
// too.
TEST(Difference, DoesNotDependOnTheBonesAxes) {
  const Character a = chain(0.3);
  Character b = chain(0.3);
  const Quat axes = exp_rotation(Vec3(0.4, -1.0, 0.2));
  for (Node& node : b.skeleton.nodes) {
    if (node.parent >= 0) node.rest.translation = axes.conjugate() * node.rest.translation;
    node.rest.rotation = node.parent < 0 ? axes : Quat::Identity();
  }
  auto& tracks = b.animations[0].tracks;
  for (std::size_t key = 0; key < 2; ++key) {  // local rotation of the spine: conj(axes) * q * axes
    double* v = tracks[1].values.data() + 4 * key;
    const Quat q = axes.conjugate() * Quat(v[3], v[0], v[1], v[2]) * axes;
    v[0] = q.x(), v[1] = q.y(), v[2] = q.z(), v[3] = q.w();
  }
  const auto difference = difference_of(placed(a), placed(b), {});
  ASSERT_TRUE(difference);
  EXPECT_FALSE(difference->same_axes);
  EXPECT_TRUE(difference->within_tolerance) << difference->joints.front().joint;
  const Character more = chain(0.35);
  const auto other = difference_of(placed(more), placed(b), {});
  ASSERT_TRUE(other);
  double largest_deg = 0.0;
  for (const JointDifference& joint : other->joints) largest_deg = std::max(largest_deg, joint.rotation_deg);
  EXPECT_NEAR(largest_deg, degrees(0.05), 1e-6) << "and still sees a bend";
}

TEST(Difference, PlacesFilesOfDifferentUnits) {
  const Character a = chain(0.3);
  const Character b = chain(0.3);
  PlacedClip in_centimetres = placed(b);
  in_centimetres.world_from_file.scale = 0.01;
  const auto difference = difference_of(placed(a), in_centimetres, {});
  ASSERT_TRUE(difference);
  EXPECT_FALSE(difference->within_tolerance);
}

TEST(Difference, OfLengthsIsNoneOfThePoses) {
  const Character a = chain(0.0);
  Character b = chain(0.0);
  b.animations[0].end_s = 2.0;
  const auto difference = difference_of(placed(a), placed(b), {});
  ASSERT_TRUE(difference);
  EXPECT_FALSE(difference->same_duration);
  EXPECT_FALSE(difference->within_tolerance);
  EXPECT_EQ(difference->samples, 31) << "the shared part is compared";
}

TEST(Difference, NeedsAJointOfTheSameName) {
  const Character a = chain(0.0);
  Character b = chain(0.0);
  for (Node& node : b.skeleton.nodes) node.name += "_other";
  const auto difference = difference_of(placed(a), placed(b), {});
  ASSERT_FALSE(difference);
  EXPECT_EQ(difference.error().kind, ErrorKind::input);
}

TEST(NativeRate, IsTheFilesOrThatOfTheClosestKeys) {
  Animation animation{"a", 0.0, 1.0, 0.0, {}};
  EXPECT_EQ(native_rate(animation), 0.0);
  Track track;
  for (int i : {0, 5, 6, 9, 10, 24})
    track.times.push_back(static_cast<double>(static_cast<float>(i) / 24.0f));
  animation.tracks.push_back(track);
  animation.tracks.push_back({0, TrackPath::scale, Interpolation::linear, {0.0, 1.0}, {}});
  EXPECT_EQ(native_rate(animation), 24.0);
  Track even;
  for (int i = 0; i <= 1000; ++i) even.times.push_back(i / 24.0);
  even.times.insert(even.times.begin() + 1, 0.0001);  // a key between two frames
  animation.tracks.push_back(even);
  EXPECT_EQ(native_rate(animation), 24.0);
  animation.fps = 120.0;
  EXPECT_EQ(native_rate(animation), 120.0);
}

}  // namespace
}  // namespace ukemi
