#include "bake/start.h"

#include <gtest/gtest.h>

#include "bake/bake.h"
#include "bake/report.h"

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

TEST(Report, NamesAReactionByTargetAndDirection) {
  BakeSettings settings;
  settings.hit = "head";
  settings.from = "left";
  EXPECT_EQ(reaction_name(settings), "head_left");
  settings.from = "30,-10";
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
  EXPECT_NEAR(largest_jerk_deg_s3(clip), degrees(c), 1e-6);
  clip.frames.resize(3);
  EXPECT_EQ(largest_jerk_deg_s3(clip), 0.0);
}

TEST(Report, WordsForTheMethodAreThoseOfTheCommandLine) {
  EXPECT_EQ(name(Limits::edges), "edges");
  EXPECT_EQ(name(Active::explicit_torque), "explicit");
  EXPECT_EQ(rate_name(0.0), "adaptive");
  EXPECT_EQ(rate_name(480.0), "fixed:480");
}

}  // namespace
}  // namespace ukemi
