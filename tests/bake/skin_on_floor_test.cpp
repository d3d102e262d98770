// Bodies whose skin stands out of their shapes: on the floor it stays above it, whatever their style.
#include <gtest/gtest.h>

#include "bake/bake.h"
#include "bake/skin_lift.h"
#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

Character character_of(const std::filesystem::path& path) {
  Diagnostics diagnostics;
  auto character = load_character(path, {}, diagnostics);
  if (!character) throw std::runtime_error(character.error().message());
  return std::move(*character);
}

Character figure() { return character_of(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf"); }

/// The vertices that a node moves most.
template <typename Change>
void change_skin_of(Character& character, const std::string& node, Change&& change) {
  int changed = 0;
  for (MeshPart& part : character.parts)
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      if (part.weights[v][0] > 0.5f &&
          character.skins[part.skin].joints[part.joints[v][0]] == character.skeleton.find(node)) {
        change(part.positions[v]);
        ++changed;
      }
  ASSERT_GE(changed, 8) << node;
}

/// A head as wide as the shoulders, a rabbit's ears long.
Character big_head() {
  Character character = figure();
  change_skin_of(character, "Head", [](Eigen::Vector3f& p) {
    const Eigen::Vector3f neck(0.0f, 1.5f, 0.0f);
    p = neck + Eigen::Vector3f(2.6f, 1.6f, 2.6f).cwiseProduct(p - neck);
  });
  return character;
}

BakedClip knocked_down(const Character& character, const std::string& from, Diagnostics& diagnostics) {
  BakeSettings settings;
  settings.preset = "tackle";
  settings.from = *parse_direction(from);
  settings.behaviour = Behaviour::limp;
  auto baked = bake(character, settings, diagnostics);
  EXPECT_TRUE(baked) << baked.error().message();
  return std::move(*baked);
}

void expect_above_the_floor(const std::string& what, const Character& character) {
  for (const char* from : {"front", "back"}) {
    Diagnostics diagnostics;
    const BakedClip baked = knocked_down(character, from, diagnostics);
    EXPECT_TRUE(baked.figures.first_ground_contact_s) << what;
    EXPECT_LT(baked.skin.max.body_m, 0.020) << what << " from " << from;
    EXPECT_LT(baked.skin.end_m, 0.010) << what << " from " << from;
  }
}

TEST(SkinOnFloor, OfPlainAndOfBigHeadedFigures) {
  expect_above_the_floor("figure", figure());
  expect_above_the_floor("big head", big_head());
}

TEST(SkinOnFloor, OfStylisedCharacters) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  for (const char* file :
       {"quaternius_glb/platformer_game_pack/Character.glb", "quaternius_glb/RobotExpressive.glb",
        "quaternius_glb/single_knight_pack/KnightCharacter.glb", "kaykit/manny_med_mod.gltf",
        "quaternius_glb/ultimate_space_pack/Astronaut_BarbaraTheBee-transformed.glb",
        "quaternius_glb/modular_women/Witch.glb", "vrm_addon/Example.vrm", "vrm_addon/sphere.vrm"})
    expect_above_the_floor(file, character_of(*data / "characters" / file));
}

TEST(SkinOnFloor, ShapesThatCoverTheMeshHaveNoPointsOfTheirOwn) {
  const auto points_of = [](const Character& character) {
    BakeSettings settings;
    Diagnostics diagnostics;
    const auto prepared = prepare_bake(character, settings, diagnostics);
    PerSegment<std::size_t> counts{};
    for (int s = 0; prepared && s < kSegmentCount; ++s)
      counts[s] = prepared->body.segments[s].floor_points.size();
    return counts;
  };
  const auto mannequin =
      points_of(character_of(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb"));
  for (const std::size_t count : mannequin) EXPECT_EQ(count, 0u);
  EXPECT_GT(points_of(big_head())[index(Segment::head)], 4u);
}

TEST(SkinOnFloor, WhatABindPoseThrowsFarAwayHoldsNobodyUp) {
  Character character = figure();
  for (Skin& skin : character.skins)
    for (Affine& bind : skin.inverse_bind) bind = bind * Eigen::Translation3d(0.0, -3.0, 0.0);
  Diagnostics diagnostics;
  BakeSettings settings;
  settings.simulation.duration_s = 1.0;
  const auto baked = bake(character, settings, diagnostics);
  ASSERT_TRUE(baked) << baked.error().message();
  EXPECT_FALSE(baked->behaviour.fall_begins_s);
  EXPECT_FALSE(baked->figures.first_ground_contact_s);
  EXPECT_LT(baked->skin.max.body_m, 0.02);
}

/// The figure's bake, its frames but the first so far below where it stands.
struct Lowered {
  Character character = figure();
  Prepared prepared;
  Timeline timeline;
  SkinOverFloor skin;

  explicit Lowered(double down_m, Diagnostics diagnostics = {})
      : prepared(*prepare_bake(character, {}, diagnostics)),
        skin(character, prepared.humanoid, prepared.body, prepared.start.pose, prepared.start.segments) {
    timeline.clip.fps = timeline.trajectory.fps = 60.0;
    for (int f = 0; f < 60; ++f) {
      const Vec3 down(0.0, f == 0 ? 0.0 : -down_m, 0.0);
      timeline.clip.frames.push_back(moved(character.skeleton, prepared.humanoid, prepared.start.pose, down));
      BodyPose segments = prepared.start.state.segments;
      for (Rigid& segment : segments) segment.translation += down;
      timeline.trajectory.frames.push_back(segments);
    }
  }
};

TEST(SkinOnFloor, DepthsAreTheLargestAndTheLast) {
  Lowered figure(0.10);
  const double stand_m = figure.skin.depth(figure.timeline.clip.frames.front()).body_m;
  ASSERT_LT(stand_m, 0.005);
  figure.timeline.clip.frames.push_back(moved(figure.character.skeleton, figure.prepared.humanoid,
                                              figure.prepared.start.pose, Vec3(0.0, -0.03, 0.0)));
  const SkinOnFloor read = skin_on_floor(figure.skin, figure.timeline.clip.frames);
  EXPECT_NEAR(read.max.body_m, 0.10, 0.005);
  EXPECT_NEAR(read.end_m, 0.03, 0.005);
  EXPECT_NEAR(read.max.body_m - read.end_m, 0.07, 1e-6);
}

TEST(SkinOnFloor, BlendedSkinIsLiftedOutOfTheFloorHoweverDeepItLies) {
  Lowered figure(0.15);
  const double depth_m = figure.skin.depth(figure.timeline.clip.frames.back()).body_m;
  const double lifted_m =
      lift_blended_skin(figure.prepared.actor(figure.character), figure.skin, figure.timeline);
  EXPECT_NEAR(lifted_m, depth_m - 0.009, 1e-6);
  EXPECT_NEAR(figure.skin.depth(figure.timeline.clip.frames.back()).body_m, 0.009, 1e-6);
  EXPECT_NEAR(figure.timeline.trajectory.frames.back()[0].translation.y(),
              figure.prepared.start.state.segments[0].translation.y() - 0.15 + lifted_m, 1e-9);
}

/// Trousers that reach the floor beside the feet.
Character wide_trousers() {
  Character character = figure();
  for (const char* shank : {"LeftLeg", "RightLeg"})
    change_skin_of(character, shank, [](Eigen::Vector3f& p) {
      if (p.y() < 0.3f) p = Eigen::Vector3f(p.x() + (p.x() > 0.0f ? 0.08f : -0.08f), 0.004f, 1.4f * p.z());
    });
  return character;
}

TEST(SkinOnFloor, AHemThatHangsToItIsNoFall) {
  BakeSettings settings;
  settings.scene = SceneKind::impulse;
  settings.ball_mass_kg = 1.0;
  settings.ball_speed_m_s = 30.0;
  settings.from = *parse_direction("right");
  settings.hit = Segment::pelvis;
  Diagnostics diagnostics;
  const auto baked = bake(wide_trousers(), settings, diagnostics);
  ASSERT_TRUE(baked) << baked.error().message();
  EXPECT_FALSE(baked->behaviour.fall_begins_s);
  EXPECT_FALSE(baked->figures.first_ground_contact_s);
}

TEST(SkinOnFloor, WhatAHandHoldsIsSaidToSink) {
  Character character = figure();
  Skeleton& skeleton = character.skeleton;
  skeleton.nodes.push_back({"Spear", skeleton.find("RightHand"), {}});
  ASSERT_TRUE(skeleton.sort());
  MeshPart spear;
  spear.node = skeleton.size() - 1;
  for (const float y : {-1.0f, 1.0f})
    for (const float x : {0.0f, 0.02f}) spear.positions.emplace_back(x, y, 0.0f);
  spear.indices = {0, 1, 2, 1, 2, 3};
  character.parts.push_back(spear);
  Diagnostics diagnostics;
  const BakedClip baked = knocked_down(character, "front", diagnostics);
  EXPECT_GT(baked.skin.max.other_m, 0.1);
  EXPECT_LT(baked.skin.max.body_m, 0.020);
  EXPECT_TRUE(std::any_of(diagnostics.warnings().begin(), diagnostics.warnings().end(), [](const auto& w) {
    return w.what.find("what 'Spear' carries lies up to") != std::string::npos;
  }));
}

}  // namespace
}  // namespace ukemi
