// Which nodes are taken for bones, and where bones have to lie.
#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

using testing::Builder;
using testing::figure;
using testing::FigureOptions;

Result<Humanoid> mapped(const Character& character, const HumanoidOptions& options = {}) {
  Diagnostics diagnostics;
  return map_humanoid(character, options, diagnostics);
}

std::string node_of(const Character& character, const Humanoid& humanoid, Segment s) {
  const int node = humanoid.segments[index(s)].node();
  return node < 0 ? "" : character.skeleton.nodes[node].name;
}

/// Binds a mesh on a new node of that name, below `parent`, to all nodes that are there, and renames the
/// bones to what says nothing.
Character with_mesh_named(const std::string& name, bool in_a_group) {
  Character character = figure();
  Skeleton& skeleton = character.skeleton;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  Skin skin;
  MeshPart part;
  for (int i = 1; i < skeleton.size(); ++i) {
    skin.joints.push_back(i);
    skin.inverse_bind.push_back(world[i].inverse());
    part.positions.push_back(world[i].translation().cast<float>());
    part.joints.push_back({static_cast<std::uint16_t>(i - 1), 0, 0, 0});
    part.weights.push_back({1.0f, 0.0f, 0.0f, 0.0f});
    skeleton.nodes[i].name = "b" + std::to_string(i);
  }
  if (in_a_group) skeleton.nodes.push_back({name, 0, {}});
  const int group = in_a_group ? skeleton.size() - 1 : 0;
  skeleton.nodes.push_back({in_a_group ? "mesh" : name, group, {}});
  part.node = skeleton.size() - 1;
  part.skin = 0;
  character.skins.push_back(skin);
  character.parts.push_back(part);
  EXPECT_TRUE(skeleton.sort());
  return character;
}

TEST(Placement, MeshesAndTheirGroupsAreNoBones) {
  const auto expected = mapped(with_mesh_named("mesh", false));
  ASSERT_TRUE(expected);
  for (const bool in_a_group : {false, true})
    for (const char* name : {"Head", "Body", "Hips", "Pelvis", "Root", "LeftHand"}) {
      const auto found = mapped(with_mesh_named(name, in_a_group));
      ASSERT_TRUE(found) << name;
      for (int s = 0; s < kSegmentCount; ++s)
        EXPECT_EQ(found->segments[s].chain, expected->segments[s].chain) << name;
    }
}

TEST(Placement, AControlNamedHeadOrHipsBesideTheBodyIsNoneOfIt) {
  for (const char* name : {"Head", "Pelvis"}) {
    Character character = figure();
    for (Node& node : character.skeleton.nodes) {
      if (node.name == "mixamorig:Head") node.name = "x1";
      if (node.name == "mixamorig:Hips") node.name = "x2";
    }
    character.skeleton.nodes.push_back({name, 0, {}});
    ASSERT_TRUE(character.skeleton.sort());
    const auto humanoid = mapped(character);
    ASSERT_TRUE(humanoid) << name;
    EXPECT_EQ(node_of(character, *humanoid, Segment::pelvis), "x2");
    EXPECT_EQ(node_of(character, *humanoid, Segment::head), "x1");
  }
}

TEST(Placement, AFootOfEitherLegNeedsNoSideOfItsOwn) {
  Character character = figure();
  for (const char* side : {"Left", "Right"})
    for (const auto& [bone, name] : {std::pair("Foot", "foot"), {"Hand", "hand"}}) {
      const int node = character.skeleton.find("mixamorig:" + std::string(side) + bone);
      ASSERT_GE(node, 0);
      character.skeleton.nodes[node].name = name;
    }
  const auto humanoid = mapped(character);
  ASSERT_TRUE(humanoid) << humanoid.error().what;
  for (const Segment end : {Segment::foot_l, Segment::foot_r, Segment::hand_l, Segment::hand_r})
    EXPECT_EQ(character.skeleton.nodes[humanoid->segments[index(end)].node()].parent,
              humanoid->segments[index(end) - 1].node())
        << name(end);
}

/// The figure with the legs on a lower body that hangs beside the upper body.
Character two_bodied(bool names) {
  Builder b;
  FigureOptions options;
  options.names = names;
  const int waist = b.add("Waist", b.add("Armature", -1, Vec3::Zero()), Vec3(0, 1.0, 0));
  const int lower = b.add("LowerBody", waist, Vec3(0, 0.98, 0));
  const int upper = b.add("UpperBody", waist, Vec3(0, 1.08, 0));
  const int chest = b.add("UpperBody2", upper, Vec3(0, 1.25, 0));
  b.add("Head", b.add("Neck", chest, Vec3(0, 1.48, 0)), Vec3(0, 1.56, 0.02));
  testing::add_arm(b, options, chest, 1.0, "Left");
  testing::add_arm(b, options, chest, -1.0, "Right");
  testing::add_leg(b, options, lower, 1.0, "Left");
  testing::add_leg(b, options, lower, -1.0, "Right");
  return b.finish(options);
}

TEST(Placement, LegsMayHangOnALowerBodyBesideTheUpperBody) {
  for (const bool names : {true, false}) {
    const Character character = two_bodied(names);
    const auto humanoid = mapped(character);
    ASSERT_TRUE(humanoid) << humanoid.error().what;
    EXPECT_EQ(humanoid->segments[index(Segment::pelvis)].chain, std::vector<int>{2});
    EXPECT_EQ(humanoid->segments[index(Segment::chest)].chain, std::vector<int>{4});
    EXPECT_EQ(humanoid->root, 1);
  }
}

/// The figure with arms and spine side by side on the pelvis.
Character arms_on_pelvis(bool names) {
  Builder b;
  FigureOptions options;
  options.names = names;
  options.clavicles = false;
  const int hips = b.add("Hips", b.add("Armature", -1, Vec3::Zero()), Vec3(0, 1.0, 0));
  const int chest = b.add("Chest", b.add("Spine", hips, Vec3(0, 1.1, 0)), Vec3(0, 1.25, 0));
  b.add("Head", b.add("Neck", chest, Vec3(0, 1.5, 0)), Vec3(0, 1.56, 0.02));
  testing::add_arm(b, options, hips, 1.0, "Left");
  testing::add_arm(b, options, hips, -1.0, "Right");
  testing::add_leg(b, options, hips, 1.0, "Left");
  testing::add_leg(b, options, hips, -1.0, "Right");
  return b.finish(options);
}

TEST(Placement, ArmsMayHangOnThePelvisBesideTheSpine) {
  for (const bool names : {true, false}) {
    const Character character = arms_on_pelvis(names);
    const auto humanoid = mapped(character);
    ASSERT_TRUE(humanoid) << humanoid.error().what;
    EXPECT_EQ(humanoid->segments[index(Segment::chest)].node(), 3);
    EXPECT_TRUE(humanoid->segments[index(Segment::upperarm_l)].detached);
    // The arm goes with the chest all the same.
    const BodyPose from = segments_of(character.skeleton, *humanoid, humanoid->reference);
    BodyPose to = from;
    const Rigid bend{exp_rotation(Vec3(0.5, 0, 0)), Vec3::Zero()};
    const Rigid about{Quat::Identity(), from[index(Segment::abdomen)].translation};
    for (Segment s = Segment::abdomen; s < Segment::thigh_l; s = segment_at(index(s) + 1))
      to[index(s)] = about * bend * about.inverse() * from[index(s)];
    const Pose pose = pose_skeleton(character.skeleton, *humanoid, humanoid->reference, from, to);
    const BodyPose made = segments_of(character.skeleton, *humanoid, pose);
    EXPECT_LT((made[index(Segment::hand_l)].translation - to[index(Segment::hand_l)].translation).norm(),
              1e-9);
  }
}

TEST(Placement, ANeckThatCarriesTheClaviclesIsNoChest) {
  for (const bool names : {true, false}) {
    Builder b;
    FigureOptions options;
    options.names = names;
    const int hips = b.add("Hips", b.add("Armature", -1, Vec3::Zero()), Vec3(0, 1.0, 0));
    const int chest = b.add("Spine1", b.add("Spine", hips, Vec3(0, 1.1, 0)), Vec3(0, 1.25, 0));
    const int neck = b.add("Neck", chest, Vec3(0, 1.5, 0));
    b.add("Head", neck, Vec3(0, 1.56, 0.02));
    testing::add_arm(b, options, neck, 1.0, "Left");
    testing::add_arm(b, options, neck, -1.0, "Right");
    testing::add_leg(b, options, hips, 1.0, "Left");
    testing::add_leg(b, options, hips, -1.0, "Right");
    const Character character = b.finish(options);
    const auto humanoid = mapped(character);
    ASSERT_TRUE(humanoid) << humanoid.error().what;
    EXPECT_EQ(humanoid->segments[index(Segment::chest)].node(), chest);
    EXPECT_EQ(humanoid->segments[index(Segment::head)].chain.front(), neck);
    EXPECT_TRUE(humanoid->segments[index(Segment::clavicle_l)].detached);
  }
}

TEST(UserMap, SaysWhatIsWrongWithIt) {
  const Character character = figure();
  const std::pair<std::map<std::string, std::string>, const char*> kCases[] = {
      {{{"abdomen", "mixamorig:Neck"}}, "abdomen (mixamorig:Neck) does not carry"},
      {{{"hand_l", "mixamorig:LeftHand"}, {"hand_r", "mixamorig:LeftHand"}}, "said to be both"},
      {{{"pelvis", "mixamorig:LeftHand"}}, "pelvis (mixamorig:LeftHand)"},
      {{{"head", "mixamorig:Hips"}}, "head (mixamorig:Hips) hangs above"},
      {{{"head", "mixamorig:LeftHand"}}, "head (mixamorig:LeftHand) hangs below"},
      {{{"forearm_l", "mixamorig:RightForeArm"}}, "does not hang below"},
      {{{"foot_l", "mixamorig:RightFoot"}}, "foot_l (mixamorig:RightFoot) hangs below thigh_r"},
      {{{"hand_l", "mixamorig:LeftFoot"}}, "hand_l (mixamorig:LeftFoot) hangs below thigh_l"},
      {{{"head", "#99"}}, "there is no node #99"}};
  for (const auto& [map, what] : kCases) {
    HumanoidOptions options;
    options.map = map;
    const auto refused = mapped(character, options);
    ASSERT_FALSE(refused) << what;
    EXPECT_EQ(refused.error().kind, ErrorKind::usage) << what;
    EXPECT_NE(refused.error().what.find(what), std::string::npos) << refused.error().what;
    EXPECT_FALSE(refused.error().fix.empty());
  }
}

TEST(UserMap, ListsWhatThereIs) {
  Character character = figure();
  character.skeleton.nodes[character.skeleton.find("mixamorig:Neck")].name = "mixamorig:Head";
  HumanoidOptions options;
  options.map = {{"head", "mixamorig:Head"}};
  auto refused = mapped(character, options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().fix.find("#5, #6"), std::string::npos) << refused.error().fix;
  options.map = {{"head", "#99"}};
  refused = mapped(character, options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().fix.find(std::to_string(character.skeleton.size() - 1)), std::string::npos);
}

TEST(UserMap, NamesNoBonesThatTheUserDidNot) {
  const Character character = figure();
  HumanoidOptions options;
  options.map = {{"pelvis", "mixamorig:Hips"}};
  const auto humanoid = mapped(character, options);
  ASSERT_TRUE(humanoid);
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_EQ(humanoid->segments[s].by, segment_at(s) == Segment::pelvis ? "user" : "name");
}

TEST(UserMap, WhatHangsBelowANamedBoneIsStillLookedFor) {
  FigureOptions figure_options;
  Character character = figure(figure_options);
  for (Node& node : character.skeleton.nodes)
    if (node.name.find("LeftArm") != std::string::npos || node.name.find("LeftFore") != std::string::npos ||
        node.name.find("LeftHand") != std::string::npos)
      node.name = "bone" + std::to_string(&node - character.skeleton.nodes.data());
  const int arm = character.skeleton.nodes[character.skeleton.find("mixamorig:LeftShoulder")].parent;
  ASSERT_GE(arm, 0);
  const int shoulder = character.skeleton.find("mixamorig:LeftShoulder");
  HumanoidOptions options;
  options.map = {{"upperarm_l", character.skeleton.label(shoulder + 1)}};
  const auto humanoid = mapped(character, options);
  ASSERT_TRUE(humanoid) << humanoid.error().what;
  EXPECT_EQ(humanoid->segments[index(Segment::upperarm_l)].by, "user");
  EXPECT_EQ(humanoid->segments[index(Segment::forearm_l)].node(), shoulder + 2);
  EXPECT_EQ(humanoid->segments[index(Segment::hand_l)].node(), shoulder + 3);
}

}  // namespace
}  // namespace ukemi
