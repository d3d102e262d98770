#include "prepare/needs.h"

#include <gtest/gtest.h>

#include "prepare/setting_table.h"

namespace ukemi {
namespace {

using Said = std::vector<std::string>;

Said said_of(const std::vector<std::pair<std::string, std::string>>& values,
             SceneKind scene = SceneKind::ball) {
  BakeSettings settings;
  for (const auto& [name, value] : values) {
    const auto setting = find_setting(name);
    EXPECT_TRUE(setting) << name;
    EXPECT_TRUE((*setting)->set(settings, value)) << name;
  }
  return idle_settings(settings, scene);
}

TEST(Needs, ASettingWithoutWhatItNeedsIsNamed) {
  EXPECT_EQ(said_of({{"to", "clip"}}), Said{"--return-to has no effect without --return"});
  EXPECT_EQ(said_of({{"fall-height", "1"}}), Said{"--fall-height has no effect without --scene fall"});
  EXPECT_EQ(said_of({{"hit", "head"}}, SceneKind::fall),
            Said{"--hit has no effect without a scene that hits"});
  EXPECT_EQ(said_of({{"tone", "1"}}), Said{"--stiffness has no effect without --behaviour limp"});
  EXPECT_EQ(said_of({{"steps", "2"}, {"behaviour", "limp"}}),
            Said{"--steps has no effect without a body that is alive (--behaviour)"});
  EXPECT_EQ(said_of({{"to", "stance"}, {"behaviour", "limp"}}).size(), 1u);
  EXPECT_EQ(said_of({{"tone-fade", "1"}, {"tone", "0"}, {"behaviour", "limp"}}),
            Said{"--stiffness-fade has no effect without --stiffness above 0"});
  EXPECT_EQ(said_of({{"tone-fade", "1"}, {"rate", "fixed:240"}}).size(), 1u) << "stiffness 0 by default";
  EXPECT_EQ(said_of({{"aim-up", "0.1"}}, SceneKind::slope).size(), 1u) << "a rolling ball is not aimed";
  for (const auto& [name, value] : {std::pair("muscle", "2"), {"breath", "false"}, {"seed", "3"}}) {
    EXPECT_EQ(said_of({{name, value}, {"behaviour", "limp"}}),
              Said{"--" + std::string(name == std::string("muscle") ? "muscle-strength" : name) +
                   " has no effect without a body that is alive (--behaviour) or gets up"});
    EXPECT_EQ(said_of({{name, value}}), Said{});
    EXPECT_EQ(said_of({{name, value}, {"behaviour", "limp"}, {"get-up", "1"}}), Said{});
  }
}

TEST(Needs, ASettingWithWhatItNeedsIsNot) {
  EXPECT_EQ(said_of({}), Said{});
  EXPECT_EQ(said_of({{"to", "clip"}, {"recover", "1"}}), Said{});
  EXPECT_EQ(said_of({{"to", "clip"}, {"clip", "walk"}}), Said{}) << "who walks goes on";
  EXPECT_EQ(said_of({{"fall-height", "1"}}, SceneKind::fall), Said{});
  EXPECT_EQ(said_of({{"tone", "1"}, {"behaviour", "limp"}}), Said{});
  EXPECT_EQ(said_of({{"slope-deg", "30"}, {"ball-radius", "0.1"}}, SceneKind::slope), Said{});
  EXPECT_EQ(said_of({{"to", "stance"}}), Said{});
  EXPECT_EQ(said_of({{"tone-fade", "1"}, {"behaviour", "limp"}}), Said{});
}

TEST(Needs, OfFilesAreThoseOfTheirFormats) {
  BakeSettings settings;
  settings.clip_only = true;
  settings.bvh_metres_per_unit = 1.0;
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), Said{}) << "in memory";
  settings.outputs = {"a.bvh"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball),
            Said{"--clip-only has no effect without a glTF or FBX to write"});
  settings.outputs = {"a.glb"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball),
            Said{"--bvh-unit has no effect without a BVH to write"});
  settings.ground.root_motion = RootMotion::root;
  EXPECT_EQ(idle_settings(settings, SceneKind::ball).size(), 1u);
  settings.outputs = {"a.bvh"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball).back(),
            "--root-motion has no effect without a glTF or FBX to write: a BVH has it on the hips");
  settings.ground.root_motion = RootMotion::in_place;
  EXPECT_EQ(idle_settings(settings, SceneKind::ball).size(), 1u) << "of a BVH too";
  settings.all_joints = true;
  settings.outputs = {"a.fbx"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball).front(),
            "--all-joints has no effect without a glTF to write");
  settings.outputs = {"a.glb", "a.bvh"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), Said{});
}

TEST(Needs, OfClipsAreNoneWhereOnlyPicturesAreDrawn) {
  BakeSettings settings;
  settings.ground.align = true;
  settings.additive = Additive::rest;
  settings.report = "a.json";
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), Said{}) << "the report has figures of the clip";
  settings.sheet = "a.png";
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), (Said{"--align has no effect without a clip to write",
                                                            "--additive has no effect without a glTF to "
                                                            "write"}));
  settings.outputs = {"A.GLB"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), Said{});
}

TEST(Needs, ColoursArePicturesOwn) {
  BakeSettings settings;
  settings.theme = ThemeKind::dark;
  settings.outputs = {"a.glb"};
  EXPECT_EQ(idle_settings(settings, SceneKind::ball),
            Said{"--theme has no effect without a picture (--sheet, --preview)"});
  settings.preview = "a.webp";
  EXPECT_EQ(idle_settings(settings, SceneKind::ball), Said{});
}

TEST(Needs, OfACharacterAreWhatItHas) {
  BakeSettings settings;
  settings.bvh_metres_per_unit = 1.0;
  settings.extra_bones_play = true;
  settings.all_joints = true;
  settings.clip = "walk";
  Character character;
  character.skins.emplace_back();
  character.animations.push_back({"walk", 0.0, 1.0, 30.0, {}});
  EXPECT_EQ(idle_settings(settings, character), Said{});
  character.bvh.emplace();
  character.skins.clear();
  settings.clip = "other.bvh";
  EXPECT_EQ(idle_settings(settings, character).size(), 3u);
}

}  // namespace
}  // namespace ukemi
