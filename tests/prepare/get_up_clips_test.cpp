// Libraries to get up by: files of other bodies, and what is taken from them.
#include "prepare/get_up_clips.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bake/bake.h"
#include "load/load.h"
#include "rise/get_up.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

const std::string kMannequin = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb";

/// A body and a folder with a fall and its get-up, as a BVH.
class GetUpClips : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / ("get_up_clips_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    settings.preset = "kick";
    settings.strength = 2.0;
    settings.most_steps = 0;
    auto loaded = load_character(kMannequin, {}, diagnostics);
    ASSERT_TRUE(loaded);
    character = std::move(*loaded);
    auto ready = prepare_bake(character, settings, diagnostics);
    ASSERT_TRUE(ready);
    prepared = std::move(*ready);
  }
  void TearDown() override { fs::remove_all(folder); }

  void record(const std::string& file, double get_up_s) {
    BakeSettings recorded = settings;
    recorded.get_up_s = get_up_s;
    recorded.outputs = {folder / file};
    ASSERT_TRUE(bake_file(kMannequin, recorded, diagnostics));
  }
  Result<std::vector<RisingClip>> clips(const std::string& text) {
    return get_up_clips(character, prepared.humanoid, prepared.body, text, diagnostics);
  }

  fs::path folder;
  Diagnostics diagnostics;
  Character character;
  BakeSettings settings;
  Prepared prepared;
};

TEST_F(GetUpClips, AFolderGivesEveryGetUpAndLeavesOutWhatHasNone) {
  record("b.bvh", 0.5);
  record("a.glb", 1.0);
  fs::copy_file(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh", folder / "walk.bvh");
  std::ofstream(folder / "broken.glb") << "no glTF";
  std::ofstream(folder / "readme.txt") << "no motion";
  const auto found = clips(folder.string());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ((*found)[0].name.substr(0, 6), "a.glb:");
  EXPECT_EQ((*found)[1].name.substr(0, 6), "b.bvh:");
  int left_out = 0;
  for (const Warning& warning : diagnostics.warnings())
    left_out += warning.what.starts_with("left out of --get-up-clip");
  EXPECT_EQ(left_out, 1);
  for (const RisingClip& clip : *found) {
    EXPECT_NE(lying_of(prepared.body, clip.frames.front()), Lying::upright);
    EXPECT_EQ(lying_of(prepared.body, clip.frames.back()), Lying::upright);
    EXPECT_GT(clip.duration_s(), 1.5);
    EXPECT_LT(clip.duration_s(), 6.0);
  }
}

TEST_F(GetUpClips, OfCapturedPeopleBeginOnTheFloorAndEndStanding) {
  const char* truth = std::getenv("UKEMI_TRUTH");
  const auto extra = extra_data();
  if (!extra || truth == nullptr) GTEST_SKIP() << "UKEMI_EXTRA_DATA or UKEMI_TRUTH name no folder";
  const std::pair<fs::path, Lying> wanted[] = {
      {fs::path(truth) / "clips/dm_getup_facedown.bvh", Lying::prone},
      {fs::path(truth) / "clips/dm_getup_faceup.bvh", Lying::supine},
      {*extra / "mocap/other_bvh/Boxing_Toes.bvh", Lying::seated},
  };
  for (const auto& [file, lying] : wanted) {
    const auto found = clips(file.string());
    ASSERT_TRUE(found) << file;
    ASSERT_FALSE(found->empty()) << file;
    const RisingClip& clip = found->back();
    EXPECT_EQ(name(lying_of(prepared.body, clip.frames.front())), name(lying)) << file;
    EXPECT_EQ(lying_of(prepared.body, clip.frames.back()), Lying::upright) << file;
    EXPECT_LT(clip.duration_s(), 6.0) << file;
  }
}

}  // namespace
}  // namespace ukemi
