// What other programs make of our files: the Khronos validator finds no issue that the source does not have,
// and three.js plays every clip with each joint where we have it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "export/export.h"
#include "load/load.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kGltfToleranceM = 0.0001;
constexpr double kBvhToleranceM = 0.0005;
constexpr int kTimes = 10;

/// Named in UKEMI_EXTRA_DATA.
constexpr std::array kFurther{"characters/quaternius_glb/modular_men/Casual.glb",
                              "characters/quaternius_glb/RobotExpressive.glb",
                              "characters/kaykit/manny_med_mod.gltf",
                              "characters/khronos/cesium_man.gltf",
                              "characters/quaternius_glb/modular_women/Witch.glb",
                              "characters/vrm_addon/basic_armature.vrm",
                              "characters/vrm_addon/basic_armature_vrm1.vrm",
                              "characters/ozz_pab_fbx/arnaud.fbx",
                              "characters/ozz_pab_fbx/walk.fbx",
                              "characters/quaternius_fbx/Male_Casual.fbx",
                              "characters/ozz_pab_collada/skeleton.dae",
                              "mocap/cmu_bvh/cmu_12_01_walk.bvh",
                              "mocap/other_bvh/makehuman/walk1.bvh"};

/// The program's output and exit status.
std::pair<std::string, int> run(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {"cannot start " + command, -1};
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), n);
  const int status = pclose(pipe);
  return {output, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

/// Every segment turns about the joint above it.
BodyPose swayed(const BodyPose& start, double t) {
  BodyPose now = start;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Vec3 axis = Vec3(std::sin(1.0 + s), std::cos(2.0 * s), std::sin(3.0 * s)).normalized();
    now[s].rotation = exp_rotation(axis * (0.6 * std::sin(2 * t + s))) * start[s].rotation;
    const int parent = index(parent_of(segment_at(s)));
    if (s == parent)
      now[s].translation += Vec3(0.2 * t, 0.1 * std::sin(t), 0);
    else
      now[s].translation = now[parent] * (start[parent].inverse() * start[s].translation);
  }
  return now;
}

Clip swaying_clip(const Character& character, const Humanoid& humanoid) {
  Clip clip{"ukemi sway", 30.0, {}, {}};
  const BodyPose start = segments_of(character.skeleton, humanoid, humanoid.reference);
  for (int f = 0; f <= 60; ++f)
    clip.frames.push_back(
        pose_skeleton(character.skeleton, humanoid, humanoid.reference, start, swayed(start, f / clip.fps)));
  return clip;
}

class Clients : public testing::Test {
 protected:
  Clients() : folder_(fs::temp_directory_path() / fmt::format("ukemi_clients_{}", getpid())) {
    fs::create_directories(folder_);
  }
  ~Clients() override { fs::remove_all(folder_); }

  static bool installed() {
    return fs::exists(fs::path(UKEMI_CLIENTS_FOLDER) / "node_modules" / "gltf-validator");
  }
  static std::vector<fs::path> own_sources() {
    const fs::path characters = fs::path(UKEMI_ASSETS_FOLDER) / "characters";
    return {characters / "mannequin.glb", characters / "mannequin.bvh"};
  }

  /// Writes every format of every source and lists what the scripts shall look at.
  void write(const std::vector<fs::path>& sources) {
    for (const fs::path& source : sources) {
      SCOPED_TRACE(source.string());
      Diagnostics diagnostics;
      const auto character = load_character(source, {}, diagnostics);
      ASSERT_TRUE(character) << character.error().message();
      const auto humanoid = map_humanoid(*character, {}, diagnostics);
      ASSERT_TRUE(humanoid) << humanoid.error().message();
      write(source, *character, *humanoid);
    }
  }

  void write(const fs::path& source, const Character& character, const Humanoid& humanoid) {
    const Clip clip = swaying_clip(character, humanoid);
    const ReducedClip reduced =
        reduce_keys(character.skeleton, clip, humanoid.world_from_file, {true, 0.0005});
    const fs::path base = folder_ / (std::to_string(list_.size()) + '_' + source.stem().string());
    const fs::path glb = fs::path(base) += ".glb";
    const fs::path gltf = fs::path(base) += ".gltf";
    const fs::path bvh = fs::path(base) += ".bvh";
    const auto glb_bytes = write_glb(character, humanoid, reduced, {});
    ASSERT_TRUE(glb_bytes) << glb_bytes.error().message();
    ASSERT_TRUE(write_file(glb, *glb_bytes));
    const auto gltf_text = write_gltf(character, humanoid, reduced, {});
    ASSERT_TRUE(gltf_text) << gltf_text.error().message();
    ASSERT_TRUE(write_file(gltf, *gltf_text));
    const BvhOptions centimetres;
    const auto bvh_text = write_bvh(character, humanoid, clip, centimetres);
    ASSERT_TRUE(bvh_text) << bvh_text.error().message();
    ASSERT_TRUE(write_file(bvh, *bvh_text));

    const std::string name = source.filename().string();
    const bool is_gltf = character.format == SourceFormat::gltf;
    for (const fs::path& after : {glb, gltf}) {
      Json item{{"name", name + " to " + after.extension().string()},
                {"before", nullptr},
                {"after", after.string()}};
      if (is_gltf) item["before"] = source.string();
      // assimp's scenes keep skinned meshes below other nodes, nodes that hold nothing and coordinates of
      // textures that are not there.
      if (!is_gltf)
        item["allowed"] = {"NODE_SKINNED_MESH_NON_ROOT", "NODE_EMPTY", "NODE_SKINNED_MESH_LOCAL_TRANSFORMS",
                           "UNUSED_OBJECT"};
      list_.push_back(item);
    }
    play_glb(name, glb, character, humanoid, reduced);
    play_bvh(name, bvh, character, humanoid, clip, centimetres);
  }

  /// At times between the frames; the tracks as we interpolate them.
  void play_glb(const std::string& name, const fs::path& file, const Character& character,
                const Humanoid& humanoid, const ReducedClip& reduced) {
    const bool has_world = character.format != SourceFormat::gltf;
    Json item{{"name", name + " as .glb"}, {"file", file.string()}, {"animation", reduced.name}};
    item["tolerance"] = kGltfToleranceM / (has_world ? 1.0 : humanoid.world_from_file.scale);
    item["nodes"] = character.skeleton.order;
    const Animation animation{"", 0, 2, 0, reduced.tracks};
    for (int i = 0; i < kTimes; ++i) {
      const double time = 2.0 * i / (kTimes - 1);
      const auto world = world_transforms(character.skeleton, sample(character.skeleton, animation, time));
      Json positions = Json::array();
      for (const int node : character.skeleton.order) {
        const Vec3 at = world[node].translation();
        const Vec3 seen = has_world ? humanoid.world_from_file * at : at;
        positions.push_back({seen.x(), seen.y(), seen.z()});
      }
      item["times"].push_back(time);
      item["positions"].push_back(positions);
    }
    played_.push_back(item);
  }

  /// three.js adds a joint's position channels to its OFFSET; every other reader, and ours, lets them replace
  /// it.
  static bool three_adds_offsets(const Character& character) {
    for (std::size_t joint = 0; character.bvh && joint < character.bvh->channels.size(); ++joint) {
      const auto& channels = character.bvh->channels[joint];
      const bool has_position =
          std::find(channels.begin(), channels.end(), BvhChannel::x_position) != channels.end();
      if (has_position && !character.skeleton.nodes[joint].rest.translation.isZero()) return true;
    }
    return false;
  }

  /// At frames, in the file's unit; joints in the order in which the file lists them.
  void play_bvh(const std::string& name, const fs::path& file, const Character& character,
                const Humanoid& humanoid, const Clip& clip, const BvhOptions& options) {
    if (three_adds_offsets(character)) return;
    Diagnostics diagnostics;
    const auto written = load_character(file, {}, diagnostics);
    ASSERT_TRUE(written) << written.error().message();
    const bool is_bvh = character.format == SourceFormat::bvh;
    const double unit = is_bvh ? humanoid.world_from_file.scale : options.metres_per_unit;
    Json item{{"name", name + " as .bvh"}, {"file", file.string()}, {"tolerance", kBvhToleranceM / unit}};
    std::vector<int> nodes;
    for (int joint = 0; joint < written->skeleton.size(); ++joint) {
      const int node = is_bvh ? joint : plain_find(character.skeleton, written->skeleton.nodes[joint].name);
      ASSERT_GE(node, 0) << written->skeleton.nodes[joint].name;
      nodes.push_back(node);
      item["nodes"].push_back(joint);
    }
    for (int i = 0; i < kTimes; ++i) {
      const std::size_t frame = (clip.frames.size() - 1) * static_cast<std::size_t>(i) / (kTimes - 1);
      const auto world = world_transforms(character.skeleton, clip.frames[frame]);
      Json positions = Json::array();
      for (const int node : nodes) {
        const Vec3 at = world[node].translation();
        const Vec3 seen = is_bvh ? at : Vec3(humanoid.world_from_file * at / unit);
        positions.push_back({seen.x(), seen.y(), seen.z()});
      }
      item["times"].push_back(static_cast<double>(frame) / clip.fps);
      item["positions"].push_back(positions);
    }
    played_.push_back(item);
  }

  /// The node whose label, without blanks, is `name`.
  static int plain_find(const Skeleton& skeleton, const std::string& name) {
    for (int i = 0; i < skeleton.size(); ++i) {
      std::string label = skeleton.label(i);
      std::replace(label.begin(), label.end(), ' ', '_');
      if (label == name) return i;
    }
    return -1;
  }

  void run_scripts() {
    for (const auto& [script, list] : {std::pair("validate.mjs", list_), std::pair("play.mjs", played_)}) {
      const fs::path file = folder_ / (std::string(script) + ".json");
      ASSERT_TRUE(write_file(file, list.dump()));
      const fs::path path = fs::path(UKEMI_CLIENTS_FOLDER) / script;
      const auto [output, status] = run(fmt::format("node '{}' '{}'", path.string(), file.string()));
      fmt::print("{}", output);
      EXPECT_EQ(status, 0) << output;
    }
  }

  fs::path folder_;
  Json list_ = Json::array();
  Json played_ = Json::array();
};

constexpr const char* kNotInstalled =
    "the packages of tests/clients are not installed: npm ci --prefix tests/clients";

TEST_F(Clients, AcceptWhatIsWrittenForTheMannequin) {
  if (!installed()) GTEST_SKIP() << kNotInstalled;
  write(own_sources());
  run_scripts();
}

TEST_F(Clients, AcceptWhatIsWrittenForFurtherCharacters) {
  const char* data = std::getenv("UKEMI_EXTRA_DATA");
  if (data == nullptr)
    GTEST_SKIP() << "without UKEMI_EXTRA_DATA: " << kFurther.size() << " characters left out";
  if (!installed()) GTEST_SKIP() << kNotInstalled;
  std::vector<fs::path> sources;
  for (const char* file : kFurther)
    if (fs::exists(fs::path(data) / file)) sources.push_back(fs::path(data) / file);
  ASSERT_GE(sources.size(), 6u) << "characters found in " << data;
  write(sources);
  run_scripts();
}

}  // namespace
}  // namespace ukemi
