// Binary FBX in four programs of other people: Autodesk's SDK (fbx2gltf), three.js and Blender here, assimp
// in tests/fbx. Original rig and take together.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "base/files.h"
#include "load/load.h"
#include "support/command.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kTolerance_m = 1e-4;
constexpr int kEvery = 10;  // frames

class FbxClients : public testing::Test {
 protected:
  FbxClients() : folder_(fs::temp_directory_path() / fmt::format("ukemi_fbx_clients_{}", getpid())) {
    fs::create_directories(folder_);
  }
  ~FbxClients() override { fs::remove_all(folder_); }

  static bool has_package(const char* name) {
    return fs::exists(fs::path(UKEMI_CLIENTS_FOLDER) / "node_modules" / name);
  }
  static bool has_blender() {
    return run_command("blender --background --python-exit-code 1 --python-expr 'import numpy'").second == 0;
  }

  /// The mannequin from both its formats, and the FBX characters and motions made by others.
  static std::vector<fs::path> sources() {
    const fs::path characters = fs::path(UKEMI_ASSETS_FOLDER) / "characters";
    std::vector<fs::path> all{characters / "mannequin.glb", characters / "mannequin.bvh"};
    const auto data = extra_data();
    for (const char* prefix : {"characters/quaternius_fbx/", "characters/ozz_pab_fbx/", "mocap/cmu_fbx/"})
      for (const ExtraFile& file : data ? extra_files(*data, prefix) : std::vector<ExtraFile>{})
        all.push_back(*data / file.file);
    return all;
  }

  void bake_all() {
    for (const fs::path& source : sources()) {
      SCOPED_TRACE(source.string());
      Diagnostics diagnostics;
      const auto character = load_character(source, {}, diagnostics);
      ASSERT_TRUE(character) << character.error().message();
      BakeSettings settings;
      settings.simulation.duration_s = 1.5;
      settings.outputs = {folder_ / (std::to_string(played_.size()) + '_' + source.stem().string() + ".fbx")};
      auto baked = bake_loaded(*character, settings, diagnostics);
      ASSERT_TRUE(baked) << baked.error().message();
      ASSERT_TRUE(write_files(*baked));
      list(*character, *baked, settings.outputs[0]);
    }
  }

  /// Where the joints are to be, metres by the file's own unit, y up.
  void list(const Character& character, const BakedFile& baked, const fs::path& file) {
    const Humanoid& humanoid = baked.outcome.prepared.humanoid;
    const Clip& clip = baked.outcome.timeline.clip;
    const bool source_is_fbx = character.format == SourceFormat::assimp;
    const double metres =
        source_is_fbx ? character.metres_per_unit.value_or(0.01) : humanoid.world_from_file.scale;
    Json item{{"name", file.filename().string()}, {"file", file.string()}, {"animation", clip.name}};
    item["metres_per_unit"] = source_is_fbx ? metres : 0.01;
    item["tolerance"] = kTolerance_m * metres / humanoid.world_from_file.scale;
    for (std::size_t frame = 0; frame < clip.frames.size(); frame += kEvery) {
      item["times"].push_back(static_cast<double>(frame) / clip.fps);
      const auto world = world_transforms(character.skeleton, clip.frames[frame]);
      for (const int node : joints_of(character, humanoid)) {
        const Vec3 at =
            metres * (source_is_fbx ? world[node].translation()
                                    : humanoid.world_from_file.rotation * world[node].translation());
        item["positions"][character.skeleton.nodes[node].name].push_back({at.x(), at.y(), at.z()});
      }
    }
    played_.push_back(std::move(item));
  }

  /// The hips and what is below, without meshes and without names that come twice.
  static std::vector<int> joints_of(const Character& character, const Humanoid& humanoid) {
    const Skeleton& skeleton = character.skeleton;
    std::vector<int> joints;
    for (int node = 0; node < skeleton.size(); ++node) {
      const bool is_mesh = std::any_of(character.parts.begin(), character.parts.end(),
                                       [node](const MeshPart& part) { return part.node == node; });
      const bool below = node == humanoid.segments[index(Segment::pelvis)].node() ||
                         skeleton.is_ancestor(humanoid.segments[index(Segment::pelvis)].node(), node);
      if (below && !is_mesh && skeleton.find(skeleton.nodes[node].name) == node) joints.push_back(node);
    }
    return joints;
  }

  void run_script(const std::string& program, const char* script) {
    const fs::path file = folder_ / "list.json";
    ASSERT_TRUE(write_file(file, played_.dump()));
    const auto [output, status] = run_command(fmt::format(
        "{} '{}' -- '{}'", program, (fs::path(UKEMI_CLIENTS_FOLDER) / script).string(), file.string()));
    fmt::print("{}", output);
    EXPECT_EQ(status, 0) << output;
  }

  fs::path folder_;
  Json played_ = Json::array();
};

TEST_F(FbxClients, AutodesksSdkAndThreePlayEveryTake) {
  if (!has_package("fbx2gltf") || !has_package("three"))
    GTEST_SKIP() << "the packages of tests/clients are not installed: npm ci --prefix tests/clients";
  bake_all();
  run_script("node", "play_fbx.mjs");
}

TEST_F(FbxClients, BlenderPlaysEveryTake) {
  if (!has_blender()) GTEST_SKIP() << "Blender is not installed";
  bake_all();
  run_script("blender --background --factory-startup --python-exit-code 1 --python", "play_fbx.py");
}

}  // namespace
}  // namespace ukemi
