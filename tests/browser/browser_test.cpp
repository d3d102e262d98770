// The review page as a reviewer meets it: in a real browser (drive.mjs), its joints where the program has
// them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "humanoid/humanoid.h"
#include "load/load.h"
#include "support/command.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kToleranceM = 0.0001;
constexpr int kTimes = 12;
constexpr std::string_view kRecipe = R"(format = 1
characters = ["mannequin"]
outputs = ["glb", "report"]

[[matrix]]
hit = ["head", "chest", "thigh_l"]
from = ["front", "left"]
preset = "punch"
)";
const char* const kHostileName = "</script><img src=x onerror=alert(1)>'\"&amp;";

std::string missing() {
  if (run_command("node --version").second != 0) return "node is not installed";
  if (!fs::exists("/usr/bin/chromium") && !fs::exists("/usr/bin/chromium-browser") &&
      !fs::exists("/usr/bin/google-chrome"))
    return "Chromium is not installed";
  if (!fs::exists(fs::path(UKEMI_BROWSER_FOLDER) / "node_modules/playwright-core"))
    return "run npm ci in tests/browser, or tools/test";
  return "";
}

class Browser : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string what = missing(); !what.empty()) GTEST_SKIP() << what;
    folder = fs::path(testing::TempDir()) / ("ukemi_browser_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder / "hostile");
  }
  void TearDown() override {
    if (!folder.empty()) fs::remove_all(folder);
  }

  void program(const std::string& arguments) {
    const auto [output, status] = run_command(fmt::format("'{}' {}", UKEMI_PROGRAM, arguments));
    ASSERT_EQ(status, 0) << arguments << "\n" << output;
  }

  fs::path folder;
};

/// Where the node of a segment is at a time of a file's last clip, metres.
Vec3 place_of(const fs::path& file, Segment segment, double time_s) {
  Diagnostics diagnostics;
  const auto character = load_character(file, {}, diagnostics);
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  const Animation& clip = character->animations.back();
  const Pose pose = sample(character->skeleton, clip, clip.start_s + time_s);
  const int node = humanoid->segments[index(segment)].node();
  return humanoid->world_from_file * Vec3(world_transforms(character->skeleton, pose)[node].translation());
}

/// Places of all nodes of a file's last clip, metres.
Json judged(const fs::path& file, const std::string& id) {
  Diagnostics diagnostics;
  const auto character = load_character(file, {}, diagnostics);
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  const Animation& clip = character->animations.back();
  Json json{{"id", id}, {"tolerance_m", kToleranceM}, {"times", Json::array()}, {"places", Json::array()}};
  for (int i = 0; i < kTimes; ++i) {
    const double time_s = clip.duration_s() * i / (kTimes - 1);
    Json places = Json::array();
    for (const Affine& node :
         world_transforms(character->skeleton, sample(character->skeleton, clip, clip.start_s + time_s))) {
      const Vec3 place = humanoid->world_from_file * Vec3(node.translation());
      places.push_back({place.x(), place.y(), place.z()});
    }
    json["times"].push_back(time_s);
    json["places"].push_back(std::move(places));
  }
  return json;
}

/// A reaction of the batch with steps: when and where its feet came down, as report and clip tell.
Json stepping(const fs::path& batch) {
  for (const char* name : {"chest_left", "chest_front", "head_left", "head_front"}) {
    std::ifstream stream(batch / "mannequin" / (std::string(name) + ".json"));
    const Json steps = Json::parse(stream).at("response").at("steps");
    const fs::path clip = batch / "mannequin" / (std::string(name) + ".glb");
    Json json{{"id", std::string("mannequin/") + name}, {"contacts", Json::array()}};
    for (const Json& step : steps) {
      if (step.at("contact_s").is_null()) continue;
      const bool left = step.at("foot") == "l";
      const double time_s = step.at("contact_s");
      const Vec3 ankle = place_of(clip, left ? Segment::foot_l : Segment::foot_r, time_s);
      json["contacts"].push_back(
          {{"side", left ? "left" : "right"}, {"time_s", time_s}, {"ankle", {ankle.x(), ankle.z()}}});
    }
    if (!json["contacts"].empty()) return json;
  }
  return {};
}

TEST_F(Browser, ServesAReviewer) {
  ASSERT_TRUE(write_file(folder / "few.toml", kRecipe));
  program(
      fmt::format("batch '{}' -o '{}' --quiet", (folder / "few.toml").string(), (folder / "batch").string()));
  const fs::path clip = folder / "batch/mannequin/head_left.glb";
  fs::copy_file(clip, folder / "hostile/a.glb");
  const Json manifest{
      {"format", 1},
      {"reactions",
       {{{"name", kHostileName}, {"character", kHostileName}, {"status", "done"}, {"outputs", {"a.glb"}}}}}};
  ASSERT_TRUE(write_file(folder / "hostile/manifest.json", manifest.dump()));
  program(fmt::format("review '{}' --quiet", (folder / "hostile").string()));
  const Json work{{"folder", (folder / "batch").string()},
                  {"reactions", 6},
                  {"judged", judged(clip, "mannequin/head_left")},
                  {"stepping", stepping(folder / "batch")},
                  {"hostile", {{"folder", (folder / "hostile").string()}, {"name", kHostileName}}}};
  ASSERT_TRUE(write_file(folder / "work.json", work.dump()));
  const auto [output, status] = run_command(
      fmt::format("node '{}/drive.mjs' '{}'", UKEMI_BROWSER_FOLDER, (folder / "work.json").string()));
  EXPECT_EQ(status, 0) << output;
  EXPECT_NE(output.find(" checks, 0 failed"), std::string::npos) << output;
}

TEST(Web, IsWhatItsSourcesMake) {
  const fs::path web = UKEMI_WEB_FOLDER;
  if (!fs::exists(web / "node_modules/esbuild")) GTEST_SKIP() << "run npm ci in tools/web, or tools/test";
  const fs::path made = fs::path(testing::TempDir()) / ("ukemi_web_" + std::to_string(getpid()));
  const auto [output, status] =
      run_command(fmt::format("node '{}' '{}'", (web / "build.mjs").string(), made.string()));
  ASSERT_EQ(status, 0) << output;
  for (const char* name : {"index.html", "review.css", "review.js"}) {
    const auto kept = find_asset(fs::path("web") / name);
    ASSERT_TRUE(kept);
    EXPECT_TRUE(*read_file(*kept, 16u << 20) == *read_file(made / name, 16u << 20))
        << name << ": run npm run build in tools/web";
  }
  fs::remove_all(made);
}

}  // namespace
}  // namespace ukemi
