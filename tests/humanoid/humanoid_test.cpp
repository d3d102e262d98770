#include "humanoid/humanoid.h"

#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "support/random.h"

namespace ukemi {
namespace {

using testing::figure;
using testing::FigureOptions;

Humanoid mapped(const Character& character, const HumanoidOptions& options = {}) {
  Diagnostics diagnostics;
  const auto result = map_humanoid(character, options, diagnostics);
  EXPECT_TRUE(result) << (result ? "" : result.error().message());
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().what;
  return result ? *result : Humanoid{};
}

std::string node_of(const Character& character, const Humanoid& humanoid, Segment s) {
  const int node = humanoid.segments[index(s)].node();
  return node < 0 ? "" : character.skeleton.nodes[node].name;
}

TEST(Humanoid, MapsMixamoNames) {
  const Character character = figure();
  const Humanoid humanoid = mapped(character);
  EXPECT_EQ(node_of(character, humanoid, Segment::pelvis), "mixamorig:Hips");
  EXPECT_EQ(node_of(character, humanoid, Segment::abdomen), "mixamorig:Spine");
  EXPECT_EQ(node_of(character, humanoid, Segment::chest), "mixamorig:Spine2");
  EXPECT_EQ(humanoid.segments[index(Segment::chest)].chain.size(), 2u);
  EXPECT_EQ(humanoid.segments[index(Segment::head)].chain.size(), 2u);
  EXPECT_EQ(node_of(character, humanoid, Segment::clavicle_l), "mixamorig:LeftShoulder");
  EXPECT_EQ(node_of(character, humanoid, Segment::upperarm_r), "mixamorig:RightArm");
  EXPECT_EQ(node_of(character, humanoid, Segment::shank_l), "mixamorig:LeftLeg");
  EXPECT_EQ(humanoid.segments[index(Segment::foot_r)].by, "name");
  EXPECT_EQ(humanoid.rest_pose, RestPoseClass::t_pose);
  EXPECT_EQ(humanoid.up_axis, 'y');
  EXPECT_NEAR(humanoid.height_m, 1.741, 0.05);
  EXPECT_EQ(humanoid.root, character.skeleton.find("mixamorig:Hips"));
  EXPECT_EQ(humanoid.toes[0], character.skeleton.find("mixamorig:LeftToeBase"));
  EXPECT_EQ(humanoid.middle_finger[1], character.skeleton.find("mixamorig:RightHandMiddle1"));
  EXPECT_EQ(humanoid.head_top, character.skeleton.find("mixamorig:HeadTop_End"));
}

TEST(Humanoid, FindsTheSameBonesWithoutNames) {
  for (const double elevation : {90.0, 45.0, 5.0}) {
    const Character named = figure({.arm_elevation_deg = elevation});
    const Character unnamed = figure({.arm_elevation_deg = elevation, .names = false});
    const Humanoid by_name = mapped(named), by_shape = mapped(unnamed);
    for (int s = 0; s < kSegmentCount; ++s) {
      if (segment_at(s) == Segment::head)
        continue;  // without a name the top of the head is a bone like the others
      EXPECT_EQ(by_shape.segments[s].chain, by_name.segments[s].chain)
          << name(segment_at(s)) << " " << elevation;
    }
    EXPECT_EQ(by_shape.segments[index(Segment::forearm_l)].by, "topology");
  }
}

TEST(Humanoid, NamesOfSidesWinOverTheFeetWithAWarning) {
  Character character = figure();
  for (Node& node : character.skeleton.nodes) {
    const auto left = node.name.find("Left"), right = node.name.find("Right");
    if (left != std::string::npos) node.name.replace(left, 4, "Right");
    if (right != std::string::npos) node.name.replace(right, 5, "Left");
  }
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("the names say, the feet point backwards; they are believed"),
            std::string::npos);
  EXPECT_EQ(node_of(character, *humanoid, Segment::forearm_l), "mixamorig:LeftForeArm");
}

/// The figure with its toes moved forwards (z) by so much, and its BVH-like names or none.
Character with_toes_at(double z, bool names) {
  Character character = figure();
  for (Node& node : character.skeleton.nodes) {
    if (node.name.find("ToeBase") != std::string::npos) node.rest.translation.z() = z;
    if (!names) node.name.clear();
  }
  return character;
}

TEST(Humanoid, FeetThatPointNowhereExchangeNothing) {
  for (const double z : {0.02, 1e-6, 0.0, -1e-6, -0.02}) {
    const Character character = with_toes_at(z, true);
    EXPECT_EQ(node_of(character, mapped(character), Segment::forearm_l), "mixamorig:LeftForeArm") << z;
  }
}

TEST(Humanoid, FeetSayWhichSideIsLeftWhereNamesDoNot) {
  for (const double z : {0.14, -0.14}) {
    const Character character = with_toes_at(z, false);
    const Humanoid humanoid = mapped(character);
    const Vec3 thigh =
        world_transforms(character.skeleton,
                         rest_pose(character.skeleton))[humanoid.carrier_node(Segment::thigh_l)]
            .translation();
    EXPECT_EQ(thigh.x() > 0.0, z > 0.0);
  }
  Diagnostics diagnostics;
  ASSERT_TRUE(map_humanoid(with_toes_at(0.0, false), {}, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("which side is left"), std::string::npos);
}

TEST(Humanoid, TheUsersSidesWinOverNamesAndFeet) {
  HumanoidOptions options;
  for (const auto& [segment, bone] : {std::pair("thigh", "UpLeg"),
                                      {"shank", "Leg"},
                                      {"foot", "Foot"},
                                      {"clavicle", "Shoulder"},
                                      {"upperarm", "Arm"},
                                      {"forearm", "ForeArm"},
                                      {"hand", "Hand"}}) {
    options.map[std::string(segment) + "_l"] = std::string("mixamorig:Right") + bone;
    options.map[std::string(segment) + "_r"] = std::string("mixamorig:Left") + bone;
  }
  Diagnostics diagnostics;
  const Character character = figure();
  const auto humanoid = map_humanoid(character, options, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().what;
  EXPECT_EQ(node_of(character, *humanoid, Segment::hand_l), "mixamorig:RightHand");
  EXPECT_EQ(diagnostics.warnings().size(), 1u);
}

TEST(Humanoid, ReadsUnitAndUpAxisFromTheFigure) {
  const Quat z_up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  for (const double unit : {1.0, 100.0, 1000.0 / 25.4}) {
    Character character = figure({.unit = unit, .armature = z_up, .armature_scale = 100.0});
    character.format = SourceFormat::assimp;
    const Humanoid humanoid = mapped(character);
    EXPECT_EQ(humanoid.up_axis, 'z');
    EXPECT_NEAR(humanoid.world_from_file.scale * unit, 1.0, 1e-12);
    EXPECT_NEAR(humanoid.height_m, 1.741, 0.05);
    const BodyPose body = segments_of(character.skeleton, humanoid, humanoid.reference);
    EXPECT_NEAR(body[index(Segment::pelvis)].translation.y(), 0.93, 1e-9);
  }
}

TEST(Humanoid, UnitsOfFilesThatStateNoneAreGuessedAsDrawn) {
  // A child in centimetres is no giant in inches; a hundredth of a man is no man and a bit.
  const std::tuple<double, SourceFormat, double> kCases[] = {
      {100.0 * 0.55, SourceFormat::bvh, 0.01},   {100.0, SourceFormat::bvh, 0.01},
      {1.0 / 0.0254, SourceFormat::bvh, 0.0254}, {1.0 / 0.056444, SourceFormat::bvh, 0.056444},
      {0.01, SourceFormat::gltf, 100.0},         {1000.0, SourceFormat::gltf, 0.001}};
  for (const auto& [units_per_metre, format, metres_per_unit] : kCases) {
    Character character = figure({.unit = units_per_metre});
    character.format = format;
    Diagnostics diagnostics;
    const auto humanoid = map_humanoid(character, {}, diagnostics);
    ASSERT_TRUE(humanoid);
    EXPECT_NEAR(humanoid->world_from_file.scale / metres_per_unit, 1.0, 1e-9) << units_per_metre;
  }
}

TEST(Humanoid, TakesUnitUpAndHeightFromTheUser) {
  const Character character = figure({.unit = 100.0});
  Diagnostics said;
  EXPECT_TRUE(
      map_humanoid(character, {.map = {}, .metres_per_unit = 0.02, .up_axis = {}, .height_m = 1.2}, said));
  ASSERT_EQ(said.warnings().size(), 1u);
  EXPECT_EQ(said.warnings()[0].what, "--unit has no effect beside --height, which sets the size");
  EXPECT_DOUBLE_EQ(mapped(character, {.map = {}, .metres_per_unit = 0.02, .up_axis = {}, .height_m = {}})
                       .world_from_file.scale,
                   0.02);
  EXPECT_NEAR(mapped(character, {.map = {}, .metres_per_unit = {}, .up_axis = {}, .height_m = 1.2}).height_m,
              1.2, 1e-12);
}

TEST(Humanoid, AChildAndATallCartoonKeepTheirHeightAndAGiantBecomesAHuman) {
  for (const auto& [unit, height_m] : {std::pair(1.6, 2.8), {0.5, 0.87}}) {
    Diagnostics said;
    const auto humanoid = map_humanoid(figure({.unit = unit}), {}, said);
    ASSERT_TRUE(humanoid);
    EXPECT_NEAR(humanoid->height_m, height_m, 0.1);
    ASSERT_EQ(said.warnings().size(), 1u);
    EXPECT_NE(said.warnings()[0].what.find("m tall"), std::string::npos);
  }
  Diagnostics diagnostics;
  const auto giant = map_humanoid(figure({.unit = 5.0}), {}, diagnostics);
  ASSERT_TRUE(giant);
  EXPECT_NEAR(giant->height_m, 1.741, 1e-9);
  EXPECT_EQ(diagnostics.warnings().size(), 1u);
}

TEST(Humanoid, TheNeutralPoseHasAllFramesAligned) {
  for (const bool twisted : {false, true}) {
    const Character character = figure({.arm_elevation_deg = 0.0, .twisted_nodes = twisted});
    const Humanoid humanoid = mapped(character);
    EXPECT_EQ(humanoid.rest_pose, RestPoseClass::neutral);
    const BodyPose body = segments_of(character.skeleton, humanoid, humanoid.reference);
    // Facing +z: x anterior = +z, y up, z right = -x.
    Mat3 expected;
    expected << Vec3::UnitZ(), Vec3::UnitY(), -Vec3::UnitX();
    for (int s = 0; s < kSegmentCount; ++s)
      EXPECT_LT(angle_between(body[s].rotation, Quat(expected)), radians(2.5)) << name(segment_at(s));
  }
}

TEST(Humanoid, ATPoseHasTheArmsRaisedAndTheClaviclesEightDegreesUp) {
  const Character character = figure();
  const Humanoid humanoid = mapped(character);
  const BodyPose body = segments_of(character.skeleton, humanoid, humanoid.reference);
  const auto relative = [&](Segment parent, Segment child) {
    return body[index(parent)].rotation.conjugate() * body[index(child)].rotation;
  };
  // About x: raising the right arm sideways is negative, the left positive.
  EXPECT_LT(angle_between(relative(Segment::chest, Segment::upperarm_r), exp_rotation(Vec3(-kPi / 2, 0, 0))),
            1e-9);
  EXPECT_LT(angle_between(relative(Segment::chest, Segment::upperarm_l), exp_rotation(Vec3(kPi / 2, 0, 0))),
            1e-9);
  EXPECT_LT(
      angle_between(relative(Segment::chest, Segment::clavicle_r), exp_rotation(Vec3(-radians(8), 0, 0))),
      1e-9);
  EXPECT_LT(
      angle_between(relative(Segment::chest, Segment::clavicle_l), exp_rotation(Vec3(radians(8), 0, 0))),
      1e-9);
}

TEST(Humanoid, MissingPartsAreFused) {
  const Character character = figure({.spine_bones = 1, .clavicles = false, .hands = false});
  const Humanoid humanoid = mapped(character);
  for (const Segment s : {Segment::abdomen, Segment::clavicle_l, Segment::hand_r})
    EXPECT_TRUE(humanoid.segments[index(s)].fused()) << name(s);
  EXPECT_EQ(humanoid.carrier(Segment::hand_r), Segment::forearm_r);
  EXPECT_EQ(humanoid.carrier(Segment::clavicle_l), Segment::chest);
  const BodyPose body = segments_of(character.skeleton, humanoid, humanoid.reference);
  EXPECT_NEAR(body[index(Segment::hand_l)].translation.x(), 0.18 + 0.28 + 0.955 * 0.28, 1e-9);
}

TEST(Humanoid, SaysWhatIsMissing) {
  Character character = figure();
  for (Node& node : character.skeleton.nodes)
    if (node.name.find("Leg") != std::string::npos) node.name = "strut";
  Diagnostics diagnostics;
  // The legs are still there by shape; without them there is nothing to find.
  EXPECT_TRUE(map_humanoid(character, {}, diagnostics));
  testing::Builder builder;
  const int root = builder.add("Hips", -1, Vec3::Zero());
  builder.add("Head", root, Vec3(0, 1, 0));
  const auto refused = map_humanoid(builder.finish({}), {}, diagnostics);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::input);
  EXPECT_NE(refused.error().what.find("not a humanoid"), std::string::npos);
  EXPECT_NE(refused.error().what.find("found pelvis (Hips), head (Head)"), std::string::npos);
  EXPECT_NE(refused.error().what.find("missing upperarm_l"), std::string::npos);
}

TEST(Humanoid, RefusesAFourLeggedBodyWithHumanNames) {
  testing::Builder b;
  const int hips = b.add("Hips", -1, Vec3(0, 1, 0));
  const int spine = b.add("Spine", hips, Vec3(0, 1, 0.8));
  b.add("Head", spine, Vec3(0, 1.2, 1.2));
  for (const auto& [prefix, x] : {std::pair("Left", 0.15), std::pair("Right", -0.15)}) {
    const std::string p = prefix;
    const int arm = b.add(p + "UpperArm", spine, Vec3(x, 0.9, 0.8));
    b.add(p + "Hand", b.add(p + "ForeArm", arm, Vec3(x, 0.5, 0.8)), Vec3(x, 0.1, 0.8));
    const int thigh = b.add(p + "UpLeg", hips, Vec3(x, 0.9, 0));
    b.add(p + "Foot", b.add(p + "Leg", thigh, Vec3(x, 0.5, 0)), Vec3(x, 0.1, 0));
  }
  Diagnostics diagnostics;
  const auto refused = map_humanoid(b.finish({}), {}, diagnostics);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("not a humanoid"), std::string::npos);
}

TEST(Humanoid, TheUserMapIsTakenAndCheckedWithTheNearestName) {
  const Character character = figure();
  Diagnostics diagnostics;
  auto humanoid = map_humanoid(character,
                               {.map = {{"hand_l", "mixamorig:LeftHandMiddle1"}},
                                .metres_per_unit = {},
                                .up_axis = {},
                                .height_m = {}},
                               diagnostics);
  ASSERT_TRUE(humanoid);
  EXPECT_EQ(node_of(character, *humanoid, Segment::hand_l), "mixamorig:LeftHandMiddle1");
  EXPECT_EQ(humanoid->segments[index(Segment::hand_l)].by, "user");
  humanoid =
      map_humanoid(character, {.map = {{"hnd_l", "x"}}, .metres_per_unit = {}, .up_axis = {}, .height_m = {}},
                   diagnostics);
  ASSERT_FALSE(humanoid);
  EXPECT_EQ(humanoid.error().kind, ErrorKind::usage);
  EXPECT_NE(humanoid.error().fix.find("'hand_l'"), std::string::npos);
  humanoid = map_humanoid(
      character,
      {.map = {{"hand_l", "mixamorig:LeftHnd"}}, .metres_per_unit = {}, .up_axis = {}, .height_m = {}},
      diagnostics);
  ASSERT_FALSE(humanoid);
  EXPECT_NE(humanoid.error().fix.find("'mixamorig:LeftHand'"), std::string::npos);
}

/// Targets whose places follow from the rotations, as a body with joints has them.
BodyPose random_targets(Random& random, const BodyPose& from, const Humanoid& humanoid) {
  BodyPose to = from;
  to[0].rotation = test::random_rotation(random, 3.0);
  to[0].translation = from[0].translation + Vec3(0.3, -0.2, 0.5);
  for (int s = 1; s < kSegmentCount; ++s) {
    const Segment segment = segment_at(s);
    const int p = index(parent_of(segment));
    const Quat relative = from[p].rotation.conjugate() * from[s].rotation;
    to[s].rotation = to[p].rotation * relative *
                     (humanoid.segments[s].fused() ? Quat::Identity() : test::random_rotation(random, 1.5));
    to[s].translation = to[p] * (from[p].inverse() * from[s].translation);
  }
  return to;
}

TEST(PoseSkeleton, ReproducesTheSegmentsItIsGiven) {
  Random random(7);
  for (const double scale : {1.0, 100.0, 0.01})
    for (const bool fused : {false, true}) {
      FigureOptions options{.armature_scale = scale, .twisted_nodes = true};
      if (fused) options.clavicles = options.hands = false;
      options.spine_bones = 2;
      const Character character = figure(options);
      const Humanoid humanoid = mapped(character);
      const BodyPose from = segments_of(character.skeleton, humanoid, humanoid.reference);
      for (int trial = 0; trial < 50; ++trial) {
        const BodyPose to = random_targets(random, from, humanoid);
        const Pose pose = pose_skeleton(character.skeleton, humanoid, humanoid.reference, from, to);
        const BodyPose back = segments_of(character.skeleton, humanoid, pose);
        for (int s = 0; s < kSegmentCount; ++s) {
          EXPECT_LT(angle_between(back[s].rotation, to[s].rotation), 1e-9) << name(segment_at(s));
          if (segment_at(s) == Segment::head)
            continue;  // two bones share the neck: the mean of their places moves
          EXPECT_LT((back[s].translation - to[s].translation).norm(), 1e-9 * humanoid.height_m)
              << name(segment_at(s));
        }
      }
    }
}

TEST(PoseSkeleton, MirroredArmaturesAreTurnedLikeOthers) {
  Random random(8);
  Character character = figure({.twisted_nodes = true});
  character.skeleton.nodes[0].rest.scale = Vec3(-1, 1, 1);  // left is right now
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  const BodyPose from = segments_of(character.skeleton, *humanoid, humanoid->reference);
  const BodyPose to = random_targets(random, from, *humanoid);
  const BodyPose back =
      segments_of(character.skeleton, *humanoid,
                  pose_skeleton(character.skeleton, *humanoid, humanoid->reference, from, to));
  for (int s = 0; s < kSegmentCount; ++s)
    EXPECT_LT(angle_between(back[s].rotation, to[s].rotation), 1e-9) << name(segment_at(s));
}

TEST(PoseSkeleton, NodesOfNoSegmentKeepTheirLocalTransform) {
  Random random(9);
  const Character character = figure();
  const Humanoid humanoid = mapped(character);
  const BodyPose from = segments_of(character.skeleton, humanoid, humanoid.reference);
  const Pose pose = pose_skeleton(character.skeleton, humanoid, humanoid.reference, from,
                                  random_targets(random, from, humanoid));
  const int finger = character.skeleton.find("mixamorig:LeftHandMiddle1");
  EXPECT_EQ(pose[finger].rotation.coeffs(), humanoid.reference[finger].rotation.coeffs());
  EXPECT_EQ(pose[finger].translation, humanoid.reference[finger].translation);
}

TEST(PoseSkeleton, DetachedFeetFollowTheirShanks) {
  Character character = figure();
  Skeleton& skeleton = character.skeleton;
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  for (const char* foot : {"mixamorig:LeftFoot", "mixamorig:RightFoot"}) {
    const int node = skeleton.find(foot);
    skeleton.nodes[node].parent = 0;
    skeleton.nodes[node].rest.translation = world[0].inverse() * world[node].translation();
  }
  ASSERT_TRUE(skeleton.sort());
  const Humanoid humanoid = mapped(character);
  EXPECT_TRUE(humanoid.segments[index(Segment::foot_l)].detached);
  EXPECT_FALSE(humanoid.segments[index(Segment::hand_l)].detached);
  Random random(10);
  const BodyPose from = segments_of(skeleton, humanoid, humanoid.reference);
  const BodyPose to = random_targets(random, from, humanoid);
  const BodyPose back =
      segments_of(skeleton, humanoid, pose_skeleton(skeleton, humanoid, humanoid.reference, from, to));
  EXPECT_LT((back[index(Segment::foot_l)].translation - to[index(Segment::foot_l)].translation).norm(), 1e-9);
  EXPECT_LT(angle_between(back[index(Segment::foot_l)].rotation, to[index(Segment::foot_l)].rotation), 1e-9);
}

}  // namespace
}  // namespace ukemi
