// What other programs make of our files: the Khronos validator finds no issue that the source does not have,
// and three.js and Blender play every clip with each joint where we have it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "base/files.h"
#include "clip/names.h"
#include "clip/start.h"
#include "export/export.h"
#include "load/load.h"
#include "support/command.h"
#include "support/extra_data.h"

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

/// Of kFurther: a VRM of each version and an FBX.
constexpr std::array kForOptions{"basic_armature.vrm", "basic_armature_vrm1.vrm", "Male_Casual.fbx"};

/// Each option that changes what a glTF output holds; every file gets a second reaction by --append.
constexpr std::array<std::pair<const char*, void (*)(BakeSettings&)>, 13> kOptions{{
    {"default", [](BakeSettings&) {}},
    {"clip-only", [](BakeSettings& s) { s.clip_only = true; }},
    {"align", [](BakeSettings& s) { s.ground.align = true; }},
    {"extra-bones_clip", [](BakeSettings& s) { s.extra_bones_play = true; }},
    {"root-motion_root", [](BakeSettings& s) { s.ground.root_motion = RootMotion::root; }},
    {"root-motion_in-place", [](BakeSettings& s) { s.ground.root_motion = RootMotion::in_place; }},
    {"additive_identity", [](BakeSettings& s) { s.additive = Additive::identity; }},
    {"additive_rest", [](BakeSettings& s) { s.additive = Additive::rest; }},
    {"all-joints", [](BakeSettings& s) { s.all_joints = true; }},
    {"rotation-type_int16", [](BakeSettings& s) { s.keys.short_rotations = true; }},
    {"recover", [](BakeSettings& s) { s.recover_s = 0.3; }},
    {"lead", [](BakeSettings& s) { s.lead_s = 0.25; }},
    {"keys_all", [](BakeSettings& s) { s.keys.enabled = false; }},
}};

class Clients : public testing::Test {
 protected:
  Clients() : folder_(fs::temp_directory_path() / fmt::format("ukemi_clients_{}", getpid())) {
    fs::create_directories(folder_);
  }
  ~Clients() override { fs::remove_all(folder_); }

  static bool has_packages() {
    return fs::exists(fs::path(UKEMI_CLIENTS_FOLDER) / "node_modules" / "gltf-validator");
  }
  static bool has_blender() {
    return run_command("blender --background --python-exit-code 1 --python-expr 'import numpy'").second == 0;
  }
  static std::vector<fs::path> own_sources() {
    const fs::path characters = fs::path(UKEMI_ASSETS_FOLDER) / "characters";
    return {characters / "mannequin.glb", characters / "mannequin.bvh"};
  }
  static std::vector<fs::path> further_sources() {
    std::vector<fs::path> sources;
    const auto data = extra_data();
    for (const char* file : kFurther)
      if (data && fs::exists(*data / file)) sources.push_back(*data / file);
    return sources;
  }

  static Character loaded(const fs::path& source) {
    Diagnostics diagnostics;
    auto character = load_character(source, {}, diagnostics);
    EXPECT_TRUE(character) << character.error().message();
    return character ? std::move(*character) : Character{};
  }
  /// Bakes and writes; false, and the test has failed, when that fails.
  static bool write(const Character& character, const BakeSettings& settings, BakedFile& baked) {
    Diagnostics diagnostics;
    auto made = bake_loaded(character, settings, diagnostics);
    EXPECT_TRUE(made) << made.error().message();
    if (!made) return false;
    baked = std::move(*made);
    const Status written = write_files(baked);
    EXPECT_TRUE(written) << written.error().message();
    return bool(written);
  }

  /// Bakes every format of every source and lists what the scripts shall look at.
  void bake_all(const std::vector<fs::path>& sources, bool clip_only = false) {
    for (const fs::path& source : sources) {
      SCOPED_TRACE(source.string());
      const fs::path base = folder_ / (std::to_string(validated_.size()) + '_' + source.stem().string());
      BakeSettings settings;
      for (const char* extension : {".glb", ".gltf", ".bvh"})
        settings.outputs.push_back(fs::path(base) += extension);
      settings.clip_only = clip_only;
      const Character character = loaded(source);
      BakedFile baked;
      if (!write(character, settings, baked)) continue;
      validate(source, character, settings.outputs);
      play_glb(settings.outputs[0], character, baked);
      play_bvh(settings.outputs[2], character, baked.outcome);
    }
  }

  void validate(const fs::path& source, const Character& character, const std::vector<fs::path>& outputs) {
    const bool is_gltf = character.format == SourceFormat::gltf;
    for (const fs::path& after : {outputs[0], outputs[1]}) {
      Json item{{"name", source.filename().string() + " to " + after.extension().string()},
                {"before", nullptr},
                {"after", after.string()}};
      if (is_gltf) item["before"] = source.string();
      item["allowed"] = allowed_for(character);
      validated_.push_back(item);
    }
  }

  /// What the validator may find new in a file whose source is no glTF: assimp's scenes keep skinned meshes
  /// below other nodes, nodes that hold nothing and coordinates of textures that are not there.
  static Json allowed_for(const Character& character) {
    if (character.format == SourceFormat::gltf) return Json::array();
    return {"NODE_SKINNED_MESH_NON_ROOT", "NODE_EMPTY", "NODE_SKINNED_MESH_LOCAL_TRANSFORMS",
            "UNUSED_OBJECT"};
  }

  static std::vector<fs::path> sources_for_options() {
    std::vector<fs::path> sources{own_sources().front()};
    for (const fs::path& further : further_sources())
      for (const char* file : kForOptions)
        if (further.string().ends_with(file)) sources.push_back(further);
    return sources;
  }

  /// A file per option, and one that several reactions are appended to.
  void bake_options(const fs::path& source) {
    const Character character = loaded(source);
    for (const auto& [option, set] : kOptions) {
      BakeSettings settings;
      settings.simulation.duration_s = 0.5;
      set(settings);
      if (settings.extra_bones_play && !character.animations.empty())
        settings.clip = clip_label(character, 0);
      const fs::path file = folder_ / (source.stem().string() + '_' + option + ".glb");
      settings.outputs = {file};
      BakedFile baked;
      if (!write(character, settings, baked)) continue;
      settings.append = true;
      settings.hit = Segment::head;
      if (settings.additive != Additive::off) settings.lead_s = 0.1;
      if (!write(character, settings, baked)) continue;
      Json item{{"name", source.filename().string() + " with " + option}, {"before", nullptr}};
      if (character.format == SourceFormat::gltf) item["before"] = source.string();
      item["after"] = file.string();
      item["allowed"] = allowed_for(character);
      // The skin of a clip without its mesh is there for the sake of its bones.
      if (settings.clip_only || settings.ground.root_motion == RootMotion::root)
        item["allowed"].push_back("UNUSED_OBJECT");
      validated_.push_back(item);
    }
  }

  /// At times between the frames; the tracks as we interpolate them.
  void play_glb(const fs::path& file, const Character& character, const BakedFile& baked) {
    const Similarity& world_from_file = baked.outcome.prepared.humanoid.world_from_file;
    const ReducedClip& clip = baked.reduced;
    const bool has_world = character.format != SourceFormat::gltf;
    Json item{{"name", character.path.filename().string() + " as .glb"},
              {"file", file.string()},
              {"animation", clip.name},
              {"three_adds_offsets", false}};
    item["tolerance"] = kGltfToleranceM / (has_world ? 1.0 : world_from_file.scale);
    item["nodes"] = character.skeleton.order;
    const double end_s = baked.outcome.timeline.clip.duration_s();
    const Animation animation{"", 0, end_s, 0, clip.tracks};
    for (int i = 0; i < kTimes; ++i) {
      const double time = end_s * i / (kTimes - 1);
      const auto world = world_transforms(character.skeleton, sample(character.skeleton, animation, time));
      Json positions = Json::array();
      for (const int node : character.skeleton.order) {
        const Vec3 at = world[node].translation();
        const Vec3 seen = has_world ? world_from_file * at : at;
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
  void play_bvh(const fs::path& file, const Character& character, const BakedClip& outcome) {
    const Similarity& world_from_file = outcome.prepared.humanoid.world_from_file;
    const Clip& clip = outcome.timeline.clip;
    const Character written = loaded(file);
    const bool is_bvh = character.format == SourceFormat::bvh;
    const double unit = is_bvh ? world_from_file.scale : BvhOptions{}.metres_per_unit;
    Json item{{"name", character.path.filename().string() + " as .bvh"},
              {"file", file.string()},
              {"tolerance", kBvhToleranceM / unit},
              {"three_adds_offsets", three_adds_offsets(character)}};
    std::vector<int> nodes;
    for (int joint = 0; joint < written.skeleton.size(); ++joint) {
      const int node = is_bvh ? joint : plain_find(character, written.skeleton.nodes[joint].name);
      ASSERT_GE(node, 0) << written.skeleton.nodes[joint].name;
      nodes.push_back(node);
      item["nodes"].push_back(joint);
    }
    for (int i = 0; i < kTimes; ++i) {
      const std::size_t frame = (clip.frames.size() - 1) * static_cast<std::size_t>(i) / (kTimes - 1);
      const auto world = world_transforms(character.skeleton, clip.frames[frame]);
      Json positions = Json::array();
      for (const int node : nodes) {
        const Vec3 at = world[node].translation();
        const Vec3 seen = is_bvh ? at : Vec3(world_from_file * at / unit);
        positions.push_back({seen.x(), seen.y(), seen.z()});
      }
      item["times"].push_back(static_cast<double>(frame) / clip.fps);
      item["positions"].push_back(positions);
    }
    played_.push_back(item);
  }

  static std::string without_blanks(std::string text) {
    std::replace(text.begin(), text.end(), ' ', '_');
    return text;
  }
  /// The node whose label, without blanks, is `name`; else the skin's joint of that name: a mesh may have the
  /// same.
  static int plain_find(const Character& character, const std::string& name) {
    const Skeleton& skeleton = character.skeleton;
    for (int i = 0; i < skeleton.size(); ++i)
      if (without_blanks(skeleton.label(i)) == name) return i;
    for (const Skin& skin : character.skins)
      for (const int joint : skin.joints)
        if (without_blanks(skeleton.nodes[joint].name) == name) return joint;
    return -1;
  }

  void run_script(const std::string& program, const char* script, const Json& list) {
    const fs::path file = folder_ / (std::string(script) + ".json");
    ASSERT_TRUE(write_file(file, list.dump()));
    const fs::path path = fs::path(UKEMI_CLIENTS_FOLDER) / script;
    const auto [output, status] =
        run_command(fmt::format("{} '{}' -- '{}'", program, path.string(), file.string()));
    fmt::print("{}", output);
    EXPECT_EQ(status, 0) << output;
  }
  void run_validator() { run_script("node", "validate.mjs", validated_); }
  void run_three() {
    Json list = Json::array();
    for (const Json& item : played_)
      if (!item["three_adds_offsets"].get<bool>()) list.push_back(item);
    run_script("node", "play.mjs", list);
  }
  void run_blender() {
    run_script("blender --background --factory-startup --python-exit-code 1 --python", "play.py", played_);
  }

  fs::path folder_;
  Json validated_ = Json::array();
  Json played_ = Json::array();
};

constexpr const char* kNoPackages =
    "the packages of tests/clients are not installed: npm ci --prefix tests/clients";
constexpr const char* kNoBlender =
    "Blender is not installed: tools/test --clients, or apt-get install blender python3-numpy";

TEST_F(Clients, ValidatorAndThreeTakeWhatIsBakedOfTheMannequin) {
  if (!has_packages()) GTEST_SKIP() << kNoPackages;
  bake_all(own_sources());
  run_validator();
  run_three();
}

TEST_F(Clients, ValidatorAndThreeTakeWhatIsBakedOfFurtherCharacters) {
  if (!extra_data()) GTEST_SKIP() << kNoExtraData;
  if (!has_packages()) GTEST_SKIP() << kNoPackages;
  ASSERT_GE(further_sources().size(), 6u) << "characters found";
  bake_all(further_sources());
  run_validator();
  run_three();
}

TEST_F(Clients, BlenderPlaysWhatIsBakedOfTheMannequin) {
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  bake_all(own_sources());
  bake_all(own_sources(), true);
  run_blender();
}

TEST_F(Clients, BlenderPlaysWhatIsBakedOfFurtherCharacters) {
  if (!extra_data()) GTEST_SKIP() << kNoExtraData;
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  ASSERT_GE(further_sources().size(), 6u) << "characters found";
  bake_all(further_sources());
  run_blender();
}

TEST_F(Clients, ValidatorTakesWhatEveryOptionWrites) {
  if (!has_packages()) GTEST_SKIP() << kNoPackages;
  for (const fs::path& source : sources_for_options()) {
    SCOPED_TRACE(source.string());
    bake_options(source);
  }
  run_validator();
}

}  // namespace
}  // namespace ukemi
