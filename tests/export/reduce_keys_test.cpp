#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "export/export.h"
#include "export/puppet.h"

namespace ukemi {
namespace {

Skeleton arm(double length) {
  Skeleton skeleton;
  skeleton.nodes.push_back({"upper", -1, {}});
  skeleton.nodes.push_back({"lower", 0, {{0, length, 0}, Quat::Identity(), Vec3::Ones()}});
  EXPECT_TRUE(skeleton.sort());
  return skeleton;
}

template <typename Turn>
Clip turning(const Skeleton& skeleton, int frames, Turn turn) {
  Clip clip{"turn", 60.0, {}, {}};
  for (int f = 0; f < frames; ++f) {
    clip.frames.push_back(rest_pose(skeleton));
    clip.frames.back()[0].rotation = exp_rotation(turn(f / 60.0));
  }
  return clip;
}

TEST(ReduceKeys, KeepsTwoKeysOfASteadyTurnAndNothingOfWhatRests) {
  const Skeleton skeleton = arm(1.0);
  const Clip clip = turning(skeleton, 61, [](double t) { return Vec3(0, 0, 1.5 * t); });
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {});
  ASSERT_EQ(reduced.tracks.size(), 1u);
  EXPECT_EQ(reduced.tracks[0].node, 0);
  EXPECT_EQ(reduced.tracks[0].path, TrackPath::rotation);
  ASSERT_EQ(reduced.tracks[0].times.size(), 2u);
  EXPECT_DOUBLE_EQ(reduced.tracks[0].times[1], 1.0);
  EXPECT_LT(reduced.error_m, 1e-9);
}

TEST(ReduceKeys, KeepsOneKeyOfWhatRestsElsewhere) {
  const Skeleton skeleton = arm(1.0);
  Clip clip = turning(skeleton, 61, [](double t) { return Vec3(0, 0, t); });
  for (Pose& pose : clip.frames) pose[1].translation.x() = 0.25;
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {});
  ASSERT_EQ(reduced.tracks.size(), 2u);
  EXPECT_EQ(reduced.tracks[1].node, 1);
  EXPECT_EQ(reduced.tracks[1].times, std::vector<double>{0.0});
  EXPECT_EQ(reduced.tracks[1].values, (std::vector<double>{0.25, 1, 0}));
}

TEST(ReduceKeys, LeavesAStillClipItsDuration) {
  const Skeleton skeleton = arm(1.0);
  const ReducedClip reduced =
      reduce_keys(skeleton, turning(skeleton, 121, [](double) { return Vec3(0, 0, 0); }), {}, {});
  ASSERT_EQ(reduced.tracks.size(), 1u);
  EXPECT_EQ(reduced.tracks[0].times, (std::vector<double>{0.0, 2.0}));
}

TEST(ReduceKeys, TurnsTheLongWayRoundWhereTheClipDoes) {
  const Skeleton skeleton = arm(1.0);
  const Clip clip = turning(skeleton, 61, [](double t) { return Vec3(0, 0, 8 * kPi * t); });
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {});
  EXPECT_LT(test::largest_distance_m(skeleton, clip, reduced.tracks, {}), 0.0005);
  EXPECT_LT(reduced.keys, 12u);
}

TEST(ReduceKeys, BoundsTheErrorInMetresWhateverTheUnit) {
  const auto swing = [](double t) { return Vec3(0, 0, std::sin(t)); };
  const Skeleton metres = arm(1.0);
  const Skeleton centimetres = arm(100.0);
  const Clip clip = turning(metres, 181, swing);
  const ReducedClip a = reduce_keys(metres, clip, {}, {});
  const ReducedClip b = reduce_keys(centimetres, turning(centimetres, 181, swing), {.scale = 0.01}, {});
  const ReducedClip c = reduce_keys(centimetres, turning(centimetres, 181, swing), {}, {});
  EXPECT_EQ(a.keys, b.keys);
  EXPECT_GT(c.keys, 2 * b.keys) << "with a metre per unit the same file is a giant";
  EXPECT_GT(a.error_m, 0.0001);
  EXPECT_LE(a.error_m, 0.0005);
}

TEST(ReduceKeys, AMeshInThePlaceOfItsBoneReachesAsFarAsTheBone) {
  Skeleton hand = arm(0.2), with_mesh = arm(0.2);
  with_mesh.nodes.push_back({"mesh", 1, {}});
  ASSERT_TRUE(with_mesh.sort());
  const auto turned = [](const Skeleton& skeleton) {
    Clip clip{"turn", 60.0, {}, {}};
    for (int f = 0; f < 121; ++f) {
      clip.frames.push_back(rest_pose(skeleton));
      clip.frames.back()[1].rotation = exp_rotation(Vec3(0, 0, std::sin(0.1 * f)));
    }
    return clip;
  };
  const ReducedClip bare = reduce_keys(hand, turned(hand), {}, {});
  const ReducedClip meshed = reduce_keys(with_mesh, turned(with_mesh), {}, {});
  EXPECT_EQ(meshed.keys, bare.keys);
  EXPECT_LT(meshed.keys, 100u);
}

TEST(ReduceKeys, HoldsItsBoundOnAFallingBody) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Clip clip = test::falling_clip(skeleton);
  for (const double tolerance : {0.0001, 0.0005, 0.005}) {
    const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {true, tolerance});
    const double seen = test::largest_distance_m(skeleton, clip, reduced.tracks, {});
    EXPECT_LE(reduced.error_m, tolerance);
    EXPECT_LE(seen, reduced.error_m + 1e-9) << "as a viewer plays it";
    EXPECT_GT(seen, 0.75 * reduced.error_m) << "what is told is no more than what is seen";
    EXPECT_GT(seen, 0.2 * tolerance) << "the tolerance is made use of";
  }
}

TEST(ReduceKeys, KeepsAThirdOfTheKeysAtHalfAMillimetre) {
  const test::Puppet puppet = test::make_puppet();
  const Clip clip = test::falling_clip(puppet.character.skeleton);
  const std::size_t all = reduce_keys(puppet.character.skeleton, clip, {}, {false, 0}).keys;
  const auto begin = std::chrono::steady_clock::now();
  const ReducedClip reduced = reduce_keys(puppet.character.skeleton, clip, {}, {});
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  fmt::print("{} of {} keys ({:.1f}x), error {:.3f} mm, {:.1f} ms\n", reduced.keys, all,
             static_cast<double>(all) / static_cast<double>(reduced.keys), 1000 * reduced.error_m,
             took.count());
  EXPECT_LT(3 * reduced.keys, all);
}

TEST(ReduceKeys, MovesKeysOffTheSourceToSpareSome) {
  const Skeleton skeleton = arm(1.0);
  const Clip clip = turning(skeleton, 241, [](double t) { return Vec3(0, 0, 0.05 * t * t); });
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {true, 0.0005});
  EXPECT_LE(test::largest_distance_m(skeleton, clip, reduced.tracks, {}), 0.0005 + 1e-9);
  // 0.1 rad/s^2 on 1.2 m (the tip of the lower arm): between points of the source a piece of h seconds is off
  // by 0.12 h^2 / 8, so that it may last 10 frames: 25 keys.
  EXPECT_LT(reduced.keys, 24u);
}

TEST(ReduceKeys, LeavesTheFirstTheLastAndTheImpactFrameAsTheyAre) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  Clip clip = test::falling_clip(skeleton);
  clip.marks = {{"impact", 20 / clip.fps}};
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {true, 0.005});
  const Animation animation{"", 0, clip.duration_s(), 0, reduced.tracks};
  for (const std::size_t frame : {std::size_t{0}, std::size_t{20}, clip.frames.size() - 1}) {
    const Pose pose = sample(skeleton, animation, static_cast<double>(frame) / clip.fps);
    for (std::size_t node = 0; node < pose.size(); ++node) {
      EXPECT_LT(angle_between(pose[node].rotation, clip.frames[frame][node].rotation), 1e-7) << frame;
      EXPECT_LT((pose[node].translation - clip.frames[frame][node].translation).norm(), 1e-7) << frame;
    }
  }
}

TEST(ReduceKeys, KeepsEveryKeyOfWhatMovesWhenSwitchedOff) {
  const test::Puppet puppet = test::make_puppet();
  const Clip clip = test::falling_clip(puppet.character.skeleton, 31);
  const ReducedClip reduced = reduce_keys(puppet.character.skeleton, clip, {}, {false, 0.0005});
  ASSERT_FALSE(reduced.tracks.empty());
  for (const Track& track : reduced.tracks) EXPECT_EQ(track.times.size(), 31u);
  EXPECT_LT(reduced.error_m, 1e-7);
  EXPECT_LT(test::largest_distance_m(puppet.character.skeleton, clip, reduced.tracks, {}), 1e-7);
}

TEST(ReduceKeys, RotationsAreExactWhereTheyHaveToBe) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Clip clip = test::falling_clip(skeleton);
  const int hand = skeleton.find("LeftHand");
  const auto off_deg = [&](const Pose& pose, std::size_t frame) {
    return degrees(angle_between(pose[hand].rotation, clip.frames[frame][hand].rotation));
  };
  const auto largest_deg = [&](const ReducedClip& reduced) {
    const Animation animation{"", 0.0, clip.duration_s(), clip.fps, reduced.tracks};
    double largest = 0.0;
    for (std::size_t f = 0; f < clip.frames.size(); ++f)
      largest = std::max(largest, off_deg(sample(skeleton, animation, static_cast<double>(f) / clip.fps), f));
    return largest;
  };
  const KeyReduction coarse{true, 0.02};
  const ReducedClip free = reduce_keys(skeleton, clip, {}, coarse);
  const ReducedClip kept = reduce_keys(skeleton, clip, {}, coarse, [&](std::size_t frame, const Pose& pose) {
    return off_deg(pose, frame) > 0.1 ? std::vector<int>{hand} : std::vector<int>();
  });
  EXPECT_GT(largest_deg(free), 0.5);
  EXPECT_LT(largest_deg(kept), 0.1 + 1e-6);
  EXPECT_LE(kept.error_m, 0.02);
  EXPECT_LT(kept.keys, reduce_keys(skeleton, clip, {}, {false, 0.0}).keys);
}

}  // namespace
}  // namespace ukemi
