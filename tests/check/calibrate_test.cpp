#include "check/calibrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bake/bake.h"
#include "base/character_path.h"
#include "base/files.h"
#include "clip/names.h"
#include "load/load.h"

namespace ukemi {
namespace {

/// The mannequin with its map, and the human region.
struct Stage {
  Character character;
  Humanoid humanoid;
  RangeOfMotion range;

  Stage() {
    Diagnostics diagnostics;
    auto loaded = load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
    EXPECT_TRUE(loaded);
    character = std::move(*loaded);
    humanoid = *map_humanoid(character, HumanoidOptions{}, diagnostics);
    range = *load_range_of_motion("human");
  }

  Clip clip(const std::string& name) const {
    return sample_clip(character.skeleton, character.animations[*find_clip(character, name)], 60.0);
  }
  JointSpeeds speeds(const Clip& clip) const {
    return joint_speeds(character.skeleton, humanoid, range, clip, 0.0);
  }
};

/// Joints and axes that turn faster than the program's own thresholds, over all frames.
int triggers(const JointSpeeds& speeds) {
  const auto thresholds = load_active_thresholds("");
  EXPECT_TRUE(thresholds);
  int count = 0;
  for (int j = 0; j < kJointCount; ++j)
    for (const Vec3& speed : speeds.speeds[j])
      count += static_cast<int>((speed.cwiseAbs().array() > (*thresholds)[j].array()).count());
  return count;
}

TEST(JointSpeeds, AreThoseOfAJointThatTurnsEvenly) {
  const Stage stage;
  const int shank = stage.humanoid.segments[index(Segment::shank_l)].node();
  const Pose rest = rest_pose(stage.character.skeleton);
  const Clip idle = stage.clip("idle");
  Clip turning{"turning", 60.0, {}, {}};
  // About the knee's hinge, in the axes of the node.
  const Vec3 hinge = stage.humanoid.node_from_segment[index(Segment::shank_l)] * Vec3::UnitZ();
  for (int i = 0; i < 20; ++i) {
    turning.frames.push_back(rest);
    turning.frames.back()[shank].rotation = rest[shank].rotation * exp_rotation(-0.05 * i * hinge);
  }
  const JointSpeeds speeds = stage.speeds(turning);
  for (const Vec3& speed : speeds.speeds[index(Joint::knee_l)]) {
    EXPECT_NEAR(std::abs(speed[1]), 0.05 * 60.0, 1e-6);
    EXPECT_NEAR(speed.norm(), 0.05 * 60.0, 1e-6);
  }
  for (const Vec3& speed : speeds.speeds[index(Joint::neck)]) EXPECT_LT(speed.norm(), 1e-6);
}

TEST(Calibrate, CalmStandingNeverTriggersAndTheDefaultHitDoes) {
  const Stage stage;
  const JointSpeeds idle = stage.speeds(stage.clip("idle"));
  EXPECT_FALSE(idle.speeds[index(Joint::knee_l)].empty());
  EXPECT_EQ(triggers(idle), 0);
  for (const Activity activity : idle.activity) EXPECT_EQ(activity, Activity::standing);
  Diagnostics diagnostics;
  BakeSettings settings;
  settings.simulation.duration_s = 0.5;
  const auto hit = bake(stage.character, settings, diagnostics);
  ASSERT_TRUE(hit) << hit.error().message();
  EXPECT_GT(triggers(stage.speeds(hit->timeline.clip)), 0);
}

TEST(Calibrate, WalkingIsSeenAndBoundsTheThresholds) {
  const Stage stage;
  int walking = 0;
  for (const Activity activity : stage.speeds(stage.clip("walk")).activity)
    walking += activity == Activity::walking;
  EXPECT_GT(walking, 50);
  Diagnostics diagnostics;
  CalibrationSettings settings;
  const auto with = calibrate(settings, diagnostics);
  settings.walking = false;
  const auto without = calibrate(settings, diagnostics);
  ASSERT_TRUE(with && without);
  const int knee = index(Joint::knee_r);
  EXPECT_GT(with->thresholds[knee][1], with->walking_p99[knee][1]);
  EXPECT_LT(with->thresholds[knee][1], with->walking_p99[knee][1] + 5.0);
  EXPECT_EQ(without->thresholds[knee][1], kThresholdFloor);
  EXPECT_EQ(with->thresholds[index(Joint::knee_l)], with->thresholds[knee]);
}

TEST(Calibrate, WritesWhatTheSimulationReads) {
  Diagnostics diagnostics;
  const auto calibration = calibrate(CalibrationSettings{}, diagnostics);
  ASSERT_TRUE(calibration);
  const auto path = std::filesystem::temp_directory_path() / "ukemi_calibrate_test.toml";
  ASSERT_TRUE(write_file(path, calibration_toml(*calibration)));
  const auto read = load_active_thresholds(path.string());
  std::filesystem::remove(path);
  ASSERT_TRUE(read) << read.error().message();
  for (int j = 0; j < kJointCount; ++j)
    EXPECT_LT(((*read)[j] * degrees(1.0) - calibration->thresholds[j]).norm(), 1e-9) << name(joint_at(j));
}

}  // namespace
}  // namespace ukemi
