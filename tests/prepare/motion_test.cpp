#include "prepare/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "bake/bake.h"
#include "prepare/start.h"
#include "base/files.h"
#include "clip/names.h"
#include "clip/start.h"
#include "load/load.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

const std::string kMannequin = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb";
const std::string kWalk = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh";

struct Hero {
  Character character;
  Humanoid humanoid;
  Diagnostics diagnostics;
  BakeSettings settings;

  explicit Hero(const std::string& file = kMannequin) {
    auto loaded = load_character(file, {}, diagnostics);
    EXPECT_TRUE(loaded);
    character = std::move(*loaded);
    humanoid = *map_humanoid(character, {}, diagnostics);
  }
  Result<Start> start() { return start_of(character, humanoid, settings, diagnostics); }
  BodyPose body(const Pose& pose) const { return segments_of(character.skeleton, humanoid, pose); }
};

TEST(Motion, FilesAreToldFromClipNames) {
  EXPECT_TRUE(names_motion_file("walk.bvh"));
  EXPECT_TRUE(names_motion_file("a/Walk.FBX"));
  EXPECT_TRUE(names_motion_file("hero.glb#run"));
  EXPECT_TRUE(names_motion_file("#5.glb##2"));
  EXPECT_FALSE(names_motion_file("walk"));
  EXPECT_FALSE(names_motion_file("#2"));
  EXPECT_FALSE(names_motion_file(".bvh"));
  EXPECT_FALSE(names_motion_file("hero.png#run"));
}

TEST(Motion, AClipOfAnotherFileLooksLikeTheCharactersOwn) {
  Hero hero;
  const auto taken = motion_of_file(hero.character, hero.humanoid, kWalk, hero.diagnostics);
  ASSERT_TRUE(taken);
  const Animation& own = hero.character.animations[*find_clip(hero.character, "walk")];
  EXPECT_NEAR(taken->duration_s(), own.duration_s(), 1e-3);
  for (const double time_s : {0.0, 0.31, 0.77, 1.0}) {
    const BodyPose a = hero.body(sample(hero.character.skeleton, *taken, time_s));
    const BodyPose b = hero.body(sample(hero.character.skeleton, own, own.start_s + time_s));
    const Vec3 apart = a[0].translation - b[0].translation;
    EXPECT_LT(apart.norm(), 0.05) << time_s;
    for (int s = 0; s < kSegmentCount; ++s) {
      EXPECT_LT((a[s].translation - b[s].translation - apart).norm(), 0.02) << name(segment_at(s));
      EXPECT_LT(angle_between(a[s].rotation, b[s].rotation), radians(6)) << name(segment_at(s));
    }
  }
}

TEST(Motion, OfItsOwnFileIsTheSamePoseAtEveryTime) {
  Hero hero;
  const auto taken = motion_of_file(hero.character, hero.humanoid, kMannequin + "#walk", hero.diagnostics);
  ASSERT_TRUE(taken);
  const Animation& own = hero.character.animations[*find_clip(hero.character, "walk")];
  for (const double time_s : {0.0, 0.5, 1.0}) {
    const Pose a = sample(hero.character.skeleton, *taken, time_s);
    const Pose b = sample(hero.character.skeleton, own, own.start_s + time_s);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_LT(angle_between(a[i].rotation, b[i].rotation), 1e-6) << hero.character.skeleton.nodes[i].name;
  }
}

TEST(Motion, StartsWhereTheClipIsAndPlaysAroundTheImpact) {
  Hero hero;
  hero.settings.clip = kWalk;
  hero.settings.at_s = 0.5;
  const auto start = hero.start();
  ASSERT_TRUE(start) << start.error().message();
  EXPECT_NEAR(start->floor_m, 0.0, 0.01);
  const Skeleton& skeleton = hero.character.skeleton;
  EXPECT_EQ(unhit_pose(skeleton, hero.humanoid, *start, 0.0)[1].translation, start->pose[1].translation);
  const double step_s = 0.05;
  const BodyPose before = hero.body(unhit_pose(skeleton, hero.humanoid, *start, -step_s));
  const BodyPose after = hero.body(unhit_pose(skeleton, hero.humanoid, *start, step_s));
  constexpr int pelvis = index(Segment::pelvis);
  const Vec3 walked = (after[pelvis].translation - before[pelvis].translation) / (2.0 * step_s);
  EXPECT_NEAR(walked.z(), start->state.linear_velocity[pelvis].z(), 0.05);
  EXPECT_GT(walked.z(), 0.8);
  EXPECT_LT(velocity_jump(skeleton, hero.humanoid, *start), 0.02);
}

/// A BVH of the mannequin's skeleton whose hips fly along a parabola: 3 m/s sideways, 2 m/s and -9.81 m/s^2
/// up.
std::string parabola(double fps, int frames) {
  const auto bytes = read_file(kWalk, 1 << 20);
  std::string text(bytes->begin(), bytes->end());
  text.resize(text.find("MOTION"));
  std::size_t channels = 0;
  for (std::size_t at = text.find("CHANNELS "); at != text.npos; at = text.find("CHANNELS ", at + 1))
    channels += text[at + 9] == '6' ? 6 : 3;
  text += "MOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: " + std::to_string(1.0 / fps) + "\n";
  for (int i = 0; i < frames; ++i) {
    const double t = i / fps;
    text += std::to_string(100.0 * 3.0 * t) + " " + std::to_string(100.0 * (1.0 + 2.0 * t - 4.905 * t * t)) +
            " 0";
    for (std::size_t c = 3; c < channels; ++c) text += " 0";
    text += "\n";
  }
  return text;
}

TEST(Motion, OfACycleGoesRound) {
  for (const std::string& file : {kMannequin, kWalk}) {
    Hero hero(file);
    hero.settings.clip = file == kMannequin ? "walk" : "#0";
    hero.settings.at_s = 0.5;
    const auto start = hero.start();
    ASSERT_TRUE(start) << start.error().message();
    ASSERT_TRUE(start->round);
    const auto body_at = [&](double time_s) {
      return hero.body(unhit_pose(hero.character.skeleton, hero.humanoid, *start, time_s));
    };
    const double round_s = start->motion->duration_s();
    const Vec3 per_round(0, 0, 1.342);
    for (const double time_s : {-0.5, -0.2, 0.0, 0.3}) {
      const BodyPose now = body_at(time_s);
      for (const int rounds : {-2, -1, 1, 2, 5}) {
        const BodyPose then = body_at(time_s + rounds * round_s);
        for (int s = 0; s < kSegmentCount; ++s) {
          const Vec3 way = then[s].translation - now[s].translation;
          EXPECT_LT((way - rounds * per_round).norm(), 0.01 * std::abs(rounds)) << file << time_s << rounds;
          EXPECT_LT(degrees(angle_between(now[s].rotation, then[s].rotation)), 0.2);
        }
      }
    }
    const double seam_s = round_s - 0.5;
    for (int s = 0; s < kSegmentCount; ++s) {
      const Vec3 across = body_at(seam_s + 0.005)[s].translation - body_at(seam_s - 0.005)[s].translation;
      const Vec3 before = body_at(seam_s - 0.005)[s].translation - body_at(seam_s - 0.015)[s].translation;
      EXPECT_LT((across - before).norm(), 0.006) << file << ' ' << name(segment_at(s));
    }
  }
}

TEST(Motion, OfNoCycleIsHeldAtItsEnds) {
  const fs::path file = fs::temp_directory_path() / "ukemi_no_cycle.bvh";
  ASSERT_TRUE(write_file(file, parabola(60.0, 31)));
  Hero hero(file.string());
  hero.settings.at_s = 0.25;
  const auto start = hero.start();
  ASSERT_TRUE(start) << start.error().message();
  EXPECT_FALSE(start->round);
  const Skeleton& skeleton = hero.character.skeleton;
  const auto pelvis_at = [&](double time_s) {
    return hero.body(unhit_pose(skeleton, hero.humanoid, *start, time_s))[index(Segment::pelvis)].translation;
  };
  EXPECT_EQ(pelvis_at(-9.0), pelvis_at(-0.25));
  EXPECT_EQ(pelvis_at(9.0), pelvis_at(0.25));
  fs::remove(file);
}

TEST(Motion, VelocitiesAreThoseOfTheClosedForm) {
  const fs::path file = fs::temp_directory_path() / "ukemi_parabola.bvh";
  ASSERT_TRUE(write_file(file, parabola(60.0, 31)));
  for (const std::string& character : {kMannequin, kWalk}) {
    Hero hero(character);
    hero.settings.clip = file.string();
    hero.settings.at_s = 0.25;
    const auto start = hero.start();
    ASSERT_TRUE(start) << start.error().message();
    for (int s = 0; s < kSegmentCount; ++s) {
      const Vec3& velocity = start->state.linear_velocity[s];
      EXPECT_NEAR(velocity.x(), 3.0, 0.02) << character << name(segment_at(s));
      EXPECT_NEAR(velocity.y(), 2.0 - 9.81 * 0.25, 0.02) << character << name(segment_at(s));
      EXPECT_NEAR(velocity.z(), 0.0, 1e-3) << character << name(segment_at(s));
      EXPECT_LT(start->state.angular_velocity[s].norm(), 1e-6);
    }
    EXPECT_LT(velocity_jump(hero.character.skeleton, hero.humanoid, *start), 1e-6);
  }
  fs::remove(file);
}

TEST(Motion, AStillPoseOfAnotherFileStandsOnTheFloor) {
  Hero hero;
  hero.settings.pose = kWalk;
  const auto start = hero.start();
  ASSERT_TRUE(start) << start.error().message();
  EXPECT_FALSE(start->from_clip);
  EXPECT_EQ(start->floor_m, 0.0);
  EXPECT_EQ(unhit_pose(hero.character.skeleton, hero.humanoid, *start, -1.0)[1].translation,
            start->pose[1].translation);
  const Pose standing = stand_on_floor(hero.character, hero.humanoid, start->pose);
  EXPECT_LT((hero.body(standing)[0].translation - start->segments[0].translation).norm(), 1e-9);
  const Character walk = Hero(kWalk).character;
  EXPECT_GT(std::abs(start->segments[index(Segment::foot_l)].translation.z() -
                     start->segments[index(Segment::foot_r)].translation.z()),
            0.2)
      << "the first frame of a walk has one foot before the other";
}

TEST(Motion, RefusesFilesWithoutAClipOrAHuman) {
  Hero hero;
  hero.settings.clip = kWalk + "#run";
  EXPECT_EQ(hero.start().error().kind, ErrorKind::usage);
  hero.settings.clip = "missing.bvh";
  EXPECT_EQ(hero.start().error().kind, ErrorKind::input);
  const fs::path still = fs::temp_directory_path() / "ukemi_box.gltf";
  ASSERT_TRUE(write_file(still, R"({"asset":{"version":"2.0"},"nodes":[{"name":"box"}]})"));
  hero.settings.clip = still.string();
  EXPECT_NE(hero.start().error().what.find("not a humanoid"), std::string::npos);
  fs::remove(still);
}

}  // namespace
}  // namespace ukemi
