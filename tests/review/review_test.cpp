#include "review/review.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "base/base64.h"
#include "base/files.h"
#include "clip/frames.h"
#include "judge/rom_figures.h"
#include "load/load.h"
#include "review/clip.h"
#include "review/json.h"
#include "review/sources.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Two bakes of the mannequin, made once, in a folder of each test's own.
class Reviewed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    baked = new fs::path(fs::path(testing::TempDir()) / ("ukemi_baked_" + std::to_string(getpid())));
    fs::create_directories(*baked);
    for (const char* hit : {"head", "chest"}) {
      BakeSettings settings;
      settings.hit = *segment_named(hit);
      settings.outputs = {*baked / (std::string(hit) + ".glb"), *baked / (std::string(hit) + ".bvh")};
      settings.report = *baked / (std::string(hit) + ".json");
      Diagnostics diagnostics;
      const auto made = bake_file("mannequin", settings, diagnostics);
      ASSERT_TRUE(made) << made.error().message();
    }
  }
  static void TearDownTestSuite() {
    fs::remove_all(*baked);
    delete baked;
  }

  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) /
             ("ukemi_review_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder / "mannequin");
    for (const auto& entry : fs::directory_iterator(*baked))
      fs::copy_file(entry.path(), folder / "mannequin" / entry.path().filename());
  }
  void TearDown() override { fs::remove_all(folder); }

  Review review(int threads = 2) {
    const auto made = write_review(folder, {threads}, diagnostics);
    EXPECT_TRUE(made) << made.error().message();
    return made ? *made : Review{};
  }
  std::string refusal() {
    const auto made = write_review(folder, {}, diagnostics);
    return made ? "" : made.error().message();
  }
  std::string read(const fs::path& path) const {
    const auto bytes = read_file(path, 64u << 20);
    return bytes ? std::string(bytes->begin(), bytes->end()) : "";
  }
  void write(const fs::path& path, const std::string& text) const {
    std::ofstream(folder / path, std::ios::binary) << text;
  }
  /// What a script of the page hands over.
  Json handed_over(const fs::path& script) const {
    const std::string text = read(folder / script);
    const auto begin = text.find('{');
    return Json::parse(text.substr(begin, text.rfind('}') + 1 - begin));
  }
  Json reactions() const { return handed_over("review/reactions.js")["reactions"]; }
  std::map<std::string, std::string> page_files() const {
    std::map<std::string, std::string> files{{"index.html", read(folder / "index.html")}};
    for (const auto& entry : fs::recursive_directory_iterator(folder / "review"))
      if (entry.is_regular_file()) files[entry.path().lexically_relative(folder)] = read(entry.path());
    return files;
  }
  void write_manifest(const Json& reactions) const {
    write("manifest.json", Json{{"format", 1}, {"recipe", "few.toml"}, {"reactions", reactions}}.dump());
  }

  static fs::path* baked;
  fs::path folder;
  Diagnostics diagnostics;
};
fs::path* Reviewed::baked = nullptr;

TEST_F(Reviewed, AFolderOfBakesNeedsNoManifest) {
  const Review made = review();
  EXPECT_EQ(made.reactions, 2);
  EXPECT_EQ(made.clips, 2);
  EXPECT_EQ(made.characters, 1) << "the mesh is stored once";
  const Json list = reactions();
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["name"], "chest");
  EXPECT_EQ(list[0]["character"], "mannequin");
  EXPECT_EQ(list[0]["settings"]["preset"], "medicine-ball");
  EXPECT_EQ(list[0]["outputs"], Json({"mannequin/chest.bvh", "mannequin/chest.glb"}));
  EXPECT_GT(list[0]["figures"]["travel_m"], 0.1);
  const Json report = Json::parse(read(folder / "mannequin/chest.json"));
  EXPECT_EQ(list[0]["figures"]["excess_max_deg"], report["limits"]["excess_max_deg"]);
  EXPECT_EQ(list[0]["figures"]["momentum_n_s"], report["impact"]["momentum_n_s"]);
  for (const Json& one : list) {
    EXPECT_TRUE(fs::exists(folder / "review/clips" / (one["clip"].get<std::string>() + ".js")));
    for (const char* thumbnail : {"thumbnail", "thumbnail_dark"})
      EXPECT_EQ(read(folder / "review" / one[thumbnail].get<std::string>()).substr(8, 4), "WEBP");
  }
}

TEST_F(Reviewed, AManifestTellsTheReactionsInItsOrder) {
  write_manifest(
      {{{"name", "b"},
        {"character", "mannequin"},
        {"status", "done"},
        {"outputs", {"mannequin/head.glb"}},
        {"report", "mannequin/head.json"},
        {"settings", {{"hit", "head"}, {"variation", 3}}},
        {"warnings", {"the left hand is fused"}},
        {"figures", {{"travel_m", 9.0}}},
        {"digest", "1234"}},
       {{"name", "a"}, {"character", "mannequin"}, {"status", "failed"}, {"error", "it diverged"}}});
  const Review made = review();
  EXPECT_EQ(made.reactions, 2);
  EXPECT_EQ(made.clips, 1);
  EXPECT_EQ(handed_over("review/reactions.js")["recipe"], "few.toml");
  const Json list = reactions();
  EXPECT_EQ(list[0]["name"], "b");
  EXPECT_EQ(list[0]["digest"], "1234");
  EXPECT_EQ(list[0]["settings"]["variation"], 3);
  EXPECT_EQ(list[0]["warnings"], Json::array({"the left hand is fused"}));
  EXPECT_EQ(list[0]["settings"]["from"], "front") << "from the report";
  EXPECT_EQ(list[0]["figures"]["travel_m"], 9.0) << "as the manifest has it";
  EXPECT_EQ(list[1]["status"], "failed");
  EXPECT_EQ(list[1]["error"], "it diverged");
  EXPECT_TRUE(list[1]["clip"].is_null());
}

TEST_F(Reviewed, AClipThatCannotBeReadIsListedWithItsError) {
  write("mannequin/broken.glb", "no glTF");
  EXPECT_EQ(review().reactions, 3);
  const Json broken = reactions()[0];
  EXPECT_EQ(broken["name"], "broken");
  EXPECT_EQ(broken["status"], "unreadable");
  EXPECT_TRUE(broken["clip"].is_null());
  ASSERT_FALSE(diagnostics.warnings().empty());
  EXPECT_NE(diagnostics.warnings().front().subject.find("broken.glb"), std::string::npos);
}

TEST_F(Reviewed, NamesCannotLeaveTheirPlace) {
  const std::string hostile = "</script><img src=x onerror=alert(1)>\"'\\\xE2\x80\xA8../..";
  write_manifest({{{"name", hostile},
                   {"character", hostile},
                   {"status", "done"},
                   {"outputs", {"mannequin/head.glb", "../outside.glb"}},
                   {"sheet", "../../etc/passwd"}}});
  review();
  const Json list = reactions();
  EXPECT_EQ(list[0]["name"], hostile);
  EXPECT_EQ(list[0]["outputs"], Json({"mannequin/head.glb"}));
  EXPECT_TRUE(list[0]["sheet"].is_null());
  for (const auto& [name, content] : page_files()) {
    if (name.ends_with("review.js") || name.ends_with(".html") || !name.ends_with(".js")) continue;
    EXPECT_EQ(content.find('<'), std::string::npos) << name;
    EXPECT_TRUE(std::all_of(content.begin(), content.end(), [](char c) { return c > 0; })) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./"),
              std::string::npos)
        << name;
  }
}

TEST_F(Reviewed, PageIsTheSameForAnyNumberOfThreads) {
  review(1);
  const auto first = page_files();
  EXPECT_GE(first.size(), 11u);
  review(3);
  EXPECT_EQ(page_files(), first);
}

/// As a folder of bakes tells them.
std::vector<ReviewPart> both_parts() {
  std::vector<ReviewPart> parts;
  for (const std::string name : {"chest", "head"})
    parts.push_back({"mannequin",
                     name,
                     {"mannequin/" + name + ".bvh", "mannequin/" + name + ".glb"},
                     "mannequin/" + name + ".json"});
  return parts;
}

TEST_F(Reviewed, PartsMadeAheadGiveTheSameBytesAndAreUsedUp) {
  review();
  const auto first = page_files();
  fs::remove_all(folder / "review");
  fs::remove(folder / "index.html");
  for (const ReviewPart& part : both_parts()) ASSERT_TRUE(make_review_part(folder, part));
  EXPECT_FALSE(fs::exists(folder / "review")) << "the page is not begun";
  review();
  EXPECT_EQ(page_files(), first);
  EXPECT_FALSE(fs::exists(folder / ".ukemi/page"));
}

TEST_F(Reviewed, PartsMadeAheadAreTakenForTheirOwnInputsOnly) {
  for (const ReviewPart& part : both_parts()) ASSERT_TRUE(make_review_part(folder, part));
  int parts = 0;
  for (const auto& entry : fs::directory_iterator(folder / ".ukemi/page")) {
    if (entry.path().extension() != ".json") continue;
    Json json = Json::parse(read(entry.path()));
    json["excess_max_deg"] = 77.0;  // tells that it was taken
    write(entry.path().lexically_relative(folder), json.dump());
    ++parts;
  }
  ASSERT_EQ(parts, 2);
  fs::copy_file(folder / "mannequin/head.glb", folder / "mannequin/chest.glb",
                fs::copy_options::overwrite_existing);
  review();
  const Json list = reactions();
  EXPECT_LT(list[0]["figures"]["clip_excess_max_deg"], 10.0) << "the chest's clip has changed since";
  EXPECT_EQ(list[1]["figures"]["clip_excess_max_deg"], 77.0);
}

TEST_F(Reviewed, PageAgainLeavesNothingOfTheLast) {
  review();
  const std::size_t before = page_files().size();
  for (const char* name : {"head.glb", "head.bvh", "head.json"}) fs::remove(folder / "mannequin" / name);
  EXPECT_EQ(review().reactions, 1);
  EXPECT_EQ(page_files().size(), before - 3) << "a clip and its two thumbnails less";
}

TEST_F(Reviewed, NothingOfOthersIsLost) {
  write("index.html", "<p>my own page");
  EXPECT_NE(refusal().find("is not a page of this program"), std::string::npos);
  EXPECT_EQ(read(folder / "index.html"), "<p>my own page");
  fs::remove(folder / "index.html");
  fs::create_directories(folder / "review");
  write("review/notes.txt", "mine");
  EXPECT_NE(refusal().find("is not a folder of this program"), std::string::npos);
}

TEST_F(Reviewed, APageThatWasCutShortIsMadeAnew) {
  review();
  fs::remove(folder / "index.html");
  fs::remove(folder / "review/reactions.js");
  write("review/clips/half.js", "left by a run that was killed");
  EXPECT_EQ(review().reactions, 2);
  EXPECT_FALSE(fs::exists(folder / "review/clips/half.js"));
}

TEST_F(Reviewed, ClipsOfAPlainFolderGoByItsName) {
  fs::create_directories(folder / "hero");
  fs::copy_file(folder / "mannequin" / "head.glb", folder / "hero" / "head.glb");
  Diagnostics said;
  for (const fs::path& named : {folder / "hero", folder / "hero" / ""}) {
    const auto sources = review_sources(named, said);
    ASSERT_TRUE(sources) << sources.error().message();
    ASSERT_EQ(sources->reactions.size(), 1u);
    EXPECT_EQ(sources->reactions[0].character, "hero");
  }
}

TEST_F(Reviewed, RefusesWhatIsNoBatch) {
  write("manifest.json", "[]");
  EXPECT_NE(refusal().find("is not a JSON object"), std::string::npos);
  write("manifest.json", R"({"format": 2, "reactions": []})");
  EXPECT_NE(refusal().find("is not the manifest of a batch"), std::string::npos);
  write("manifest.json", R"({"format": 1, "reactions": [{}]})");
  EXPECT_NE(refusal().find("a reaction without a name"), std::string::npos);
  fs::remove_all(folder);
  EXPECT_NE(refusal().find("there is no such folder"), std::string::npos);
  fs::create_directories(folder);
  EXPECT_NE(refusal().find("holds no manifest.json and no"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "review")) << "a refusal writes nothing";
}

template <typename Number>
std::vector<Number> unpacked(const Json& text) {
  const std::vector<std::uint8_t> bytes = base64_decoded(text.get<std::string>()).bytes;
  std::vector<Number> values(bytes.size() / sizeof(Number));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Number));
  return values;
}

TEST_F(Reviewed, MarginsAreTheExcessOutsideAndTheRoomInside) {
  review();
  const Json clip = handed_over("review/clips/" + reactions()[1]["clip"].get<std::string>() + ".js");
  const auto character = load_character(folder / "mannequin/head.glb", {}, diagnostics);
  ASSERT_TRUE(character);
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  const std::size_t last = character->animations.size() - 1;
  const Clip sampled = clip_to_check(*character, last);
  const auto frames = frames_in_extras(character->skeleton, character->animations[last].extras_json);
  const RomPaths paths =
      rom_paths(character->skeleton, *humanoid, *load_range_of_motion("human"), sampled.frames, frames);
  ASSERT_EQ(clip["rom"]["joints"].size(), 17u);
  const Json report = Json::parse(read(folder / "mannequin/head.json"));
  const RangeOfMotion human = *load_range_of_motion("human");
  int compared = 0;
  for (const Json& joint : clip["rom"]["joints"]) {
    const std::string joint_name = joint["name"];
    const JointPath& path = paths.joints[index(*joint_named(joint_name))];
    const auto whole = unpacked<std::int16_t>(joint["margin_deg"]["values"]);
    const auto a_z = unpacked<std::int16_t>(joint["a_z_deg"]["values"]);
    ASSERT_EQ(whole.size(), path.excess_deg.size());
    const double scale = joint["margin_deg"]["scale"], a_z_scale = joint["a_z_deg"]["scale"];
    for (std::size_t f = 0; f < whole.size(); ++f) {
      EXPECT_NEAR(a_z[f] * a_z_scale, degrees(path.charts[f].swing.y()), a_z_scale);
      if (report["limits"]["widened_deg"].contains(joint_name)) continue;
      EXPECT_NEAR(std::max(whole[f] * scale, 0.0), path.excess_deg[f], scale) << joint_name;
      const JointRange& range = human.joints[index(*joint_named(joint_name))];
      const SwingTwist& chart = path.charts[f];
      const double twist = std::max(chart.twist - range.twist_max, range.twist_min - chart.twist);
      EXPECT_NEAR(whole[f] * scale, degrees(std::max(polygon_distance(range.polygon, chart.swing), twist)),
                  scale);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

TEST_F(Reviewed, ABvhAloneIsShownAsASimpleFigure) {
  fs::remove(folder / "mannequin/head.glb");
  fs::remove(folder / "mannequin/chest.glb");
  EXPECT_EQ(review().clips, 2);
  const Json mesh = handed_over("review/characters/" + reactions()[0]["mesh"].get<std::string>() + ".js");
  EXPECT_GE(mesh["parts"].size(), 1u);
  EXPECT_FALSE(unpacked<float>(mesh["parts"][0]["positions"]).empty());
}

TEST(ReviewJson, PacksNumbersAsTheyLieInMemory) {
  EXPECT_EQ(packed(std::vector<float>{1.0f}), "AACAPw==");
  EXPECT_EQ(packed(std::vector<std::uint32_t>{1}), "AQAAAA==");
  EXPECT_EQ(packed(std::vector<std::int16_t>{-2}), "/v8=");
  EXPECT_EQ(script_safe("</script>"), "\\u003c/script>");
}

}  // namespace
}  // namespace ukemi
