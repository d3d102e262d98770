// The example recipes' reactions, bit for bit: whatever changes a clip is seen here. After a change that is
// meant to, UKEMI_UPDATE_GOLDEN=1 writes tests/data/golden_reactions.json again.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "base/character_path.h"
#include "base/digest.h"
#include "batch/recipe.h"
#include "load/load.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSeen_s = 0.1;         // after the blow: before rounding has grown into another motion
constexpr double kTolerance_m = 0.005;  // on other processors and in other builds

/// Bits are the same for one kind of build on one kind of processor: the C library picks its functions by
/// what the processor has.
std::string kind_of_machine() {
#if defined(__x86_64__) && defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "x86-64 fma gcc release" : "other";
#else
  return "other";
#endif
}

Json segments_json(const BakedClip& outcome) {
  Json json = Json::array();
  const Trajectory& trajectory = outcome.timeline.trajectory;
  const auto frame = static_cast<std::size_t>(kSeen_s * trajectory.fps);
  for (const Rigid& segment : trajectory.frames.at(frame))
    for (int axis = 0; axis < 3; ++axis) json.push_back(segment.translation[axis]);
  return json;
}

/// The first reaction of every matrix of a recipe, without pictures.
Json reactions_json(const std::string& recipe_name) {
  Json json = Json::object();
  const auto recipe = load_recipe(fs::path(UKEMI_ASSETS_FOLDER) / "recipes" / (recipe_name + ".toml"));
  EXPECT_TRUE(recipe) << recipe.error().message();
  Recipe first = *recipe;
  for (RecipeMatrix& matrix : first.matrices)
    for (auto& axis : matrix.axes) axis.second.resize(1);
  const auto reactions = reactions_of(first, {});
  EXPECT_TRUE(reactions) << reactions.error().message();
  Diagnostics diagnostics;
  const auto character = load_character(*character_path("mannequin"), LoadOptions{}, diagnostics);
  for (Reaction reaction : *reactions) {
    if (reaction.variation > 0) continue;
    reaction.settings.outputs = {"a.glb", "a.bvh"};
    reaction.settings.sheet.clear();
    const auto baked = bake_loaded(*character, reaction.settings, diagnostics);
    EXPECT_TRUE(baked) << baked.error().message();
    json[recipe_name + "/" + reaction.name] = {{"glb", digest_of(baked->files[0].bytes)},
                                               {"bvh", digest_of(baked->files[1].bytes)},
                                               {"segments_m", segments_json(baked->outcome)}};
  }
  return json;
}

void expect_near(const std::string& name, const Json& golden, const Json& now) {
  ASSERT_EQ(golden.size(), now.size()) << name;
  for (std::size_t i = 0; i < golden.size(); ++i)
    EXPECT_NEAR(golden[i].get<double>(), now[i].get<double>(), kTolerance_m) << name;
}

TEST(Golden, ReactionsOfTheExampleRecipes) {
  const fs::path file = fs::path(UKEMI_TEST_DATA) / "golden_reactions.json";
  Json now = {{"machine", kind_of_machine()}, {"reactions", Json::object()}};
  for (const char* recipe : {"flinches", "falls", "paper"}) now["reactions"].update(reactions_json(recipe));
  if (std::getenv("UKEMI_UPDATE_GOLDEN") != nullptr) std::ofstream(file) << now.dump(1) << "\n";
  const Json golden = Json::parse(std::ifstream(file));
  ASSERT_EQ(golden["reactions"].size(), 13u);
  ASSERT_EQ(now["reactions"].size(), 13u);
  for (const auto& [name, reaction] : golden["reactions"].items()) {
    expect_near(name, reaction["segments_m"], now["reactions"][name]["segments_m"]);
    if (golden["machine"] != now["machine"]) continue;
    EXPECT_EQ(reaction["glb"], now["reactions"][name]["glb"]) << name;
    EXPECT_EQ(reaction["bvh"], now["reactions"][name]["bvh"]) << name;
  }
}

}  // namespace
}  // namespace ukemi
