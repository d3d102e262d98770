// Small files that were once read wrong without a word. figure.gltf is a plain man of 1.74 m; the others
// differ from it in one thing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "humanoid/humanoid.h"
#include "load/load.h"

namespace ukemi {
namespace {

struct Mapped {
  Character character;
  Result<Humanoid> humanoid;
  Diagnostics diagnostics;

  std::string node(Segment s) const {
    const int node = humanoid ? humanoid->segments[index(s)].node() : -1;
    return node < 0 ? "" : character.skeleton.nodes[node].name;
  }
  std::string warnings() const {
    std::string text;
    for (const Warning& warning : diagnostics.warnings()) text += warning.what + "\n";
    return text;
  }
};

Mapped mapped(const std::string& file, const HumanoidOptions& options = {}) {
  Diagnostics diagnostics;
  auto character = load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/" + file, {}, diagnostics);
  EXPECT_TRUE(character) << file;
  auto humanoid = map_humanoid(*character, options, diagnostics);
  return {std::move(*character), std::move(humanoid), std::move(diagnostics)};
}

void expect_plain_figure(const Mapped& m) {
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_NEAR(m.humanoid->height_m, 1.74, 0.05);
  EXPECT_EQ(m.humanoid->up_axis, 'y');
  const std::pair<Segment, const char*> kNodes[] = {{Segment::pelvis, "Hips"},
                                                    {Segment::abdomen, "Spine"},
                                                    {Segment::chest, "Chest"},
                                                    {Segment::head, "Head"},
                                                    {Segment::clavicle_l, "LeftShoulder"},
                                                    {Segment::hand_r, "RightHand"},
                                                    {Segment::upperarm_l, "LeftArm"},
                                                    {Segment::thigh_l, "LeftUpLeg"},
                                                    {Segment::foot_r, "RightFoot"}};
  for (const auto& [segment, name] : kNodes) EXPECT_EQ(m.node(segment), name);
}

TEST(PublicFaults, ThePlainFigure) {
  const Mapped m = mapped("figure.gltf");
  expect_plain_figure(m);
  EXPECT_EQ(m.warnings(), "");
}

TEST(PublicFaults, ASleeperLiesInAWorldWithYUp) {
  const Mapped m = mapped("asleep.bvh");
  expect_plain_figure(m);
  const BodyPose body = segments_of(m.character.skeleton, *m.humanoid,
                                    sample(m.character.skeleton, m.character.animations[0], 0.0));
  const Vec3 rise = body[index(Segment::head)].translation - body[index(Segment::pelvis)].translation;
  EXPECT_LT(std::abs(rise.y()), 0.2 * rise.norm());
}

TEST(PublicFaults, AMeshNamedHeadIsNoHead) {
  const Mapped m = mapped("mesh_named_head.gltf");
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_EQ(m.node(Segment::head), "def_c_neckB");
  EXPECT_EQ(m.node(Segment::pelvis), "def_c_hip");
  EXPECT_EQ(m.node(Segment::hand_l), "def_l_wrist");
  EXPECT_NEAR(m.humanoid->height_m, 1.74, 0.02);
}

TEST(PublicFaults, AToeOrEndAMicrometreBehindTheAnkleExchangesNothing) {
  for (const char* file : {"toe_noise.gltf", "foot_end_noise.bvh"}) {
    const Mapped m = mapped(file);
    expect_plain_figure(m);
    EXPECT_EQ(m.warnings(), "") << file;
  }
}

TEST(PublicFaults, GroundAndRaisedArmsAddNothingToTheHeight) {
  for (const char* file : {"with_ground.gltf", "arms_up.gltf"}) expect_plain_figure(mapped(file));
}

TEST(PublicFaults, ASmallFigureIsSaidToBeSmall) {
  const Mapped m = mapped("small.gltf");
  ASSERT_TRUE(m.humanoid);
  EXPECT_NEAR(m.humanoid->height_m, 0.94, 0.02);
  EXPECT_NE(m.warnings().find("m tall"), std::string::npos);
}

TEST(PublicFaults, AMirroredArmatureExchangesTheSidesOfTheNames) {
  const Mapped m = mapped("mirrored.gltf");
  ASSERT_TRUE(m.humanoid);
  EXPECT_EQ(m.node(Segment::hand_l), "RightHand");
  EXPECT_NE(m.warnings().find("mirrored"), std::string::npos);
  const BodyPose body = segments_of(m.character.skeleton, *m.humanoid, m.humanoid->reference);
  EXPECT_GT((body[index(Segment::pelvis)].rotation * Vec3::UnitX()).z(), 0.99)
      << "faces where its toes point";
}

TEST(PublicFaults, TwoFiguresAreSaidAndMayBeChosen) {
  const Mapped m = mapped("two_figures.gltf");
  expect_plain_figure(m);
  EXPECT_NE(m.warnings().find("--root 'Hips.001'"), std::string::npos) << m.warnings();
  HumanoidOptions options;
  options.root = "Hips.001";
  const Mapped other = mapped("two_figures.gltf", options);
  ASSERT_TRUE(other.humanoid);
  EXPECT_EQ(other.node(Segment::hand_l), "LeftHand.001");
  EXPECT_EQ(other.node(Segment::pelvis), "Hips.001");
}

TEST(PublicFaults, ASkinThatCoversTheHeadAloneHidesNoLimb) {
  const Mapped m = mapped("head_skin.gltf");
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_EQ(m.node(Segment::pelvis), "C_spine01_bind_jx");
  EXPECT_EQ(m.node(Segment::head), "C_head01_bind_jx");
  EXPECT_EQ(m.node(Segment::hand_l), "L_hand01_bind_jx");
  EXPECT_EQ(m.node(Segment::foot_r), "R_foot01_bind_jx");
}

TEST(PublicFaults, AVolumeOfTheShinIsNoFoot) {
  const Mapped m = mapped("sl_body.gltf");
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_EQ(m.node(Segment::thigh_l), "mHipLeft");
  EXPECT_EQ(m.node(Segment::shank_l), "mKneeLeft");
  EXPECT_EQ(m.node(Segment::foot_l), "mAnkleLeft");
  EXPECT_EQ(m.node(Segment::head), "mHead");
  EXPECT_EQ(m.node(Segment::upperarm_r), "mShoulderRight");
}

/// Moves bones to the other side of the figure that the file puts on one.
void mirror_places(Skeleton& skeleton, const std::vector<std::string>& bones) {
  for (const std::string& bone : bones) skeleton.nodes[skeleton.find(bone)].rest.translation.x() *= -1.0;
}

std::vector<std::string> arm_of(const std::string& side) {
  return {side + "Shoulder", side + "Arm", side + "ForeArm", side + "Hand"};
}

Character plain_skeleton() {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  EXPECT_TRUE(character);
  character->parts.clear();
  character->skins.clear();
  return std::move(*character);
}

TEST(PublicFaults, AnArmOnTheOtherSideThanItsNameSaysIsSaid) {
  Character character = plain_skeleton();
  mirror_places(character.skeleton, arm_of("Left"));
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().message();
  EXPECT_EQ(humanoid->segments[index(Segment::upperarm_l)].node(), character.skeleton.find("LeftArm"));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_EQ(diagnostics.warnings()[0].what,
            "the left arm ('LeftArm') lies on the right side of the body; the names win: --map "
            "upperarm_l=NODE and --map upperarm_r=NODE say otherwise");
}

TEST(PublicFaults, NoBoneIsTheArmOfBothSides) {
  Character character = plain_skeleton();
  for (const char* side : {"Left", "Right"}) mirror_places(character.skeleton, arm_of(side));
  const std::vector<std::string> named = arm_of("Left");
  for (Node& node : character.skeleton.nodes)
    if (std::find(named.begin(), named.end(), node.name) == named.end()) node.name.clear();
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().message();
  EXPECT_NE(humanoid->segments[index(Segment::upperarm_l)].node(),
            humanoid->segments[index(Segment::upperarm_r)].node());
  EXPECT_FALSE(diagnostics.warnings().empty()) << "one name against the feet";
}

/// figure.gltf with feet that hang on no leg and have meshes of their own.
Character with_feet_apart(bool named) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  EXPECT_TRUE(character);
  Skeleton& skeleton = character->skeleton;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  for (const char* foot : {"LeftFoot", "RightFoot"}) {
    const int node = skeleton.find(foot);
    skeleton.nodes[node].parent = -1;
    skeleton.nodes[node].rest.translation = world[node].translation();
    MeshPart shoe;
    shoe.node = node;
    for (const float z : {-0.05f, 0.2f})
      for (const float x : {-0.04f, 0.04f}) shoe.positions.push_back({x, -0.06f, z});
    shoe.indices = {0, 1, 2, 1, 3, 2};
    character->parts.push_back(shoe);
  }
  for (Skin& skin : character->skins)
    for (int& joint : skin.joints)
      if (const std::string& name = skeleton.nodes[joint].name;
          name.find("Foot") != std::string::npos || name.find("Toe") != std::string::npos)
        joint = skeleton.find("Hips");
  if (!named)
    for (Node& node : skeleton.nodes) node.name.clear();
  EXPECT_TRUE(skeleton.sort());
  return std::move(*character);
}

TEST(PublicFaults, FeetThatHangOnNoLegAreFoundByTheirPlace) {
  for (const bool named : {true, false}) {
    const Character character = with_feet_apart(named);
    Diagnostics diagnostics;
    const auto humanoid = map_humanoid(character, {}, diagnostics);
    ASSERT_TRUE(humanoid) << humanoid.error().message();
    EXPECT_NEAR(humanoid->height_m, 1.74, 0.05);
    const auto world = world_transforms(character.skeleton, rest_pose(character.skeleton));
    for (const auto& [foot, side] : {std::pair(Segment::foot_l, 1.0), {Segment::foot_r, -1.0}}) {
      const int node = humanoid->segments[index(foot)].node();
      ASSERT_GE(node, 0) << named;
      EXPECT_LT(character.skeleton.nodes[node].parent, 0);
      EXPECT_GT(side * world[node].translation().x(), 0.05);
    }
  }
}

TEST(PublicFaults, UpperAndLowerBodyMayHangSideBySide) {
  const Mapped m = mapped("mmd_bones.gltf");
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_EQ(m.node(Segment::pelvis), "下半身");
  EXPECT_EQ(m.node(Segment::chest), "上半身2");
  EXPECT_EQ(m.node(Segment::thigh_l), "左足");
  EXPECT_EQ(m.node(Segment::foot_l), "左足首");
  EXPECT_EQ(m.node(Segment::forearm_r), "右ひじ");
  EXPECT_EQ(m.node(Segment::hand_r), "右手首");
}

TEST(PublicFaults, ARootBetweenTheFeetIsNoPelvis) {
  const Mapped m = mapped("root_at_feet.gltf");
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().what;
  EXPECT_EQ(m.node(Segment::pelvis), "body_IK");
  EXPECT_EQ(m.node(Segment::chest), "body_upper");
  EXPECT_EQ(m.node(Segment::head), "head");
  EXPECT_EQ(m.humanoid->segments[index(Segment::head)].chain.size(), 1u);
}

TEST(PublicFaults, BonesSideBySideAreRefusedWithTheRelationThatFails) {
  const Mapped m = mapped("flat_bones.gltf");
  ASSERT_FALSE(m.humanoid);
  EXPECT_NE(m.humanoid.error().what.find("does not hang below"), std::string::npos)
      << m.humanoid.error().what;
}

TEST(PublicFaults, AFrameTimeInMillisecondsIsSaid) {
  EXPECT_NE(mapped("frame_time_ms.bvh").warnings().find("less than one frame a second"), std::string::npos);
}

/// figure.gltf with some inverse bind matrices changed.
Mapped with_bind_pose(const std::function<void(std::size_t joint, Affine& inverse_bind)>& change) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  EXPECT_TRUE(character);
  for (Skin& skin : character->skins)
    for (std::size_t j = 0; j < skin.inverse_bind.size(); ++j) change(j, skin.inverse_bind[j]);
  auto humanoid = map_humanoid(*character, {}, diagnostics);
  return {std::move(*character), std::move(humanoid), std::move(diagnostics)};
}

TEST(PublicFaults, ABindPoseOfAnotherSkeletonIsSaidAndTheHeightIsThatOfTheBones) {
  const auto far = [](std::size_t, Affine& bind) { bind = bind * Eigen::Translation3d(0.0, -30.0, 0.0); };
  const auto one = [](std::size_t joint, Affine& bind) {
    if (joint == 4) bind = bind * Eigen::Translation3d(0.0, -3.0, 0.0);
  };
  const auto scattered = [](std::size_t joint, Affine& bind) {
    const double angle = 2.4 * static_cast<double>(joint);
    bind = bind * Eigen::Translation3d(3.0 * std::cos(angle), 1.0, 3.0 * std::sin(angle));
  };
  for (const auto& change : {std::function<void(std::size_t, Affine&)>(far), {one}, {scattered}}) {
    const Mapped m = with_bind_pose(change);
    ASSERT_TRUE(m.humanoid);
    EXPECT_NE(m.warnings().find("the bind pose of the skin does not fit the skeleton"), std::string::npos)
        << m.warnings();
    EXPECT_NEAR(m.humanoid->height_m, 1.7, 0.1);
  }
  const Mapped plain = with_bind_pose([](std::size_t, Affine&) {});
  EXPECT_EQ(plain.warnings(), "");
}

/// figure.gltf with a bone on `parent` at its place, and a long box: skin of that bone, or a mesh on it.
Mapped with_something_on(const char* parent, bool skinned) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  EXPECT_TRUE(character);
  Skeleton& skeleton = character->skeleton;
  skeleton.nodes.push_back({"Something", skeleton.find(parent), {}});
  EXPECT_TRUE(skeleton.sort());
  MeshPart box;
  box.node = skeleton.size() - 1;
  for (const float y : {0.2f, 2.8f})
    for (const float x : {0.0f, 0.02f}) box.positions.emplace_back(x, y, 0.0f);
  box.indices = {0, 1, 2, 1, 2, 3};
  if (skinned) {
    box.skin = 0;
    Skin& skin = character->skins.at(0);
    skin.joints.push_back(box.node);
    skin.inverse_bind.push_back(Affine::Identity());
    const auto joint = static_cast<std::uint16_t>(skin.joints.size() - 1);
    box.joints.assign(box.positions.size(), {joint, 0, 0, 0});
    box.weights.assign(box.positions.size(), {1.0f, 0.0f, 0.0f, 0.0f});
  }
  character->parts.push_back(box);
  auto humanoid = map_humanoid(*character, {}, diagnostics);
  return {std::move(*character), std::move(humanoid), std::move(diagnostics)};
}

TEST(PublicFaults, HatsSpearsAndWingsAreNeitherHeightNorABadBindPose) {
  for (const char* parent : {"Head", "RightHand", "Chest"})
    for (const bool skinned : {false, true}) {
      const Mapped m = with_something_on(parent, skinned);
      ASSERT_TRUE(m.humanoid);
      EXPECT_NEAR(m.humanoid->height_m, 1.74, 0.01) << parent << skinned;
      EXPECT_EQ(m.warnings(), "") << parent << skinned;
    }
}

TEST(PublicFaults, AJointNamedHeadBelowTheHipsIsNoHead) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  ASSERT_TRUE(character);
  Skeleton& skeleton = character->skeleton;
  skeleton.nodes[skeleton.find("Head")].name = "Skull_x";
  skeleton.nodes[skeleton.find("Neck")].name = "collar";
  Node bag{"Head", skeleton.find("Hips"), {}};
  bag.rest.translation = Vec3(0.0, -0.15, 0.1);
  skeleton.nodes.push_back(bag);
  ASSERT_TRUE(skeleton.sort());
  character->skins.at(0).joints.push_back(skeleton.size() - 1);
  character->skins.at(0).inverse_bind.push_back(Affine::Identity());
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().what;
  EXPECT_EQ(skeleton.nodes[humanoid->segments[index(Segment::head)].node()].name, "Skull_x");
  EXPECT_NEAR(humanoid->height_m, 1.74, 0.01);
}

TEST(PublicFaults, ASecondFigureIsSaidWhateverItsBonesAreCalled) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/two_figures.gltf", {}, diagnostics);
  ASSERT_TRUE(character);
  int renamed = 0;  // the second figure's bones, to what says nothing
  for (Node& node : character->skeleton.nodes)
    if (node.name.ends_with(".001")) node.name = "b" + std::to_string(renamed++);
  ASSERT_GT(renamed, 15);
  ASSERT_TRUE(map_humanoid(*character, {}, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("--root 'b0'"), std::string::npos)
      << diagnostics.warnings()[0].what;
}

TEST(PublicFaults, ASecondFigureIsSaidWhereNoBoneHasAName) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/two_figures.gltf", {}, diagnostics);
  ASSERT_TRUE(character);
  for (Node& node : character->skeleton.nodes) node.name.clear();
  ASSERT_TRUE(map_humanoid(*character, {}, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("holds more than one figure"), std::string::npos);
}

TEST(PublicFaults, ABindPoseOfAnotherScaleIsSaidAndTheHeightIsThatOfTheBones) {
  const Mapped m = with_bind_pose([](std::size_t, Affine& inverse_bind) {
    inverse_bind = Affine::Identity();
    inverse_bind.linear() *= 1.0 / 3.0;
  });
  ASSERT_TRUE(m.humanoid) << m.humanoid.error().message();
  EXPECT_NE(m.warnings().find("the bind pose of the skin does not fit"), std::string::npos) << m.warnings();
  EXPECT_NEAR(m.humanoid->height_m, 1.74, 0.12);
}

TEST(PublicFaults, AScaleThatDiffersByAxisIsSaid) {
  for (const double along : {1.0, 1.3}) {
    Diagnostics diagnostics;
    auto character =
        load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
    ASSERT_TRUE(character);
    Node& hips = character->skeleton.nodes[character->skeleton.find("Hips")];
    hips.rest.scale = Vec3(1.0, along, 1.0);
    ASSERT_TRUE(map_humanoid(*character, {}, diagnostics));
    const auto& said = diagnostics.warnings();
    EXPECT_EQ(
        std::count_if(said.begin(), said.end(),
                      [](const Warning& w) { return w.what.find("'Hips' differs by axis") != w.what.npos; }),
        along == 1.0 ? 0 : 1);
  }
}

TEST(PublicFaults, ALimbOfOneBoneIsRefusedWithWhatItNeeds) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  ASSERT_TRUE(character);
  for (const char* bone : {"LeftForeArm", "LeftHand", "RightForeArm", "RightHand"}) {
    Node& node = character->skeleton.nodes[character->skeleton.find(bone)];
    node.name = "tip_end";
    node.rest.translation = Vec3::Zero();
  }
  character->parts.clear();
  character->skins.clear();
  const auto refused = map_humanoid(*character, {}, diagnostics);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().fix.find("an arm or a leg needs two bones"), std::string::npos)
      << refused.error().message();
}

TEST(PublicFaults, AThumbTurnsWithAHandOfTwoBonesInOnePlace) {
  Diagnostics diagnostics;
  auto character =
      load_character(std::string(UKEMI_TEST_DATA) + "/public_faults/figure.gltf", {}, diagnostics);
  ASSERT_TRUE(character);
  character->parts.clear();
  character->skins.clear();
  Skeleton& skeleton = character->skeleton;
  const int hand = skeleton.find("LeftHand");
  for (const char* name : {"LeftFingerBase", "LThumb"}) {  // as in the CMU rigs
    Node node;
    node.name = name;
    node.parent = hand;
    skeleton.nodes.push_back(node);
  }
  ASSERT_TRUE(skeleton.sort());
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().message();
  ASSERT_EQ(humanoid->segments[index(Segment::hand_l)].chain.size(), 2u);
  const Pose rest = rest_pose(skeleton);
  const BodyPose from = segments_of(skeleton, *humanoid, rest);
  BodyPose to = from;
  const Quat turn = exp_rotation(Vec3(0.3, 0.8, -0.4));
  to[index(Segment::hand_l)].rotation = turn * from[index(Segment::hand_l)].rotation;
  const auto before = world_transforms(skeleton, rest);
  const auto after = world_transforms(skeleton, pose_skeleton(skeleton, *humanoid, rest, from, to));
  for (const char* name : {"LeftFingerBase", "LThumb"}) {
    const auto node = static_cast<std::size_t>(skeleton.find(name));
    const Quat turned = rotation_part(after[node].linear() * before[node].linear().inverse());
    EXPECT_LT(angle_between(turned, turn), 1e-6) << name;
  }
}

}  // namespace
}  // namespace ukemi
