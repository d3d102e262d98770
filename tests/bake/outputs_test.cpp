#include "bake/outputs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bake/bake.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  Error refused(const std::vector<fs::path>& outputs, const std::string& character = "hero.glb") {
    BakeSettings settings;
    settings.outputs = outputs;
    const Status status = check_outputs(character, settings);
    EXPECT_FALSE(status);
    return status ? Error{} : status.error();
  }

  fs::path folder;
};

TEST_F(Outputs, AreKnownByTheirExtension) {
  EXPECT_EQ(output_format("a.glb"), OutputFormat::glb);
  EXPECT_EQ(output_format("a.b.GLTF"), OutputFormat::gltf);
  EXPECT_EQ(output_format("a.bvh"), OutputFormat::bvh);
  EXPECT_EQ(output_format("a.fbx"), OutputFormat::fbx);
  EXPECT_FALSE(output_format("a.obj"));
  EXPECT_FALSE(output_format("glb"));
}

TEST_F(Outputs, InAFolderAreNamedByCharacterHitAndPreset) {
  fs::create_directory(folder / "out");
  BakeSettings settings;
  settings.hit = Segment::head;
  settings.preset = "punch";
  settings.outputs = {folder / "out", folder / "own.bvh", folder / "later/"};
  settings.sheet = folder / "out";
  settings.report = folder / "report.json";
  name_outputs("models/hero one.vrm", settings);
  EXPECT_EQ(settings.outputs,
            (std::vector<fs::path>{folder / "out/hero_one_head_front_punch.glb", folder / "own.bvh",
                                   folder / "later/hero_one_head_front_punch.glb"}));
  EXPECT_EQ(settings.sheet, folder / "out/hero_one_head_front_punch.png");
  EXPECT_EQ(settings.report, folder / "report.json");

  settings.outputs = {folder / "out"};
  settings.scene = SceneKind::slope;
  settings.seed = 3;
  name_outputs("walk.bvh", settings);
  EXPECT_EQ(settings.outputs.front(), folder / "out/walk_head_front_slope_seed3.bvh");
}

TEST_F(Outputs, OfUnknownFormatAreRefused) {
  EXPECT_EQ(refused({folder / "a.obj"}).kind, ErrorKind::usage);
  BakeSettings settings;
  settings.sheet = folder / "a.jpg";
  EXPECT_EQ(check_outputs("hero.glb", settings).error().fix, "let the name end in .png");
}

TEST_F(Outputs, ThatCannotBeWrittenAreRefusedBeforeAnythingRuns) {
  fs::create_directory(folder / "a.glb");
  EXPECT_EQ(refused({folder / "a.glb"}).kind, ErrorKind::output);
  EXPECT_EQ(refused({folder / "no" / "a.glb"}).kind, ErrorKind::output);
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(refused({folder / "file" / "a.glb"}).kind, ErrorKind::output);
}

TEST_F(Outputs, MayNotNameTheSameFileTwiceNorTheCharacter) {
  EXPECT_EQ(refused({folder / "a.glb", folder / "." / "a.glb"}).what, "is named twice as an output");
  EXPECT_EQ(refused({"none-such.glb", "./none-such.glb"}).what, "is named twice as an output");
  const fs::path hero = folder / "hero.glb";
  std::ofstream(hero) << "x";
  EXPECT_EQ(refused({folder / "." / "hero.glb"}, hero.string()).what, "would overwrite the character");
}

TEST_F(Outputs, ThatCanBeWrittenPass) {
  BakeSettings settings;
  settings.outputs = {folder / "a.glb", folder / "a.bvh"};
  settings.sheet = folder / "a.png";
  settings.report = folder / "a.json";
  EXPECT_TRUE(check_outputs("mannequin", settings));
  EXPECT_TRUE(fs::is_empty(folder)) << "checking leaves nothing behind";
}

}  // namespace
}  // namespace ukemi
