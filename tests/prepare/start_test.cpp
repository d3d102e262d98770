#include "prepare/start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "bake/bake.h"
#include "bake/report.h"
#include "clip/names.h"
#include "clip/start.h"
#include "judge/jerk.h"
#include "load/load.h"

namespace ukemi {
namespace {

Character with_clips(const std::vector<std::string>& names, SourceFormat format = SourceFormat::gltf) {
  Character character;
  character.path = "hero.glb";
  character.format = format;
  for (const std::string& name : names) character.animations.push_back({name, 0.0, 1.0, 0.0, {}});
  return character;
}

TEST(Start, AFileOfMotionAloneStartsFromItsClip) {
  EXPECT_TRUE(is_motion_only(with_clips({"walk"}, SourceFormat::bvh)));
  EXPECT_FALSE(is_motion_only(with_clips({}, SourceFormat::bvh)));
  EXPECT_TRUE(is_motion_only(with_clips({"walk"}, SourceFormat::assimp)));
  EXPECT_FALSE(is_motion_only(with_clips({"walk", "run"}, SourceFormat::assimp)));
  Character skinned = with_clips({"walk"});
  skinned.skins.emplace_back();
  EXPECT_FALSE(is_motion_only(skinned));
}

TEST(Start, ClipsAreFoundByNameThenByIndex) {
  const Character character = with_clips({"walk", "", "walk"});
  EXPECT_EQ(*find_clip(character, "walk"), 0u);
  EXPECT_EQ(*find_clip(character, "#1"), 1u);
  EXPECT_EQ(*find_clip(character, "#2"), 2u);
  EXPECT_EQ(find_clip(character, "wlak").error().fix, "did you mean 'walk'?");
  EXPECT_FALSE(find_clip(character, "#3"));
  EXPECT_FALSE(find_clip(with_clips({}), "walk"));
}

TEST(Start, MovingAFigureMovesItsRootsInTheFilesUnitsAndAxes) {
  Skeleton skeleton;
  skeleton.nodes = {{"a", -1, {}}, {"b", 0, {}}, {"c", -1, {}}};
  ASSERT_TRUE(skeleton.sort());
  Humanoid humanoid;
  humanoid.world_from_file.scale = 0.01;                                     // centimetres
  humanoid.world_from_file.rotation = exp_rotation(Vec3(-0.5 * kPi, 0, 0));  // z up
  const Pose pose = moved(skeleton, humanoid, rest_pose(skeleton), Vec3(0, 0.5, 0));
  EXPECT_LT((pose[0].translation - Vec3(0, 0, 50)).norm(), 1e-12);
  EXPECT_EQ(pose[1].translation.norm(), 0.0);
  EXPECT_LT((pose[2].translation - Vec3(0, 0, 50)).norm(), 1e-12);
}

/// The mannequin's walk, as motion alone.
struct Walk {
  Character character;
  Humanoid humanoid;
  Diagnostics diagnostics;
  BakeSettings settings;

  Walk() {
    auto loaded =
        load_character(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh", {}, diagnostics);
    EXPECT_TRUE(loaded);
    character = std::move(*loaded);
    humanoid = *map_humanoid(character, {}, diagnostics);
  }
  Track& root_track() {
    for (Track& track : character.animations[0].tracks)
      if (track.path == TrackPath::translation && track.node == 0) return track;
    throw std::runtime_error("no root track");
  }
  Start start(double at_s) {
    settings.at_s = at_s;
    auto result = start_of(character, humanoid, settings, diagnostics);
    EXPECT_TRUE(result);
    return *result;
  }
};

TEST(Start, FromAClipTakesItsVelocities) {
  Walk walk;
  const Start start = walk.start(0.5);
  const Vec3 pelvis = start.state.linear_velocity[index(Segment::pelvis)];
  EXPECT_GT(pelvis.z(), 0.8) << "the mannequin walks towards +z";
  EXPECT_LT(pelvis.norm(), 2.0);
  double fastest = 0.0;
  for (const Vec3& turn : start.state.angular_velocity) fastest = std::max(fastest, turn.norm());
  EXPECT_GT(fastest, 1.0) << "legs swing";
  EXPECT_TRUE(walk.diagnostics.warnings().empty());
}

TEST(Start, AtAJumpOfTheClipIsAtRestAndSaysSo) {
  Walk walk;
  walk.root_track().values[0] += 1000.0;  // frame 0 stands 10 m away
  const Start start = walk.start(0.0);
  for (int i = 0; i < kSegmentCount; ++i) {
    EXPECT_EQ(start.state.linear_velocity[i].norm(), 0.0);
    EXPECT_EQ(start.state.angular_velocity[i].norm(), 0.0);
  }
  ASSERT_EQ(walk.diagnostics.warnings().size(), 1u);
  EXPECT_NE(walk.diagnostics.warnings()[0].what.find("jumps at 0.000 s"), std::string::npos);
}

TEST(Start, BesideAJumpTakesTheVelocityOfTheOtherSide) {
  Walk walk;
  const double frame_s = walk.root_track().times[1];
  const Start smooth = walk.start(frame_s);
  walk.root_track().values[0] += 1000.0;
  const Start start = walk.start(frame_s);
  EXPECT_TRUE(walk.diagnostics.warnings().empty());
  constexpr int pelvis = index(Segment::pelvis);
  EXPECT_LT((start.state.linear_velocity[pelvis] - smooth.state.linear_velocity[pelvis]).norm(), 0.2);
}

TEST(Start, TheFloorOfAClipIsNotThatOfACalibrationFrame) {
  Walk walk;
  const double floor_m = walk.start(0.5).floor_m;
  EXPECT_NEAR(floor_m, 0.0, 0.02);
  walk.root_track().values[1] -= 100.0;  // frame 0 lies 1 m deeper
  EXPECT_NEAR(walk.start(0.5).floor_m, floor_m, 0.005);
  EXPECT_NEAR(walk.start(0.0).floor_m, floor_m - 1.0, 0.05) << "but it carries a body that starts there";
}

TEST(Start, SegmentsOfTheSimulationStandAboveItsFloor) {
  Walk walk;
  for (double& value : walk.root_track().values) value += 50.0;  // everything half a metre up, and aside
  const Start start = walk.start(0.5);
  EXPECT_NEAR(start.floor_m, 0.5, 0.02);
  for (int i = 0; i < kSegmentCount; ++i)
    EXPECT_NEAR(start.state.segments[i].translation.y(), start.segments[i].translation.y() - start.floor_m,
                1e-12);
}

TEST(Start, TheFloorIsThatOfTheStrideWhereACapturedFloorDrifts) {
  Walk walk;
  Track& root = walk.root_track();
  const double early = walk.start(0.1).floor_m;
  const double late = walk.start(0.95).floor_m;
  for (std::size_t i = 0; i < root.times.size(); ++i) root.values[3 * i + 1] += 4.0 * root.times[i];
  const double rise = walk.start(0.95).floor_m - late - (walk.start(0.1).floor_m - early);
  EXPECT_GT(rise, 0.008) << "4 cm a second";
  EXPECT_LT(rise, 0.04);
}

/// Takes what the hips travel out of the walk; returns how fast they went, m/s.
double put_on_the_spot(Walk& walk) {
  Track& root = walk.root_track();
  const std::size_t last = root.times.size() - 1;
  const double way = root.values[3 * last + 2] - root.values[2];
  const double speed = way / (root.times[last] - root.times[0]);
  for (std::size_t i = 0; i <= last; ++i) root.values[3 * i + 2] -= speed * (root.times[i] - root.times[0]);
  return 0.01 * speed;
}

double pelvis_speed(const Start& start) { return start.state.linear_velocity[index(Segment::pelvis)].z(); }

TEST(Start, AWalkOnTheSpotGoesAsFastAsItsFeetSlideBack) {
  Walk walk;
  const double as_it_was = pelvis_speed(walk.start(0.5));
  EXPECT_TRUE(walk.diagnostics.warnings().empty());
  const double speed = put_on_the_spot(walk);
  ASSERT_GT(speed, 0.8);
  EXPECT_NEAR(pelvis_speed(walk.start(0.5)), as_it_was, 0.1 * speed);
  ASSERT_EQ(walk.diagnostics.warnings().size(), 1u);
  EXPECT_NE(walk.diagnostics.warnings()[0].what.find("--ground-speed"), std::string::npos);
}

TEST(Start, TheSpeedOfAWalkOnTheSpotIsAsSaid) {
  Walk walk;
  const double speed = put_on_the_spot(walk);
  walk.settings.ground_speed_m_s = 0.0;
  const double on_the_spot = pelvis_speed(walk.start(0.5));
  EXPECT_LT(std::abs(on_the_spot), 0.3 * speed);
  walk.settings.ground_speed_m_s = 2.0;
  EXPECT_NEAR(pelvis_speed(walk.start(0.5)) - on_the_spot, 2.0, 0.02);
  EXPECT_TRUE(walk.diagnostics.warnings().empty()) << "nothing was guessed";
}

TEST(Start, TheSpeedOfAWalkThatGoesItselfIsNotChangedWithoutAWord) {
  Walk walk;
  const double speed = pelvis_speed(walk.start(0.5));
  walk.settings.ground_speed_m_s = 2.0;
  EXPECT_EQ(pelvis_speed(walk.start(0.5)), speed);
  EXPECT_EQ(walk.diagnostics.warnings().size(), 1u);
}

TEST(Report, NamesAReactionByTargetAndDirection) {
  BakeSettings settings;
  settings.hit = Segment::head;
  settings.from = *parse_direction("left");
  EXPECT_EQ(reaction_name(settings), "head_left");
  settings.from = *parse_direction("30,-10");
  EXPECT_EQ(reaction_name(settings), "head_30_-10");
}

// An angle of c t^3 / 6 has the jerk c.
TEST(Report, JerkOfACubicAngleIsItsConstant) {
  Clip clip{"a", 60.0, {}, {}};
  constexpr double c = 2.0;
  for (int i = 0; i < 10; ++i) {
    const double t = i / clip.fps;
    LocalTransform local;
    local.rotation = exp_rotation(Vec3(0, c * t * t * t / 6.0, 0));
    clip.frames.push_back({local});
  }
  EXPECT_NEAR(largest_jerk(clip).deg_s3, degrees(c), 1e-6);
  clip.frames[7][0].rotation = exp_rotation(Vec3(0.1, 0, 0)) * clip.frames[7][0].rotation;
  EXPECT_EQ(largest_jerk(clip).node, 0);
  EXPECT_NEAR(largest_jerk(clip).time_s, 7 / clip.fps, 1 / clip.fps);
  clip.frames.resize(3);
  EXPECT_EQ(largest_jerk(clip).deg_s3, 0.0);
  EXPECT_EQ(largest_jerk(clip).node, -1);
}

TEST(Report, WordsForTheMethodAreThoseOfTheCommandLine) {
  EXPECT_EQ(name(Limits::edges), "edges");
  EXPECT_EQ(name(Active::explicit_torque), "explicit");
  EXPECT_EQ(rate_name(0.0), "adaptive");
  EXPECT_EQ(rate_name(480.0), "fixed:480");
}

}  // namespace
}  // namespace ukemi
