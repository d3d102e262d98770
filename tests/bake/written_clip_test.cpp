// What a bake writes, read back: its poses, and its joints in the range that it carries.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "bake/bake.h"
#include "bake/response.h"
#include "check/difference.h"
#include "clip/frames.h"
#include "judge/rom_figures.h"
#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

struct Written {
  BakedFile baked;
  Character file;  // the first output
};

Character character_of(const std::string& path) {
  Diagnostics diagnostics;
  auto character = load_character(path, {}, diagnostics);
  if (!character) throw std::runtime_error(character.error().message());
  return std::move(*character);
}
Character mannequin() { return character_of(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb"); }
Character public_fault(const std::string& name) {
  return character_of(std::string(UKEMI_TEST_DATA) + "/public_faults/" + name);
}

/// Baked and read back, as `output`.
Written written(const Character& character, BakeSettings settings, const std::string& output,
                Diagnostics& diagnostics) {
  settings.outputs = {output};
  auto baked = bake_loaded(character, settings, diagnostics);
  if (!baked) throw std::runtime_error(baked.error().message());
  const std::vector<std::uint8_t>& bytes = baked->files.front().bytes;
  Diagnostics said;
  auto file = output.ends_with(".bvh")
                  ? read_bvh({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, output, said)
                  : read_gltf(bytes, output, said);
  if (!file) throw std::runtime_error(file.error().message());
  return {std::move(*baked), std::move(*file)};
}

double largest_distance_m(const Written& a, const Written& b) {
  const Skeleton& skeleton = a.file.skeleton;
  double largest = 0.0;
  const Animation &in_a = a.file.animations.back(), &in_b = b.file.animations.back();
  for (double t = 0.0; t <= in_a.duration_s(); t += 0.05) {
    const auto at_a = world_transforms(skeleton, sample(skeleton, in_a, t));
    const auto at_b = world_transforms(skeleton, sample(skeleton, in_b, t));
    for (std::size_t i = 0; i < at_a.size(); ++i)
      largest = std::max(largest, (at_a[i].translation() - at_b[i].translation()).norm());
  }
  return largest;
}

TEST(WrittenClip, AnAdditiveOneIsReadAsThePosesThatItMakes) {
  for (const Character& character : {public_fault("turned_thighs.gltf"), mannequin()}) {
    BakeSettings settings;
    settings.simulation.duration_s = 0.5;
    Diagnostics diagnostics;
    const Written plain = written(character, settings, "plain.glb", diagnostics);
    settings.additive = Additive::rest;
    EXPECT_LT(largest_distance_m(plain, written(character, settings, "rest.glb", diagnostics)), 1e-4);
    settings.additive = Additive::identity;
    const Written additive = written(character, settings, "additive.glb", diagnostics);
    EXPECT_LT(largest_distance_m(plain, additive), 1e-4);
    const auto humanoid = map_humanoid(additive.file, {}, diagnostics);
    ASSERT_TRUE(humanoid);
    const auto range = load_range_of_motion("human");
    const RomPaths paths =
        rom_paths(ClipToCheck{&additive.file, additive.file.animations.size() - 1, {}}, *humanoid, *range);
    EXPECT_EQ(paths.rolls, Rolls::stored);
    EXPECT_LT(rom_figures(paths).excess_max_deg, 1.0);
  }
}

TEST(WrittenClip, EveryJointOfTheSkinHasKeysAtBothEndsOnRequest) {
  BakeSettings settings;
  settings.simulation.duration_s = 0.5;
  Diagnostics diagnostics;
  const auto keyed = [&](const Written& w) {
    std::set<int> nodes;
    for (const Track& track : w.file.animations.back().tracks)
      if (track.path == TrackPath::rotation && track.times.size() > 1) nodes.insert(track.node);
    return nodes;
  };
  const Character man = mannequin();
  const Written few = written(man, settings, "few.glb", diagnostics);
  settings.all_joints = true;
  const Written all = written(man, settings, "all.glb", diagnostics);
  EXPECT_LT(keyed(few).size(), man.skins.at(0).joints.size());
  for (const int joint : man.skins.at(0).joints) EXPECT_TRUE(keyed(all).contains(joint)) << joint;
  EXPECT_LT(largest_distance_m(few, all), 1e-6);
}

/// Largest excess of the file's last clip, degrees, as `rom --check` has it.
double checked_excess_deg(const Written& w) {
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(w.file, {}, diagnostics);
  EXPECT_TRUE(humanoid);
  const auto range = load_range_of_motion("human");
  return rom_figures(rom_paths(ClipToCheck{&w.file, w.file.animations.size() - 1, {}}, *humanoid, *range))
      .excess_max_deg;
}

TEST(WrittenClip, KeysKeepEveryJointWithinATwentiethOfADegree) {
  for (const char* segment : {"hand_l", "head", "chest"})
    for (const double key_error_m : {0.0005, 0.005}) {
      BakeSettings settings;
      settings.hit = *segment_named(segment);
      settings.strength = 2.0;
      settings.keys.tolerance_m = key_error_m;
      settings.simulation.duration_s = 2.0;
      Diagnostics diagnostics;
      const Written w = written(mannequin(), settings, "hit.glb", diagnostics);
      EXPECT_LT(w.baked.written.excess_max_deg, 0.051) << segment;
      EXPECT_LT(checked_excess_deg(w), 0.06) << segment;
      EXPECT_EQ(w.baked.written.over_1deg, 0);
      EXPECT_GT(w.baked.written.samples, 1000);
      EXPECT_LT(w.baked.reduced.error_m, key_error_m + 1e-9);
    }
}

TEST(WrittenClip, AStartOutsideTheRangeIsSaidAndJudgedByTheRangeInForce) {
  Character character = mannequin();
  // A pose with an elbow bent the wrong way by 40 degrees, as the file's only clip.
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  const Pose stand = start_pose(character, *humanoid, StartPose::stand);
  const BodyPose from = segments_of(character.skeleton, *humanoid, stand);
  BodyPose to = from;
  const Segment fore = Segment::forearm_l, hand = Segment::hand_l;
  const Rigid elbow{from[index(fore)].rotation * exp_rotation(Vec3(0, 0, radians(-40))) *
                        from[index(fore)].rotation.conjugate(),
                    Vec3::Zero()};
  for (const Segment s : {fore, hand}) to[index(s)].rotation = elbow.rotation * from[index(s)].rotation;
  const Pose bent = pose_skeleton(character.skeleton, *humanoid, stand, from, to);
  Animation animation{"bent", 0.0, 1.0, 30.0, {}};
  for (int i = 0; i < character.skeleton.size(); ++i) {
    const Quat& q = bent[i].rotation;
    const Vec3& t = bent[i].translation;
    animation.tracks.push_back({i,
                                TrackPath::rotation,
                                Interpolation::linear,
                                {0.0, 1.0},
                                {q.x(), q.y(), q.z(), q.w(), q.x(), q.y(), q.z(), q.w()}});
    animation.tracks.push_back({i,
                                TrackPath::translation,
                                Interpolation::linear,
                                {0.0, 1.0},
                                {t.x(), t.y(), t.z(), t.x(), t.y(), t.z()}});
  }
  character.animations = {animation};
  BakeSettings settings;
  settings.clip = "bent";
  settings.simulation.duration_s = 0.5;
  Diagnostics said;
  const Written w = written(character, settings, "hit.glb", said);
  ASSERT_FALSE(w.baked.outcome.prepared.widened.empty());
  ASSERT_FALSE(said.warnings().empty());
  EXPECT_NE(said.warnings()[0].what.find("widened"), std::string::npos);
  EXPECT_EQ(w.baked.outcome.limits.over_1deg, 0);
  EXPECT_GT(w.baked.outcome.human.excess_max_deg, 5.0);
  EXPECT_GT(w.baked.outcome.human.over_1deg, 0);
  EXPECT_LT(w.baked.written.excess_max_deg, 1.0);
  EXPECT_LT(checked_excess_deg(w), 1.0) << "by the range that the clip carries";
}

TEST(WrittenClip, TheBvhOfAMirroredOrSmallFigureIsItsGlb) {
  for (const char* name : {"mirrored.gltf", "small.gltf", "mesh_named_chest.gltf", "figure.gltf"}) {
    const Character character = public_fault(name);
    BakeSettings settings;
    settings.simulation.duration_s = 0.6;
    settings.keys.enabled = false;
    Diagnostics diagnostics;
    const Written glb = written(character, settings, "hit.glb", diagnostics);
    const Written bvh = written(character, settings, "hit.bvh", diagnostics);
    const auto of_glb = map_humanoid(glb.file, {}, diagnostics),
               of_bvh = map_humanoid(bvh.file, {}, diagnostics);
    ASSERT_TRUE(of_glb && of_bvh) << name;
    EXPECT_EQ(bvh.file.skeleton.find(std::string(name) == "mesh_named_chest.gltf" ? "Chest" : "Hips") >= 0,
              true);
    const Animation &a = glb.file.animations.back(), &b = bvh.file.animations.back();
    double largest = 0.0;
    for (double t = 0.0; t <= b.duration_s(); t += 1.0 / 60.0) {
      const auto at_a = world_transforms(glb.file.skeleton, sample(glb.file.skeleton, a, t));
      const auto at_b = world_transforms(bvh.file.skeleton, sample(bvh.file.skeleton, b, t));
      for (const SegmentNodes& segment : of_glb->segments) {
        const int node = segment.node();
        const int other = node < 0 ? -1 : bvh.file.skeleton.find(glb.file.skeleton.nodes[node].name);
        if (other < 0) continue;
        largest = std::max(largest, (of_glb->world_from_file * Vec3(at_a[node].translation()) -
                                     of_bvh->world_from_file * Vec3(at_b[other].translation()))
                                        .norm());
      }
    }
    EXPECT_LT(largest, 0.0005) << name;
  }
}

/// The mannequin's BVH with a root of six channels above hips that only turn, as iClone has it.
Character with_root_above_hips() {
  std::ifstream file(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh");
  std::string text, line;
  bool in_motion = false;
  while (std::getline(file, line)) {
    if (line.starts_with("ROOT "))
      line =
          "ROOT Base\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
          "Xrotation\n"
          "JOINT " +
          line.substr(5);
    if (const auto six = line.find("CHANNELS 6 Xposition Yposition Zposition"); six == 1)
      line = "CHANNELS 3" + line.substr(41);
    if (line == "MOTION") line = "}\nMOTION";
    if (in_motion) line.insert(line.find(' ', line.find(' ', line.find(' ') + 1) + 1), " 0 0 0");
    in_motion = in_motion || line.starts_with("Frame Time");
    text += line + "\n";
  }
  Diagnostics diagnostics;
  auto character = read_bvh(text, "hips_below_root.bvh", diagnostics);
  if (!character) throw std::runtime_error(character.error().message());
  return std::move(*character);
}

TEST(WrittenClip, HipsThatOnlyTurnMoveTheirRootInEveryFormat) {
  const Character character = with_root_above_hips();
  ASSERT_EQ(character.bvh->channels[1].size(), 3u);
  BakeSettings settings;
  settings.simulation.duration_s = 1.0;
  settings.preset = "tackle";
  settings.keys.enabled = false;
  Diagnostics diagnostics;
  const Written glb = written(character, settings, "hit.glb", diagnostics);
  const Written bvh = written(character, settings, "hit.bvh", diagnostics);
  const auto difference = difference_of(
      {&glb.file, &glb.file.animations.back(), map_humanoid(glb.file, {}, diagnostics)->world_from_file},
      {&bvh.file, &bvh.file.animations.back(), map_humanoid(bvh.file, {}, diagnostics)->world_from_file}, {});
  ASSERT_TRUE(difference);
  EXPECT_TRUE(difference->only_in_b.empty());
  EXPECT_GT(difference->joints.size(), 15u);
  for (const JointDifference& joint : difference->joints) EXPECT_LT(joint.position_mm, 0.5) << joint.joint;
}

TEST(WrittenClip, OneFigureOfTwoMovesAsItDoesAlone) {
  BakeSettings settings;
  settings.simulation.duration_s = 1.0;
  Diagnostics alone_said, said;
  const Written alone = written(public_fault("figure.gltf"), settings, "hit.glb", alone_said);
  const Written of_two = written(public_fault("two_figures.gltf"), settings, "hit.glb", said);
  EXPECT_EQ(alone.baked.outcome.figures.hash, of_two.baked.outcome.figures.hash);
  EXPECT_FALSE(said.warnings().empty());
}

/// Largest excess of the written clip over its range, degrees, as `rom --check` tells it.
double written_excess_deg(const Written& written) {
  Diagnostics said;
  const auto humanoid = map_humanoid(written.file, {}, said);
  if (!humanoid) throw std::runtime_error(humanoid.error().message());
  const ClipToCheck clip{&written.file, written.file.animations.size() - 1, {}};
  return rom_figures(rom_paths(clip, *humanoid, *load_range_of_motion("human"))).excess_max_deg;
}

TEST(WrittenClip, ABvhCarriesTheRangeAndTheSidesOfItsBake) {
  Diagnostics said;
  BakeSettings settings;
  settings.simulation.duration_s = 1.0;
  const Character mirrored = public_fault("mirrored.gltf");
  const Written bvh = written(mirrored, settings, "a.bvh", said),
                glb = written(mirrored, settings, "a.glb", said);
  EXPECT_LT(written_excess_deg(bvh), 0.1);
  EXPECT_LT(written_excess_deg(glb), 0.1);
  const auto sides = map_humanoid(bvh.file, {}, said);
  ASSERT_TRUE(sides);
  for (const Segment s : {Segment::hand_l, Segment::foot_l, Segment::hand_r, Segment::foot_r})
    EXPECT_EQ(bvh.file.skeleton.label(sides->segments[index(s)].node()),
              mirrored.skeleton.label(bvh.baked.outcome.prepared.humanoid.segments[index(s)].node()))
        << name(s);
  EXPECT_EQ(sides->segments[index(Segment::hand_l)].by, "bake");
  const auto marks = marks_in_extras(bvh.file.animations.back().extras_json);
  EXPECT_EQ(marks.size(), bvh.baked.outcome.timeline.clip.marks.size());
  EXPECT_GE(marks.size(), 2u);
}

/// What a report says of the floor, taken from the written clip at 240 Hz.
struct OnFloor {
  double depth_m = 0.0, end_m = 0.0;  // of the skin
  double slide_m = 0.0;               // of a foot
};

/// Node of the file for each of the character's, by name; nothing where one is missing or has a namesake.
std::optional<std::vector<int>> nodes_in_file(const Character& character, const Character& file) {
  std::map<std::string, int> count;
  for (const Node& node : character.skeleton.nodes) ++count[node.name];
  std::vector<int> nodes;
  for (const Node& node : character.skeleton.nodes) {
    nodes.push_back(file.skeleton.find(node.name));
    if (nodes.back() < 0 || count[node.name] > 1) return std::nullopt;
  }
  return nodes;
}

/// Nothing where the file's nodes cannot be told apart.
std::optional<OnFloor> on_floor(const Character& character, const Written& w) {
  constexpr double kRate_hz = 240.0;
  const auto nodes = nodes_in_file(character, w.file);
  if (!nodes) return std::nullopt;
  const Prepared& prepared = w.baked.outcome.prepared;
  const Actor actor = prepared.actor(character);
  const SegmentFrames frames = frames_of(actor);
  const Animation& clip = w.file.animations.back();
  std::vector<Pose> poses;
  Trajectory trajectory;
  trajectory.fps = kRate_hz;
  for (int f = 0; f <= std::lround(clip.duration_s() * kRate_hz); ++f) {
    const Pose in_file = sample(w.file.skeleton, clip, clip.start_s + f / kRate_hz);
    Pose& pose = poses.emplace_back();
    for (const int node : *nodes) pose.push_back(in_file[node]);
    trajectory.frames.push_back(segments_above_floor(actor, frames, poses.back()));
  }
  const SkinOverFloor skin(character, prepared.humanoid, prepared.body, prepared.start.pose,
                           prepared.start.segments);
  const SkinOnFloor read = skin_on_floor(skin, poses);
  const Response response = response_of(w.baked.outcome);
  const double until_s = response.fall_begins_s.value_or(1e9);
  return OnFloor{read.max.body_m, read.end_m,
                 foot_slide(prepared.body, prepared.home, trajectory, response.steps, until_s)};
}

/// Whether the written clip lies on the floor as the report says, and slides so to within `slide_m`; nothing
/// where it cannot be told.
std::optional<bool> is_as_reported(const Character& character, const Written& w, double slide_m) {
  constexpr double kKeys_m = 0.002;  // what keys and the frames between frames may move
  const auto read = on_floor(character, w);
  if (!read) return std::nullopt;
  const BakedClip& baked = w.baked.outcome;
  EXPECT_NEAR(read->depth_m, baked.skin.max.body_m, kKeys_m);
  EXPECT_NEAR(read->end_m, baked.skin.end_m, kKeys_m);
  EXPECT_NEAR(read->slide_m, response_of(baked).foot_slide_max_m, slide_m);
  return true;
}

TEST(WrittenClip, LiesOnTheFloorAndSlidesAsItsReportSays) {
  int told = 0;
  for (const Character& character : {mannequin(), public_fault("figure.gltf")})
    for (const char* preset : {"medicine-ball", "tackle"}) {
      BakeSettings settings;
      settings.preset = preset;
      settings.simulation.duration_s = 2.0;
      Diagnostics said;
      told +=
          is_as_reported(character, written(character, settings, "a.glb", said), 0.005).has_value() ? 1 : 0;
    }
  EXPECT_EQ(told, 4);
}

TEST(WrittenClip, OfEveryCharacterIsWithinItsRangeInBothFormats) {
  const auto folder = extra_data();
  if (!folder) GTEST_SKIP() << kNoExtraData;
  // A foot that hardly touches stands longer or shorter where four times as many frames are looked at.
  constexpr double kOtherStands_m = 0.03;
  int looked_at = 0, on_floor_told = 0;
  for (const ExtraFile& file : extra_files(*folder)) {
    if (file.verdict != "humanoid") continue;
    SCOPED_TRACE(file.file);
    Diagnostics said;
    const auto character = load_character(*folder / file.file, {}, said);
    if (!character || !map_humanoid(*character, {}, said)) continue;  // see tests/humanoid
    BakeSettings settings;
    settings.simulation.duration_s = 1.0;
    for (const char* output : {"a.glb", "a.bvh"}) {
      const Written w = written(*character, settings, output, said);
      EXPECT_LE(written_excess_deg(w), 1.0) << output;
      if (std::string(output) == "a.glb")
        on_floor_told += is_as_reported(*character, w, kOtherStands_m).has_value() ? 1 : 0;
      ++looked_at;
    }
  }
  EXPECT_GE(looked_at, 120);
  EXPECT_GE(on_floor_told, 40);
}

}  // namespace
}  // namespace ukemi
