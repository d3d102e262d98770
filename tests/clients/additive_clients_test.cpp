// Additive clips in the engines that add them, and VRM animations in the player of their makers: what
// formats.md says of them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bake/bake.h"
#include "load/load.h"
#include "support/command.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kTolerance_m = 1e-5;

class AdditiveClients : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(fs::path(UKEMI_CLIENTS_FOLDER) / "additive/node_modules"))
      GTEST_SKIP() << "the packages of tests/clients/additive are not installed (200 MB): npm ci --prefix "
                      "tests/clients/additive";
    folder = fs::path(testing::TempDir()) / ("ukemi_additive_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  /// The reaction of the mannequin with `additive`, after the plain one in the same file.
  fs::path baked(Additive additive) {
    const fs::path file = folder / "hit.glb";
    fs::remove(file);
    bake_to(file, Additive::off);
    bake_to(file, additive);
    return file;
  }
  void bake_to(const fs::path& file, Additive additive) {
    BakeSettings settings;
    settings.outputs = {file};
    settings.append = fs::exists(file);
    settings.additive = additive;
    settings.keys.enabled = false;
    settings.simulation.duration_s = 1.5;
    Diagnostics said;
    const auto made = bake_file("mannequin", settings, said);
    ASSERT_TRUE(made) << made.error().message();
  }
  /// The lines of JSON that a script of the folder prints.
  static std::vector<Json> said(const std::string& script, const std::string& arguments) {
    const auto [output, status] =
        run_command("node '" + std::string(UKEMI_CLIENTS_FOLDER) + "/additive/" + script + "' " + arguments);
    EXPECT_EQ(status, 0) << output;
    std::vector<Json> lines;
    std::istringstream text(output);
    for (std::string line; std::getline(text, line);)
      if (line.starts_with("{")) lines.push_back(Json::parse(line));
    return lines;
  }
  static void expect_added(const std::string& script, const fs::path& file, bool right) {
    const auto lines = said(script, "'" + file.string() + "'");
    ASSERT_EQ(lines.size(), 1u) << script;
    EXPECT_GT(lines[0]["count"].get<int>(), 100) << script;
    if (right)
      EXPECT_LT(lines[0]["worst_m"].get<double>(), kTolerance_m) << script;
    else
      EXPECT_GT(lines[0]["worst_m"].get<double>(), 0.1) << script << " takes the other form";
  }

  fs::path folder;
};

TEST_F(AdditiveClients, ThreeAndBabylonAddTheDifferenceFromIdentity) {
  const fs::path file = baked(Additive::identity);
  expect_added("add_three.mjs", file, true);
  expect_added("add_babylon.mjs", file, true);
  expect_added("add_playcanvas.mjs", file, false);
}

TEST_F(AdditiveClients, PlayCanvasAddsTheDifferenceOnTheRestPose) {
  const fs::path file = baked(Additive::rest);
  expect_added("add_playcanvas.mjs", file, true);
  expect_added("add_three.mjs", file, false);
}

/// A blow from the front throws an avatar back, on its feet and upright at first, whichever way its file
/// faces.
TEST_F(AdditiveClients, AVrmAnimationPlaysOnAvatarsOfBothVersions) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  const fs::path file = folder / "hit.vrma";
  bake_to(file, Additive::off);
  std::string arguments = "'" + file.string() + "'";
  for (const char* avatar : {"basic_armature.vrm", "basic_armature_vrm1.vrm"})
    arguments += " '" + (*data / "characters/vrm_addon" / avatar).string() + "'";
  const auto lines = said("play_vrma.mjs", arguments);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0]["version"], lines[1]["version"]);
  for (const Json& line : lines) {
    EXPECT_NEAR(line["duration_s"].get<double>(), 1.5, 0.02);
    const Json &start = line["found"].front(), &end = line["found"].back();
    const double leg = start["hips"][1].get<double>();
    EXPECT_GT(start["head"][1].get<double>(), 1.7 * leg) << "upright";
    for (const Json& foot : start["feet"]) EXPECT_NEAR(foot[1].get<double>(), 0.09, 0.03) << "on the floor";
    EXPECT_LT(end["hips"][2].get<double>(), -0.15 * leg) << "thrown back, away from +z";
    for (std::size_t i = 0; i < line["found"].size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(line["found"][i]["head"][axis].get<double>(),
                    lines[0]["found"][i]["head"][axis].get<double>(), 1e-5)
            << "both versions alike";
  }
}

}  // namespace
}  // namespace ukemi
