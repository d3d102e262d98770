#include "bake/bake.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bake/report.h"
#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

/// A bake in memory, with its report.
struct Baked {
  Character character;
  BakedClip outcome;
  Json report;
};

Baked bake_of(const std::filesystem::path& file, const BakeSettings& settings) {
  Diagnostics diagnostics;
  auto character = load_character(file, {}, diagnostics);
  EXPECT_TRUE(character) << character.error().message();
  auto outcome = bake(*character, settings, diagnostics);
  EXPECT_TRUE(outcome) << outcome.error().message();
  Baked baked{std::move(*character), std::move(*outcome), {}};
  BakedFile in_memory{baked.outcome, {}, {}, {}, {}, {}};
  in_memory.reduced = reduce_keys(baked.character.skeleton, baked.outcome.timeline.clip,
                                  baked.outcome.prepared.humanoid.world_from_file, settings.keys);
  baked.report = Json::parse(report_json(file.string(), baked.character, settings, in_memory, diagnostics));
  return baked;
}

std::filesystem::path mannequin() { return std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb"; }

/// As a program would that has the clip and the report, and knows nothing of this one: the segments'
/// orientations in every frame, R_world_node * conjugate(segment_from_node). Returns the largest error,
/// degrees.
double rebuild_error_deg(const Baked& baked) {
  double largest = 0.0;
  long compared = 0;
  const Quat world_from_file = baked.outcome.prepared.humanoid.world_from_file.rotation;
  for (std::size_t f = 0; f < baked.outcome.timeline.clip.frames.size(); ++f) {
    const auto file_from_node =
        world_transforms(baked.character.skeleton, baked.outcome.timeline.clip.frames[f]);
    for (const auto& [segment, frame] : baked.report["humanoid"]["frames"].items()) {
      if (frame.is_null()) continue;
      const int node = baked.character.skeleton.find(frame["node"].get<std::string>());
      const auto q = frame["segment_from_node"].get<std::vector<double>>();
      const Quat segment_from_node(q[3], q[0], q[1], q[2]);
      const Quat rebuilt =
          world_from_file * rotation_part(file_from_node[node].linear()) * segment_from_node.conjugate();
      const Quat& simulated =
          baked.outcome.timeline.trajectory.frames[f][index(*segment_named(segment))].rotation;
      largest = std::max(largest, degrees(angle_between(rebuilt, simulated)));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  return largest;
}

TEST(Bake, ReportAndClipAloneGiveEverySegmentsOrientation) {
  BakeSettings settings;
  settings.hit = Segment::head;
  settings.from = *parse_direction("left");
  EXPECT_LT(rebuild_error_deg(bake_of(mannequin(), settings)), 0.01);
}

TEST(Bake, ReportTellsSettingsAsTheCommandLineHasThem) {
  BakeSettings settings;
  settings.simulation.duration_s = 0.2;
  settings.keys.tolerance_m = 0.002;
  settings.simulation.fps = 50.0;
  settings.lead_s = 0.1;
  settings.strength = 1.5;
  const Json report = bake_of(mannequin(), settings).report;
  EXPECT_DOUBLE_EQ(report["settings"]["key_error_mm"], 2.0);
  EXPECT_DOUBLE_EQ(report["settings"]["fps"], 50.0);
  EXPECT_DOUBLE_EQ(report["settings"]["lead_s"], 0.1);
  EXPECT_DOUBLE_EQ(report["impact"]["time_s"], 0.1);
  EXPECT_EQ(report["clip"]["frames"], 16);
}

TEST(Bake, ReportAndClipGiveTheSegmentsOfOtherPeoplesCharacters) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  for (const char* file :
       {"characters/quaternius_glb/modular_men/Casual.glb", "characters/quaternius_glb/RobotExpressive.glb",
        "characters/ozz_pab_fbx/arnaud.fbx", "mocap/cmu_bvh/cmu_12_01_walk.bvh"})
    EXPECT_LT(rebuild_error_deg(bake_of(*data / file, {})), 0.01) << file;
}

TEST(Bake, FirstFrameIsTheStartPoseExactly) {
  const Baked baked = bake_of(mannequin(), {});
  const Pose& first = baked.outcome.timeline.clip.frames.front();
  ASSERT_EQ(first.size(), baked.outcome.prepared.start.pose.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].rotation.coeffs(), baked.outcome.prepared.start.pose[i].rotation.coeffs());
    EXPECT_EQ(first[i].translation, baked.outcome.prepared.start.pose[i].translation);
  }
}

TEST(Bake, WidensTheRangeOfAJointThatStartsOutside) {
  BakeSettings settings;
  settings.simulation.duration_s = 0.2;
  Diagnostics diagnostics;
  auto character = load_character(mannequin(), {}, diagnostics);
  ASSERT_TRUE(character);
  // A clip that holds one elbow bent backwards by 40 degrees.
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  Pose pose = start_pose(*character, *humanoid, StartPose::stand);
  const BodyPose from = canonical_segments_of(character->skeleton, *humanoid, pose);
  BodyPose to = from;
  const Rigid& forearm = from[index(Segment::forearm_l)];
  const Quat backwards =
      forearm.rotation * exp_rotation(Vec3(0, 0, radians(-40))) * forearm.rotation.conjugate();
  for (const Segment segment : {Segment::forearm_l, Segment::hand_l})
    to[index(segment)].rotation = backwards * from[index(segment)].rotation;
  pose = pose_skeleton(character->skeleton, *humanoid, pose, from, to);
  Animation held{"held", 0.0, 1.0, 0.0, {}};
  for (int i = 0; i < character->skeleton.size(); ++i) {
    const Quat& q = pose[i].rotation;
    const Vec3& t = pose[i].translation;
    held.tracks.push_back(
        {i, TrackPath::rotation, Interpolation::linear, {0.0}, {q.x(), q.y(), q.z(), q.w()}});
    held.tracks.push_back({i, TrackPath::translation, Interpolation::linear, {0.0}, {t.x(), t.y(), t.z()}});
  }
  character->animations.push_back(held);
  settings.clip = "held";
  const auto outcome = bake(*character, settings, diagnostics);
  ASSERT_TRUE(outcome) << outcome.error().message();
  double widened_deg = 0.0;
  for (const auto& [joint, angle] : outcome->prepared.widened)
    if (joint == Joint::elbow_l) widened_deg = degrees(angle);
  EXPECT_GT(widened_deg, 10.0);
  EXPECT_EQ(outcome->limits.over_1deg, 0) << "judged against the widened range";
  bool said = false;
  for (const Warning& warning : diagnostics.warnings()) said = said || warning.subject == "elbow_l";
  EXPECT_TRUE(said);
}

TEST(Bake, DoesNotDependOnTheFramesItIsTold) {
  BakeSettings settings;
  settings.until_rest = false;
  settings.simulation.duration_s = 1.0;
  settings.simulation.fps = 30.0;
  const Baked slow = bake_of(mannequin(), settings);
  settings.simulation.fps = 120.0;
  const Baked fast = bake_of(mannequin(), settings);
  EXPECT_EQ(slow.outcome.figures.hash, fast.outcome.figures.hash);
}

}  // namespace
}  // namespace ukemi
