// Every file made by others: what is expected of it, what the program says, and how it bakes with no option.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "bake/bake.h"
#include "check/inspect.h"
#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

/// Where the manifest and the program differ, and why the program is right.
const std::map<std::string, std::pair<std::string, const char*>> kArgued = {
    {"animation_only/nop.vrma",
     {"humanoid", "a still pose of a human skeleton: a source of poses, like a BVH"}},
    {"animation_only/kaykit/Med_General.glb",
     {"humanoid", "motion of a human skeleton, as the manifest grants"}},
    {"animation_only/kaykit/Med_MovementBasic.glb", {"humanoid", "the same"}},
    {"animation_only/kaykit/Med_Simulation.glb", {"humanoid", "the same"}},
    {"malformed/gltf_validator/glb/extra_data.glb",
     {"malformed", "without a single node nothing can be judged"}},
    {"malformed/gltf_validator/skin/no_common_root.gltf",
     {"not-humanoid",
      "exporters write skins with several roots; they load, and these two nodes are no human"}},
    {"malformed/assimp/BoxTextured.gltf", {"not-humanoid", "its .bin, said to be missing, lies beside it"}},
    {"malformed/assimp/BoxWithInfinites.glb",
     {"malformed", "glTF 2.0 section 3.6.2.2: NaN and infinities must not be in accessors"}},
    {"malformed/assimp/library_animation_clips.dae", {"malformed", "its reader cannot parse it"}},
    {"malformed/ozz/cube.fbx", {"malformed", "its reader does not know so old an FBX"}},
};

struct Outcome {
  Inspection inspection;
  std::string problems;
  std::string bake = "-";
};

std::string baked(const Character& character, std::string& problems) {
  BakeSettings settings;
  settings.simulation.duration_s = 0.8;
  Diagnostics diagnostics;
  const auto outcome = bake(character, settings, diagnostics);
  if (!outcome) {
    problems += " bake: " + outcome.error().message();
    return "failed";
  }
  const LimitFigures& limits = outcome->limits;
  if (limits.over_1deg > 0) problems += " outside the range of motion";
  if (outcome->figures.joint_separation_max_m > 0.01 * outcome->prepared.humanoid.height_m)
    problems += " joints part";
  return fmt::format("{:>5} {:>6.2f} {:>7.1f}", limits.over_1deg, limits.excess_max_deg,
                     1000.0 * outcome->figures.joint_separation_max_m);
}

/// The verdict in the words of `ukemi inspect`.
std::string expected_verdict(const ExtraFile& entry) {
  return entry.verdict == "refused-nonhumanoid" ? "not-humanoid" : entry.verdict;
}

Outcome examine(const fs::path& folder, const ExtraFile& entry) {
  Outcome outcome;
  Diagnostics diagnostics;
  auto inspection = inspect((folder / entry.file).string(), {}, diagnostics);
  if (!inspection) {
    outcome.problems = inspection.error().message();
    return outcome;
  }
  outcome.inspection = std::move(*inspection);
  const auto argued = kArgued.find(entry.file);
  const std::string expected = argued == kArgued.end() ? expected_verdict(entry) : argued->second.first;
  if (name(outcome.inspection.verdict) != expected) outcome.problems += " expected " + expected;
  if (outcome.inspection.verdict == Verdict::humanoid)
    outcome.bake = baked(*outcome.inspection.character, outcome.problems);
  else if (!outcome.inspection.error || outcome.inspection.error->fix.empty())
    outcome.problems += " no fix";
  else if (exit_status(outcome.inspection.error->kind) != 2)
    outcome.problems += " wrong exit status";
  return outcome;
}

int mapped_segments(const Inspection& inspection) {
  int count = 0;
  for (int s = 0; inspection.humanoid && s < kSegmentCount; ++s)
    count += inspection.humanoid->segments[s].fused() ? 0 : 1;
  return count;
}

TEST(DataSet, EveryFileGetsItsVerdictAndEveryHumanoidBakes) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  int humanoids = 0, disagreements = 0, argued = 0;
  fmt::print("{:<13} {:<13} {:>7} {:>4} {:>5} {:>6} {:>7}  {}\n", "expected", "ours", "height", "map",
             ">1deg", "excess", "part/mm", "file");
  for (const ExtraFile& entry : extra_files(*data)) {
    const Outcome outcome = examine(*data, entry);
    const Inspection& inspection = outcome.inspection;
    humanoids += entry.verdict == "humanoid" && inspection.verdict == Verdict::humanoid ? 1 : 0;
    argued += static_cast<int>(kArgued.count(entry.file));
    const std::string height =
        inspection.humanoid ? fmt::format("{:.2f} m", inspection.humanoid->height_m) : "-";
    fmt::print("{:<13} {:<13} {:>7} {:>4} {:>20}  {}\n", expected_verdict(entry), name(inspection.verdict),
               height, mapped_segments(inspection), outcome.bake, entry.file);
    EXPECT_TRUE(outcome.problems.empty()) << entry.file << ":" << outcome.problems;
    disagreements += outcome.problems.empty() ? 0 : 1;
  }
  fmt::print("{} humanoids, {} disagreements, {} argued\n", humanoids, disagreements, argued);
  EXPECT_GE(humanoids, 60);
  EXPECT_EQ(argued, static_cast<int>(kArgued.size())) << "an argued file is gone";
}

}  // namespace
}  // namespace ukemi
