// Bakes of the program's own character, and of characters made by others where UKEMI_EXTRA_DATA names them.
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/extra_data.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

class Bake : public Program {
 protected:
  /// Expects success without a word on stderr.
  std::string succeed(const std::vector<std::string>& arguments) {
    const Ran result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
  /// A bake of the mannequin with --json; nothing is written.
  Json report_of(std::vector<std::string> options) {
    options.insert(options.begin(), {"bake", "mannequin", "--json"});
    return Json::parse(succeed(options));
  }
};

void expect_keys(const Json& object, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key;
}

constexpr double kStandingFloor = 0.01;  // m: how far a body that stood may sink into the floor
constexpr double kMovingFloor = 0.015;   // m: one that was in motion

void expect_human(const Json& report, double floor_limit = kStandingFloor) {
  const Json& limits = report["limits"];
  EXPECT_GT(limits["samples"], 1000);
  EXPECT_EQ(limits["over_1deg"], 0);
  EXPECT_LT(limits["excess_max_deg"], 1.0);
  EXPECT_TRUE(limits["projected"]);
  EXPECT_LT(limits["excess_projected_max_deg"], 0.001);
  EXPECT_LT(report["simulation"]["joint_separation_max_m"], 0.01);
  EXPECT_LT(report["simulation"]["floor_penetration_max_m"], floor_limit);
  EXPECT_LT(report["clip"]["resample_rotation_max_deg"], 0.01);
  EXPECT_LE(report["clip"]["keys_error_max_m"], 0.0005);
}

TEST_F(Bake, WritesEveryOutputAndSaysSo) {
  const std::string out =
      succeed({"bake", "mannequin", "--hit", "chest", "--from", "front", "-o", "hit.glb", "-o", "hit.gltf",
               "-o", "hit.bvh", "--sheet", "hit.png", "--report", "hit.json"});
  EXPECT_EQ(files(), (std::vector<std::string>{"hit.bvh", "hit.glb", "hit.gltf", "hit.json", "hit.png"}));
  for (const std::string& file : files()) EXPECT_NE(out.find("wrote " + file), std::string::npos) << out;
  EXPECT_EQ(read("hit.glb").substr(0, 4), "glTF");
  EXPECT_EQ(read("hit.png").substr(1, 3), "PNG");
  EXPECT_EQ(read("hit.bvh").substr(0, 9), "HIERARCHY");
  EXPECT_EQ(Json::parse(read("hit.gltf"))["asset"]["version"], "2.0");
}

TEST_F(Bake, ReportHasEveryKeyOfItsFormat) {
  const Json report = report_of({});
  expect_keys(report, {"format", "generator", "character", "reaction", "settings", "humanoid", "impact",
                       "limits", "simulation", "clip", "timings_s", "warnings"});
  EXPECT_EQ(report["format"], 1);
  EXPECT_EQ(report["character"], "mannequin");
  EXPECT_EQ(report["reaction"], "chest_front");
  expect_keys(report["settings"], {"limits", "region", "active", "rate", "duration_s", "fps", "seed"});
  expect_keys(report["humanoid"], {"height_m", "mass_kg", "map", "frames"});
  EXPECT_EQ(report["humanoid"]["map"].size(), 18u);
  expect_keys(report["humanoid"]["frames"]["forearm_l"], {"node", "segment_from_node"});
  expect_keys(report["impact"], {"segment", "preset", "time_s", "momentum_n_s", "first_ground_contact_s",
                                 "position_jump_m", "velocity_jump_m_s"});
  EXPECT_TRUE(report["impact"]["position_jump_m"].is_null()) << "a still start has nothing to jump from";
  EXPECT_NEAR(report["impact"]["momentum_n_s"].get<double>(), 30.0, 1e-9);
  expect_keys(report["limits"], {"samples", "over_1deg", "excess_p999_deg", "excess_max_deg", "worst_joint",
                                 "excess_projected_max_deg", "projected", "widened_deg"});
  expect_keys(report["simulation"],
              {"steps", "rejected_steps", "joint_separation_max_m", "energy_gain_max_j",
               "floor_penetration_max_m", "self_penetration_max_m", "rest_time_s", "jitter_rad_s", "hash"});
  expect_keys(report["clip"], {"frames", "resample_position_max_m", "resample_rotation_max_deg", "keys",
                               "keys_error_max_m", "jerk_max_deg_s3", "jerk_max_node", "jerk_max_time_s",
                               "jerk_below_12hz_max_deg_s3", "jerk_real_motion_p999_deg_s3", "outputs"});
  expect_keys(report["timings_s"],
              {"load", "simulate", "resample", "export", "render", "total", "realtime_factor"});
  EXPECT_TRUE(files().empty());
}

TEST_F(Bake, OfTheMannequinStaysHumanWhereverItIsHit) {
  for (const char* segment : {"head", "chest", "pelvis", "thigh_l", "forearm_r"})
    for (const char* from : {"front", "back", "left", "above", "-60,20"}) {
      SCOPED_TRACE(std::string(segment) + " from " + from);
      const Ran result = run({"bake", "mannequin", "--hit", segment, "--from", from, "--json"});
      ASSERT_EQ(result.status, 0) << result.err;
      expect_human(Json::parse(result.out));
    }
}

TEST_F(Bake, TwiceGivesTheSameBytes) {
  for (const char* name : {"a", "b"})
    succeed({"bake", "mannequin", "--hit", "head", "--from", "left", "-o", std::string(name) + ".glb", "-o",
             std::string(name) + ".bvh", "--report", std::string(name) + ".json"});
  EXPECT_EQ(read("a.glb"), read("b.glb"));
  EXPECT_EQ(read("a.bvh"), read("b.bvh"));
  Json a = Json::parse(read("a.json"));
  Json b = Json::parse(read("b.json"));
  for (Json* report : {&a, &b}) {
    report->erase("timings_s");
    (*report)["clip"].erase("outputs");
    (*report)["library"].erase("File");
  }
  EXPECT_EQ(a, b);
}

TEST_F(Bake, QuietSaysNothing) {
  EXPECT_EQ(succeed({"bake", "mannequin", "--quiet", "--duration", "0.1", "-o", "a.glb"}), "");
  EXPECT_EQ(files(), std::vector<std::string>{"a.glb"});
}

// The mannequin faces +z, its left is at +x; a .bvh has centimetres and the root's x position first in its
// rows.
TEST_F(Bake, PushesTheBodyAwayFromWhereTheBlowComes) {
  const auto last_x = [&](const char* from) {
    succeed({"bake", "mannequin", "--quiet", "--hit", "pelvis", "--preset", "kick", "--from", from, "-o",
             "a.bvh", "--duration", "1", "--no-until-rest"});
    const std::string text = read("a.bvh");
    return std::stod(text.substr(text.rfind('\n', text.size() - 2) + 1));
  };
  EXPECT_LT(last_x("left"), -15.0);
  EXPECT_GT(last_x("right"), 15.0);
}

TEST_F(Bake, LengthAndRateAreThoseAskedFor) {
  const Json all = report_of({"--duration", "1.5", "--fps", "24", "--no-until-rest"});
  EXPECT_EQ(all["clip"]["frames"], 37);
  const Json trimmed = report_of({"--hold", "0.1", "--duration", "8"});
  ASSERT_FALSE(trimmed["simulation"]["rest_time_s"].is_null());
  const double rest_s = trimmed["simulation"]["rest_time_s"];
  EXPECT_NEAR(trimmed["clip"]["duration_s"].get<double>(), rest_s + 0.1, 1.0 / 60.0);
}

TEST_F(Bake, KeysAreAllWrittenWhenAsked) {
  const Json reduced = report_of({"--duration", "1"});
  const Json all = report_of({"--duration", "1", "--keys", "all"});
  EXPECT_GT(all["clip"]["keys"], reduced["clip"]["keys"]);
  EXPECT_LT(all["clip"]["keys_error_max_m"], 1e-12);
}

TEST_F(Bake, RunsWithEveryMethodAndScene) {
  const std::vector<std::vector<std::string>> variations = {
      {"--limits", "segments"},   {"--limits", "axis"},
      {"--active", "off"},        {"--active", "explicit", "--active-k", "5"},
      {"--rate", "fixed:480"},    {"--region", "diamond"},
      {"--region", "box"},        {"--scene", "push"},
      {"--scene", "impulse"},     {"--scene", "fall"},
      {"--scene", "slope"},       {"--scene", "box"},
      {"--preset", "tackle"},     {"--preset", "shot"},
      {"--pose", "rest"},         {"--pose", "guard"},
      {"--sex", "female"},        {"--mass", "120"},
      {"--active-delay", "0.05"}, {"--damping", "0"},
      {"--ball-radius", "0.3"},   {"--active-k", "20"}};
  for (std::vector<std::string> options : variations) {
    SCOPED_TRACE(options[0] + " " + options[1]);
    options.insert(options.begin(), {"bake", "mannequin", "--json", "--duration", "0.5"});
    const Ran result = run(options);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(Json::accept(result.out));
  }
}

TEST_F(Bake, FromAClipBeginsWhereTheClipIs) {
  const Json report = report_of({"--clip", "walk", "--at", "0.5", "--hit", "head", "--from", "left"});
  EXPECT_EQ(report["settings"]["clip"], "walk");
  EXPECT_EQ(report["settings"]["at_s"], 0.5);
  EXPECT_LT(report["impact"]["position_jump_m"], 1e-9);
  EXPECT_LT(report["impact"]["velocity_jump_m_s"], 1.0) << "the pelvis walks on";
  expect_human(report, kMovingFloor);
}

TEST_F(Bake, OfAFileOfMotionStartsFromItsOwnClip) {
  const std::string bvh = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh";
  const Ran result = run({"bake", bvh, "--at", "0.4", "--json", "-o", "a.bvh", "-o", "a.glb"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json report = Json::parse(result.out);
  EXPECT_EQ(report["settings"]["at_s"], 0.4);
  EXPECT_TRUE(report["settings"]["pose"].is_null());
  expect_human(report, kMovingFloor);
}

TEST_F(Bake, TwoClipsAreComparedWithAStatus) {
  for (const char* from : {"left", "right"})
    succeed({"bake", "mannequin", "--hit", "head", "--from", from, "--duration", "0.3", "-o",
             std::string(from) + ".glb"});
  EXPECT_EQ(run({"diff", "left.glb", "left.glb"}).status, 0);
  const Ran other = run({"diff", "left.glb", "right.glb"});
  EXPECT_EQ(other.status, 1) << other.err;
  EXPECT_EQ(other.out.rfind("different: ", 0), 0u) << other.out;
  EXPECT_EQ(run({"diff", "left.glb", "right.glb", "--json"}).status, 1);
}

TEST_F(Bake, IsReadBackByTheOtherCommands) {
  succeed({"bake", "mannequin", "--hit", "head", "--from", "left", "--behaviour", "limp", "--duration", "3",
           "-o", "a.glb", "-o", "a.bvh"});
  const std::string same = succeed({"diff", "a.glb", "a.bvh"});
  EXPECT_EQ(same.rfind("same: ", 0), 0u) << same;
  const Json inspection = Json::parse(succeed({"inspect", "a.glb", "--json"}));
  EXPECT_EQ(inspection["verdict"], "humanoid");
  EXPECT_EQ(inspection["clips"].back()["name"], "head_left");
  EXPECT_EQ(inspection["clips"].back()["fps"], 60.0);
  const Json& rom = inspection["clips"].back()["rom"];
  EXPECT_EQ(rom["over_1deg_fraction"], 0.0) << rom;
  EXPECT_LT(rom["excess_max_deg"], 0.5) << rom;
  EXPECT_EQ(rom["rolls"], "stored");
  const Json motion = Json::parse(succeed({"inspect", "a.bvh", "--json"}))["clips"].back()["rom"];
  EXPECT_EQ(motion["over_1deg_fraction"], 0.0) << motion;
  EXPECT_EQ(motion["neutral"], "rest");
  EXPECT_EQ(rom["joints"].size(), 17u);
  EXPECT_EQ(rom["joints"]["knee_l"]["over_1deg_fraction"], 0.0) << rom;
  succeed({"render", "a.glb", "-o", "a.png"});
  EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
  succeed({"render", "a.bvh", "--shapes", "-o", "b.png"});
  EXPECT_EQ(files(), (std::vector<std::string>{"a.bvh", "a.glb", "a.png", "b.png"}));
}

/// A .gltf whose buffer and image lie beside it.
void write_linked(const fs::path& folder) {
  fs::create_directory(folder);
  std::ifstream source(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb", std::ios::binary);
  const std::string glb{std::istreambuf_iterator<char>(source), {}};
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  auto json = nlohmann::ordered_json::parse(glb.substr(20, length));
  json["buffers"][0]["uri"] = "my%20figure.bin";
  json["images"] = {{{"uri", "skin.png"}}};
  std::ofstream(folder / "figure.gltf") << json.dump();
  std::ofstream(folder / "my figure.bin", std::ios::binary) << glb.substr(28 + length);
  std::ofstream(folder / "skin.png", std::ios::binary) << "\x89PNG\r\n\x1a\n";
}

TEST_F(Bake, OfALinkedGltfIsWholeInAnotherFolderAndKeepsItsLinksInItsOwn) {
  write_linked(folder / "in");
  fs::create_directory(folder / "out");
  succeed({"bake", "in/figure.gltf", "-o", "in/hit.gltf", "-o", "out/hit.gltf", "-o", "out/hit.glb"});
  const Json beside = Json::parse(read("in/hit.gltf"));
  EXPECT_EQ(beside["buffers"][0]["uri"], "my%20figure.bin");
  EXPECT_EQ(beside["images"][0]["uri"], "skin.png");
  succeed({"inspect", "in/hit.gltf"});
  const Json elsewhere = Json::parse(read("out/hit.gltf"));
  EXPECT_EQ(elsewhere["buffers"][0]["uri"].get<std::string>().rfind("data:", 0), 0u);
  EXPECT_EQ(elsewhere["images"][0]["uri"].get<std::string>().rfind("data:image/png", 0), 0u);
  fs::remove_all(folder / "in");
  for (const char* file : {"out/hit.gltf", "out/hit.glb"}) {
    const Json inspection = Json::parse(succeed({"inspect", file, "--json"}));
    EXPECT_EQ(inspection["verdict"], "humanoid") << file;
    EXPECT_EQ(inspection["clips"].back()["name"], "chest_front") << file;
  }
}

TEST_F(Bake, OtherBlowsGiveOtherClips) {
  succeed({"bake", "mannequin", "--from", "front", "-o", "a.glb"});
  succeed({"bake", "mannequin", "--from", "back", "-o", "b.glb"});
  const Ran result = run({"diff", "a.glb", "b.glb", "--json"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err, "");
  const Json difference = Json::parse(result.out);
  EXPECT_FALSE(difference["within_tolerance"]);
  EXPECT_GT(difference["position_max_mm"], 100.0);
}

TEST_F(Bake, InspectAnswersWithTheVerdict) {
  EXPECT_EQ(Json::parse(succeed({"inspect", "mannequin", "--json"}))["verdict"], "humanoid");
  write("box.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"name":"box"}],"scenes":[{"nodes":[0]}],"scene":0})");
  const Ran box = run({"inspect", "box.gltf", "--json"});
  EXPECT_EQ(box.status, 1);
  EXPECT_EQ(Json::parse(box.out)["verdict"], "not-humanoid");
  write("noise.glb", "noise");
  const Ran noise = run({"inspect", "noise.glb", "--json"});
  EXPECT_EQ(noise.status, 2);
  EXPECT_EQ(Json::parse(noise.out)["verdict"], "malformed");
  EXPECT_NE(noise.err.find("ukemi: error: noise.glb"), std::string::npos);
}

struct ExtraBake {
  const char* character;
  std::vector<std::string> options;
};

TEST_F(Bake, OfCharactersMadeByOthersStaysHuman) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  const ExtraBake bakes[] = {
      {"mocap/cmu_bvh/cmu_12_01_walk.bvh", {"--at", "0.5", "--hit", "head", "--from", "left"}},
      {"characters/quaternius_glb/modular_men/Casual.glb", {"--hit", "pelvis", "--from", "right"}},
      {"characters/ozz_pab_fbx/arnaud.fbx", {"--hit", "chest", "--from", "back"}},
      {"characters/khronos/cesium_man.gltf", {"--hit", "chest", "--from", "left"}},
      {"characters/vrm_addon/basic_armature_vrm1.vrm", {"--hit", "head", "--from", "front"}},
  };
  for (const ExtraBake& bake : bakes) {
    SCOPED_TRACE(bake.character);
    const fs::path character = *data / bake.character;
    ASSERT_TRUE(fs::exists(character));
    std::vector<std::string> arguments = {"bake", character.string(), "--json", "-o", "a.glb", "-o", "a.bvh"};
    arguments.insert(arguments.end(), bake.options.begin(), bake.options.end());
    const Ran result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    expect_human(Json::parse(result.out), kMovingFloor);
    const Ran same = run({"diff", "a.glb", "a.bvh"});
    EXPECT_EQ(same.status, 0) << same.out << same.err;
  }
}

TEST_F(Bake, TheAimMovesTheBlow) {
  const auto clip = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"bake", "mannequin", "--duration", "0.2", "--quiet", "-o", "a.bvh"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).status, 0);
    return read("a.bvh");
  };
  const std::string centre = clip({}), left = clip({"--aim-left", "0.1"}), up = clip({"--aim-up", "0.1"});
  EXPECT_NE(left, centre);
  EXPECT_NE(up, centre);
  EXPECT_NE(up, left);
}

}  // namespace
}  // namespace ukemi
