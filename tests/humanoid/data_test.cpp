// Characters and motions by others, where UKEMI_EXTRA_DATA names their folder.
#include <gtest/gtest.h>

#include "humanoid/humanoid.h"
#include "humanoid/rotations.h"
#include "load/load.h"
#include "restrict/range_of_motion.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

class ExtraData : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto named = extra_data();
    if (!named) GTEST_SKIP() << kNoExtraData;
    data = *named;
  }
  std::filesystem::path data;
};

TEST_F(ExtraData, HumanoidsAreMappedAndStandInsideTheHumanRange) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  int mapped = 0;
  for (const std::string folder : {"characters/", "mocap/"})
    for (const ExtraFile& entry : extra_files(data, folder)) {
      SCOPED_TRACE(entry.file);
      Diagnostics diagnostics;
      const auto character = load_character(data / entry.file, {}, diagnostics);
      ASSERT_TRUE(character) << character.error().message();
      const auto humanoid = map_humanoid(*character, {}, diagnostics);
      EXPECT_EQ(static_cast<bool>(humanoid), entry.verdict == "humanoid")
          << (humanoid ? "mapped" : humanoid.error().what);
      if (!humanoid) continue;
      ++mapped;
      for (const StartPose kind : {StartPose::stand, StartPose::guard}) {
        const Pose pose = start_pose(*character, *humanoid, kind);
        const BodyPose body = canonical_segments_of(character->skeleton, *humanoid, pose);
        const PerJoint<SwingTwist> charts = charts_of(*range, rotations_of(body));
        for (int j = 0; j < kJointCount; ++j) {
          EXPECT_LT(polygon_distance(range->joints[j].polygon, charts[j].swing), radians(-3))
              << name(joint_at(j));
          EXPECT_GT(charts[j].twist, range->joints[j].twist_min + radians(3)) << name(joint_at(j));
          EXPECT_LT(charts[j].twist, range->joints[j].twist_max - radians(3)) << name(joint_at(j));
        }
        EXPECT_NEAR(body[index(Segment::foot_l)].translation.y(),
                    body[index(Segment::foot_r)].translation.y(), 0.01 * humanoid->height_m);
      }
    }
  EXPECT_GE(mapped, 60);
}

TEST_F(ExtraData, OthersAreRefusedWithWhatWasLookedFor) {
  int refused = 0;
  for (const ExtraFile& entry : extra_files(data, "refuse/")) {
    SCOPED_TRACE(entry.file);
    Diagnostics diagnostics;
    const auto character = load_character(data / entry.file, {}, diagnostics);
    ASSERT_TRUE(character) << character.error().message();
    const auto humanoid = map_humanoid(*character, {}, diagnostics);
    ASSERT_FALSE(humanoid);
    EXPECT_EQ(humanoid.error().kind, ErrorKind::input);
    EXPECT_TRUE(humanoid.error().what.starts_with("not a humanoid: ")) << humanoid.error().what;
    ++refused;
  }
  EXPECT_GE(refused, 15);
}

TEST_F(ExtraData, RealMotionLiesInsideTheHumanRange) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  int looked_at = 0, outside = 0;
  for (const ExtraFile& entry : extra_files(data, "mocap/")) {
    if (!entry.file.ends_with(".bvh")) continue;
    Diagnostics diagnostics;
    const auto character = load_character(data / entry.file, {}, diagnostics);
    ASSERT_TRUE(character);
    const auto humanoid = map_humanoid(*character, {}, diagnostics);
    ASSERT_TRUE(humanoid) << humanoid.error().what;
    const Animation& animation = character->animations[0];
    const Clip clip = sample_clip(character->skeleton, animation, animation.fps);
    for (std::size_t frame = 0; frame < clip.frames.size(); frame += 4) {
      const BodyPose body = canonical_segments_of(character->skeleton, *humanoid, clip.frames[frame]);
      const PerJoint<SwingTwist> charts = charts_of(*range, rotations_of(body));
      for (int j = 0; j < kJointCount; ++j) {
        ++looked_at;
        if (excess(range->joints[j], charts[j]) > radians(5)) ++outside;
      }
    }
  }
  ASSERT_GT(looked_at, 50000);
  EXPECT_LT(100.0 * outside / looked_at, 2.0);  // percent of joint-frames more than 5 degrees outside
}

}  // namespace
}  // namespace ukemi
