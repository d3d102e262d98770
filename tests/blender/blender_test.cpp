// The Blender add-on as a user has it: packed by tools/blender/package, installed, run on rigs of many
// origins.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "support/command.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoBlender =
    "Blender is not installed: tools/test --clients, or apt-get install blender python3-numpy";

// Rigs as their makers wrote them; ours stand in assets/characters.
constexpr const char* kFurther[] = {"characters/quaternius_fbx/Animated Human.fbx",
                                    "characters/quaternius_fbx/Zombie.fbx",
                                    "characters/ozz_pab_fbx/arnaud.fbx",
                                    "characters/khronos/cesium_man.gltf",
                                    "characters/kaykit/manny_med_mod.gltf",
                                    "characters/quaternius_glb/modular_men/Swat.glb",
                                    "characters/quaternius_glb/RobotExpressive.glb",
                                    "characters/quaternius_glb/cyberpunk_pack/Character.glb",
                                    "mocap/cmu_bvh/01_01.bvh"};

class Blender : public testing::Test {
 protected:
  void SetUp() override {
    if (run_command("blender --background --python-exit-code 1 --python-expr 'import numpy'").second != 0)
      GTEST_SKIP() << kNoBlender;
    folder_ = fs::temp_directory_path() / fmt::format("ukemi_blender_{}", getpid());
    fs::create_directories(folder_ / "scripts/addons");
    const fs::path zip = folder_ / "ukemi.zip";
    const auto [said, status] =
        run_command(fmt::format("'{0}' '{1}' && python3 -m zipfile -e '{1}' '{2}'", UKEMI_PACKAGE,
                                zip.string(), (folder_ / "scripts/addons").string()));
    ASSERT_EQ(status, 0) << said;
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  static std::string mannequin(const char* suffix) {
    return UKEMI_ASSETS_FOLDER "/characters/mannequin." + std::string(suffix);
  }

  /// Runs a script of this folder in Blender; its output must have `told`.
  void run(const std::string& script, const std::vector<std::string>& arguments, const std::string& told,
           const std::string& before = "", const std::string& options = "--background") {
    std::string command = fmt::format(
        "{} env BLENDER_USER_SCRIPTS='{}' UKEMI='{}' blender {} --factory-startup --python-exit-code 1 "
        "--python "
        "'{}/{}' --",
        before, (folder_ / "scripts").string(), UKEMI_PROGRAM, options, UKEMI_BLENDER_FOLDER, script);
    for (const std::string& argument : arguments) command += fmt::format(" '{}'", argument);
    const auto [output, status] = run_command(command + " 2>&1");
    EXPECT_EQ(status, 0) << output;
    EXPECT_NE(output.find(told), std::string::npos) << output;
  }

  std::string kept() const { return (folder_ / "kept").string(); }

  fs::path folder_;
};

TEST_F(Blender, BonesAreWhereTheProgramPutThemOnOurMannequin) {
  run("roundtrip.py", {kept(), mannequin("glb"), mannequin("bvh")}, "roundtrip: 2 of 2 rigs");
}

TEST_F(Blender, BonesAreWhereTheProgramPutThemOnFurtherRigs) {
  if (!extra_data()) GTEST_SKIP() << kNoExtraData;
  std::vector<std::string> arguments = {kept()};
  for (const char* file : kFurther)
    if (fs::exists(*extra_data() / file)) arguments.push_back((*extra_data() / file).string());
  ASSERT_GE(arguments.size(), 9u) << "rigs found";
  const std::size_t rigs = arguments.size() - 1;
  run("roundtrip.py", arguments, fmt::format("roundtrip: {0} of {0} rigs", rigs));
}

TEST_F(Blender, EveryWayToUseTheAddOnWorks) {
  run("uses.py", {kept(), mannequin("glb")}, "uses: ok test_refuses_with_the_reason");
}

TEST_F(Blender, RigifysControlsCarryTheReaction) { run("control_rig.py", {kept()}, "control_rig: ok"); }

TEST_F(Blender, AWindowBakesBesideTheArtistAndEscapeAndUndoWork) {
  if (run_command("xvfb-run --help").second != 0)
    GTEST_SKIP() << "xvfb-run is not installed: apt-get install xvfb";
  fs::create_directories(kept());
  run("window.py", {kept(), mannequin("glb")}, "window: 3 of 3",
      "xvfb-run -a -s '-screen 0 1600x1000x24' timeout 300",
      "--enable-event-simulate --window-geometry 0 0 1600 1000");
  EXPECT_GT(fs::file_size(fs::path(kept()) / "panel.png"), 10000u);
}

TEST_F(Blender, ThePackageIsTheSameBytesEveryTime) {
  const auto [output, status] = run_command(fmt::format(
      "'{0}' '{1}/again.zip' && cmp '{1}/again.zip' '{1}/ukemi.zip'", UKEMI_PACKAGE, folder_.string()));
  EXPECT_EQ(status, 0) << output;
}

}  // namespace
}  // namespace ukemi
