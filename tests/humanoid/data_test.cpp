// Characters and motions by others, where UKEMI_EXTRA_DATA names their folder.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "humanoid/humanoid.h"
#include "load/load.h"
#include "restrict/range_of_motion.h"

namespace ukemi {
namespace {

struct Entry {
  std::string file, verdict;
};

/// Rows of MANIFEST.tsv whose file starts with `folder`.
std::vector<Entry> entries(const std::filesystem::path& data, const std::string& folder) {
  std::vector<Entry> result;
  std::ifstream in(data / "MANIFEST.tsv");
  std::string line, cell;
  std::size_t verdict_column = 0;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    for (std::istringstream row(line); std::getline(row, cell, '\t');) cells.push_back(cell);
    if (verdict_column == 0) {
      while (verdict_column < cells.size() && cells[verdict_column] != "expected verdict") ++verdict_column;
    } else if (cells.size() > verdict_column && cells[0].starts_with(folder)) {
      result.push_back({cells[0], cells[verdict_column]});
    }
  }
  return result;
}

class ExtraData : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("UKEMI_EXTRA_DATA");
    if (folder == nullptr || *folder == '\0')
      GTEST_SKIP() << "characters by others are left out: UKEMI_EXTRA_DATA names no folder";
    data = folder;
  }
  std::filesystem::path data;
};

TEST_F(ExtraData, HumanoidsAreMappedAndStandInsideTheHumanRange) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  int mapped = 0;
  for (const std::string folder : {"characters/", "mocap/"})
    for (const Entry& entry : entries(data, folder)) {
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
        PerSegment<Quat> rotations;
        for (int s = 0; s < kSegmentCount; ++s) rotations[s] = body[s].rotation;
        const PerJoint<SwingTwist> charts = charts_of(*range, rotations);
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
  for (const Entry& entry : entries(data, "refuse/")) {
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
  for (const Entry& entry : entries(data, "mocap/")) {
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
      PerSegment<Quat> rotations;
      for (int s = 0; s < kSegmentCount; ++s) rotations[s] = body[s].rotation;
      const PerJoint<SwingTwist> charts = charts_of(*range, rotations);
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
