// The mannequin as other programs and other artists would have made it: the same figure, another skeleton.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "bake/bake.h"
#include "humanoid/skin.h"
#include "load/load.h"

namespace ukemi {
namespace {

/// The mannequin taken apart: nodes by their place in the world, put together again in another way.
class Variant {
 public:
  Variant() {
    Diagnostics diagnostics;
    character =
        *load_character(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb", {}, diagnostics);
    character.animations.clear();
    world = world_transforms(character.skeleton, rest_pose(character.skeleton));
    bind = world;
  }

  int at(const std::string& name) const {
    for (int i = 0; i < character.skeleton.size(); ++i)
      if (character.skeleton.nodes[i].name == name) return i;
    ADD_FAILURE() << "no node " << name;
    return 0;
  }
  Node& node(const std::string& name) { return character.skeleton.nodes[at(name)]; }
  Vec3 place(const std::string& name) const { return world[at(name)].translation(); }

  /// A new node at a place of the world.
  int add(const std::string& name, int parent, const Vec3& where) {
    character.skeleton.nodes.push_back({name, parent, {}});
    Affine matrix = Affine::Identity();
    matrix.translation() = where;
    world.push_back(matrix);
    bind.push_back(matrix);
    return character.skeleton.size() - 1;
  }
  /// A new node half-way along the bone from `upper` to its child `lower`, between the two.
  void insert(const std::string& name, const std::string& upper, const std::string& lower,
              double share = 0.5) {
    const int added = add(name, at(upper), (1.0 - share) * place(upper) + share * place(lower));
    node(lower).parent = added;
  }
  /// Takes a node out; its children hang on its parent, its vertices follow that.
  void remove(const std::string& name) {
    const int gone = at(name);
    const int parent = character.skeleton.nodes[gone].parent;
    for (Node& other : character.skeleton.nodes)
      if (other.parent == gone) other.parent = parent;
    for (Skin& skin : character.skins)
      for (int& joint : skin.joints)
        if (joint == gone) joint = parent;
    removed.insert(gone);
  }
  /// Turns what hangs at `name` in the rest pose; the bind pose stays.
  void bend(const std::string& name, const Vec3& turn) {
    const int top = at(name);
    const Affine about =
        Eigen::Translation3d(place(name)) * exp_rotation(turn) * Eigen::Translation3d(-place(name));
    for (int i = 0; i < character.skeleton.size(); ++i)
      if (i == top || is_below(i, top)) world[i] = about * world[i];
  }
  bool is_below(int node, int top) const {
    for (node = character.skeleton.nodes[node].parent; node >= 0;
         node = character.skeleton.nodes[node].parent)
      if (node == top) return true;
    return false;
  }
  void roll_all() {
    for (std::size_t i = 0; i < world.size(); ++i) {
      const double k = static_cast<double>(i);
      const Quat roll =
          exp_rotation(Vec3(0.7 * std::sin(k), 1.1 * std::cos(2.0 * k), 2.0 * std::sin(3.0 * k)));
      world[i].linear() = world[i].linear() * roll.toRotationMatrix();
      bind[i].linear() = bind[i].linear() * roll.toRotationMatrix();
    }
  }
  /// The whole file seen through a map of space.
  void map_space(const Affine& g) {
    space = g * space;
    for (Affine& matrix : world) matrix = g * matrix;
    for (Affine& matrix : bind) matrix = g * matrix;
  }
  /// A root above everything with a transform of its own; the world stays.
  void wrap(const std::string& name, const Affine& matrix) {
    const int root = add(name, -1, Vec3::Zero());
    for (int i = 0; i < root; ++i) {
      if (character.skeleton.nodes[i].parent < 0) character.skeleton.nodes[i].parent = root;
      world[i].linear() = world[i].linear() * matrix.linear();
      bind[i].linear() = bind[i].linear() * matrix.linear();
    }
    world[root] = bind[root] = matrix;
  }
  void rename(const std::function<std::string(const std::string&)>& change) {
    for (Node& each : character.skeleton.nodes) each.name = change(each.name);
  }

  /// The file that this makes. Scales must be the same along the axes, or only at a root.
  Character finish() {
    Skeleton& skeleton = character.skeleton;
    for (const int gone : removed) skeleton.nodes[gone] = {"", -1, {}};
    EXPECT_TRUE(skeleton.sort());
    for (int i = 0; i < skeleton.size(); ++i) {
      const int parent = skeleton.nodes[i].parent;
      const Affine local = parent < 0 ? world[i] : world[parent].inverse() * world[i];
      LocalTransform& rest = skeleton.nodes[i].rest;
      rest.rotation = rotation_part(local.linear());
      rest.scale = (rest.rotation.conjugate().toRotationMatrix() * local.linear()).diagonal();
      rest.translation = local.translation();
    }
    for (Skin& skin : character.skins)
      for (std::size_t j = 0; j < skin.joints.size(); ++j)
        skin.inverse_bind[j] = bind[skin.joints[j]].inverse() * space;
    return character;
  }

  Character character;
  std::vector<Affine> world, bind;
  std::set<int> removed;
  Affine space = Affine::Identity();
};

const std::map<std::string, Segment> kSegmentOfName = {{"Hips", Segment::pelvis},
                                                       {"Head", Segment::head},
                                                       {"LeftArm", Segment::upperarm_l},
                                                       {"LeftForeArm", Segment::forearm_l},
                                                       {"LeftHand", Segment::hand_l},
                                                       {"RightArm", Segment::upperarm_r},
                                                       {"RightForeArm", Segment::forearm_r},
                                                       {"RightHand", Segment::hand_r},
                                                       {"LeftUpLeg", Segment::thigh_l},
                                                       {"LeftLeg", Segment::shank_l},
                                                       {"LeftFoot", Segment::foot_l},
                                                       {"RightUpLeg", Segment::thigh_r},
                                                       {"RightLeg", Segment::shank_r},
                                                       {"RightFoot", Segment::foot_r}};

/// The segments found on the nodes that the mannequin has for them, whatever they are called now.
void expect_same_bones(const Humanoid& humanoid, const std::map<std::string, int>& original, bool mirrored) {
  for (const auto& [bone, segment] : kSegmentOfName) {
    const Segment expected = mirrored ? mirror_of(segment) : segment;
    const int found = humanoid.segments[index(expected)].node();
    const bool may_be_fused = expected == Segment::hand_l || expected == Segment::hand_r;
    EXPECT_TRUE(found == original.at(bone) || (found < 0 && may_be_fused))
        << name(expected) << " is node " << found;
  }
}

/// Maps, stands and bakes as the mannequin does.
void expect_human(const std::string& what, Variant variant, double height_m = 1.78, bool mirrored = false) {
  SCOPED_TRACE(what);
  static const std::map<std::string, int> original = [] {
    const Variant mannequin;
    std::map<std::string, int> nodes;
    for (const auto& [bone, segment] : kSegmentOfName) nodes[bone] = mannequin.at(bone);
    return nodes;
  }();
  const Character character = variant.finish();
  BakeSettings settings;
  settings.simulation.duration_s = 0.6;
  Diagnostics diagnostics;
  const auto outcome = bake(character, settings, diagnostics);
  ASSERT_TRUE(outcome) << outcome.error().message();
  expect_same_bones(outcome->prepared.humanoid, original, mirrored);
  EXPECT_NEAR(outcome->prepared.humanoid.height_m, height_m, 0.02 * height_m);
  EXPECT_EQ(outcome->limits.over_1deg, 0);
  EXPECT_LT(outcome->figures.joint_separation_max_m, 0.01);
  const BodyPose& body = outcome->prepared.start.segments;
  const auto place = [&](Segment s) { return body[index(s)].translation; };
  const auto high = [&](Segment s) { return place(s).y() / outcome->prepared.humanoid.height_m; };
  EXPECT_NEAR(high(Segment::head), 0.87, 0.05);
  EXPECT_NEAR(high(Segment::forearm_l), 0.62, 0.06);
  for (const Segment foot : {Segment::foot_l, Segment::foot_r}) EXPECT_NEAR(high(foot), 0.04, 0.03);
  const Vec3 right = body[index(Segment::pelvis)].rotation * Vec3::UnitZ();
  EXPECT_GT((place(Segment::hand_r) - place(Segment::hand_l)).dot(right),
            0.15 * outcome->prepared.humanoid.height_m);
  EXPECT_GT((place(Segment::foot_r) - place(Segment::foot_l)).dot(right),
            0.05 * outcome->prepared.humanoid.height_m);
  const Vec3 forward = body[index(Segment::pelvis)].rotation * Vec3::UnitX();
  for (const int s :
       {index(Segment::chest), index(Segment::head), index(Segment::foot_l), index(Segment::foot_r)})
    EXPECT_GT((body[s].rotation * Vec3::UnitX()).dot(forward), 0.9)
        << "faces forward: " << name(segment_at(s));
}

Affine scaled(const Vec3& by) { return Affine(Eigen::Scaling(by)); }
Affine turned(double degrees_, const Vec3& axis) { return Affine(exp_rotation(radians(degrees_) * axis)); }

TEST(Variant, OfUnitsAndAxes) {
  expect_human("as it is", {});
  for (const double unit : {100.0, 1.0 / 0.0254, 1000.0, 10.0}) {
    Variant v;
    v.map_space(scaled(Vec3::Constant(unit)));
    expect_human(fmt::format("{} units per metre", unit), v);
  }
  const std::pair<const char*, Affine> turns[] = {
      {"z up", turned(90, Vec3::UnitX())},
      {"z up, facing x", turned(90, Vec3::UnitX()) * turned(90, Vec3::UnitY())},
      {"facing -z", turned(180, Vec3::UnitY())},
      {"facing -x", turned(-90, Vec3::UnitY())}};
  for (const auto& [what, turn] : turns) {
    Variant v;
    v.map_space(turn);
    expect_human(what, v);
    v.map_space(scaled(Vec3::Constant(100.0)));
    v.roll_all();
    expect_human(std::string(what) + ", centimetres, rolled nodes", v);
  }
}

TEST(Variant, OfTransformsAboveTheFigure) {
  for (const double scale : {100.0, 0.01}) {
    Variant v;
    v.wrap("Armature", turned(-90, Vec3::UnitX()) * scaled(Vec3::Constant(scale)));
    expect_human(fmt::format("armature of scale {}", scale), v);
  }
  Variant leaning;
  leaning.wrap("Armature", turned(35, Vec3(1, 2, 3).normalized()));
  leaning.roll_all();
  expect_human("armature with a rotation", leaning);
  Variant stretched;
  stretched.map_space(scaled(Vec3(1.1, 1.0, 0.9)));
  expect_human("stretched", stretched);
  Variant mirrored;
  mirrored.map_space(scaled(Vec3(-1, 1, 1)));
  expect_human("mirrored", mirrored, 1.78, true);
}

TEST(Variant, OfRestPoses) {
  Variant a_pose;
  for (const double side : {1.0, -1.0})
    a_pose.bend(side > 0 ? "LeftArm" : "RightArm", Vec3(0, 0, -side * radians(45)));
  expect_human("A-pose at rest, T-pose bound", a_pose);
  Variant crouch;
  crouch.bend("Hips", Vec3(radians(20), 0, 0));
  for (const char* thigh : {"LeftUpLeg", "RightUpLeg"}) crouch.bend(thigh, Vec3(-radians(90), 0, 0));
  for (const char* shank : {"LeftLeg", "RightLeg"}) crouch.bend(shank, Vec3(radians(100), 0, 0));
  expect_human("crouching at rest, T-pose bound", crouch);
}

TEST(Variant, OfSpinesAndNecks) {
  Variant one;
  one.remove("Spine1");
  one.remove("Spine2");
  expect_human("one spine bone", one);
  Variant two;
  two.remove("Spine1");
  expect_human("two spine bones", two);
  Variant six;
  six.insert("Spine0a", "Spine", "Spine1");
  six.insert("Spine1a", "Spine1", "Spine2");
  six.insert("SpineTop", "Spine2", "Neck", 0.4);
  expect_human("six spine bones", six);
  Variant no_neck;
  no_neck.remove("Neck");
  expect_human("no neck", no_neck);
  Variant necks;
  necks.insert("Neck1", "Neck", "Head", 0.3);
  necks.insert("Neck2", "Neck1", "Head", 0.5);
  expect_human("three neck bones", necks);
}

TEST(Variant, OfMissingBones) {
  Variant shoulders;
  for (const char* name : {"LeftShoulder", "RightShoulder"}) shoulders.remove(name);
  expect_human("no clavicles", shoulders);
  Variant simple;
  for (const char* side : {"Left", "Right"}) {
    for (const char* finger : {"Thumb1", "Index1", "Middle1", "Ring1", "Pinky1"})
      simple.remove(std::string(side) + "Hand" + finger);
    for (const char* toe : {"Toe_End", "ToeBase"}) simple.remove(std::string(side) + toe);
  }
  simple.remove("HeadTop_End");
  expect_human("neither fingers nor toes", simple);
}

/// Twist bones beside and in the limbs.
Variant with_twists() {
  Variant v;
  for (const std::string side : {"Left", "Right"}) {
    for (const char* upper : {"Arm", "ForeArm", "UpLeg", "Leg"}) {
      const std::string lower = upper == std::string("Arm")       ? "ForeArm"
                                : upper == std::string("ForeArm") ? "Hand"
                                : upper == std::string("UpLeg")   ? "Leg"
                                                                  : "Foot";
      const Vec3 a = v.place(side + upper), b = v.place(side + lower);
      v.add(side + upper + "Twist", v.at(side + upper), 0.5 * (a + b));
      v.add(side + upper + "Twist1", v.at(side + upper), 0.8 * b + 0.2 * a);
    }
  }
  return v;
}

// A forearm that turns by 80 degrees about itself: the skin half-way along it turns by 40, that at the wrist
// by nearly all; a bend moves them all alike.
TEST(Variant, TwistBonesTakeTheirShareOfTheTwist) {
  Variant variant = with_twists();
  const Character character = variant.finish();
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid) << humanoid.error().message();
  ASSERT_EQ(humanoid->twist_bones.size(), 16u);
  const Skeleton& skeleton = character.skeleton;
  const Pose base = rest_pose(skeleton);
  const BodyPose from = segments_of(skeleton, *humanoid, base);
  constexpr int fore = index(Segment::forearm_l), hand = index(Segment::hand_l);
  const Vec3 limb = (from[hand].translation - from[fore].translation).normalized();
  for (const Quat& bend : {Quat::Identity(), exp_rotation(1.2 * limb.unitOrthogonal())}) {
    BodyPose to = from;
    to[fore].rotation = bend * exp_rotation(radians(80.0) * limb) * from[fore].rotation;
    to[hand].rotation = bend * exp_rotation(radians(80.0) * limb) * from[hand].rotation;
    const Pose pose = pose_skeleton(skeleton, *humanoid, base, from, to);
    const auto before = world_transforms(skeleton, base), after = world_transforms(skeleton, pose);
    const auto off = [&](const char* name, double turned_deg) {
      const int node = skeleton.find(name);
      const Quat turn(rotation_part(after[node].linear() * before[node].linear().inverse()));
      return degrees(angle_between(turn, bend * exp_rotation(radians(turned_deg) * limb)));
    };
    EXPECT_LT(off("LeftForeArm", 80.0), 1e-6);
    EXPECT_LT(off("LeftForeArmTwist", 40.0), 0.1);
    EXPECT_LT(off("LeftForeArmTwist1", 64.0), 0.1);
    EXPECT_LT(off("LeftHand", 80.0), 1e-6);
  }
}

TEST(Variant, OfHelpersAndTwins) {
  expect_human("twist bones", with_twists());
  Variant inline_roll;
  for (const std::string side : {"Left", "Right"}) {
    inline_roll.insert(side + "ArmRoll", side + "Arm", side + "ForeArm");
    inline_roll.insert(side + "ForeArmRoll", side + "ForeArm", side + "Hand");
  }
  expect_human("roll bones in the limbs", inline_roll);
  Variant controls;
  const int bones = controls.character.skeleton.size();
  std::map<int, int> twin;
  for (const int i : Variant().character.skeleton.order) {
    const Node bone = controls.character.skeleton.nodes[i];
    if (i >= bones || bone.name == "Mannequin") continue;
    twin[i] = controls.add("CTRL_" + bone.name, bone.parent < 0 ? -1 : twin.at(bone.parent),
                           controls.place(bone.name));
  }
  expect_human("control bones as a twin hierarchy", controls);
  Variant ik;
  const int root = ik.add("Root", -1, Vec3::Zero());
  ik.node("Hips").parent = root;
  for (const std::string side : {"Left", "Right"}) {
    ik.add("IK_" + side + "Hand", root, ik.place(side + "Hand"));
    ik.add(side + "Foot_IK", root, ik.place(side + "Foot"));
    ik.add(side + "KneePole", root, ik.place(side + "Leg") + Vec3(0, 0, 0.5));
    ik.add(side + "ElbowTarget", root, ik.place(side + "ForeArm") - Vec3(0, 0, 0.5));
  }
  expect_human("a root and IK helpers", ik);
}

TEST(Variant, OfExtraLimbs) {
  Variant beast;
  int tail = beast.at("Hips");
  for (int i = 0; i < 5; ++i)
    tail = beast.add(fmt::format("Tail{}", i), tail, beast.place("Hips") + Vec3(0, 0, -0.12 * (i + 1)));
  for (const double side : {1.0, -1.0}) {
    int wing = beast.at("Spine2");
    for (int i = 0; i < 4; ++i)
      wing = beast.add(fmt::format("{}Wing{}", side > 0 ? "Left" : "Right", i), wing,
                       beast.place("Spine2") + Vec3(side * 0.35 * (i + 1), 0.1 * (i + 1), -0.1));
  }
  const int hand = beast.at("RightHand");
  beast.add("Sword", hand, beast.place("RightHand") + Vec3(0, -0.05, 0.1));
  beast.add("Sword_tip", beast.at("Sword"), beast.place("RightHand") + Vec3(0, -0.05, 1.0));
  expect_human("tail, wings and a sword", beast);
}

TEST(Variant, OfWideBodiesHoldTheirArmsBesideTheTrunk) {
  const auto hands_apart = [](double width) {
    Variant v;
    const auto segments = segments_of_nodes(v.character.skeleton, [&] {
      Diagnostics diagnostics;
      return *map_humanoid(v.character, {}, diagnostics);
    }());
    for (MeshPart& part : v.character.parts)
      for (std::size_t i = 0; i < part.positions.size(); ++i) {
        const int joint = v.character.skins[part.skin].joints[part.joints[i][0]];
        const auto s = segments[joint];
        if (s == Segment::abdomen || s == Segment::pelvis || s == Segment::chest)
          part.positions[i].x() *= static_cast<float>(width);
      }
    const Character character = v.finish();
    Diagnostics diagnostics;
    const Humanoid humanoid = *map_humanoid(character, {}, diagnostics);
    const BodyPose body =
        segments_of(character.skeleton, humanoid, start_pose(character, humanoid, StartPose::stand));
    const Vec3 apart = body[index(Segment::hand_l)].translation - body[index(Segment::hand_r)].translation;
    return apart.norm();
  };
  const double slim_m = hands_apart(1.0);
  EXPECT_LT(slim_m, 0.6);
  EXPECT_EQ(hands_apart(1.2), slim_m) << "there is room";
  EXPECT_GT(hands_apart(2.2), slim_m + 0.1);
}

TEST(Variant, WithoutNames) {
  const auto nameless = [](Variant v) {
    v.rename([](const std::string&) { return std::string(); });
    return v;
  };
  expect_human("no names", nameless({}));
  expect_human("no names, twist bones", nameless(with_twists()));
  Variant rolled;
  rolled.map_space(turned(90, Vec3::UnitX()) * scaled(Vec3::Constant(100.0)));
  rolled.roll_all();
  expect_human("no names, z up, centimetres, rolled", nameless(rolled));
  Variant numbered;
  int count = 0;
  numbered.rename([&](const std::string&) { return fmt::format("Bone.{:03}", count++); });
  expect_human("numbers for names", numbered);
}

TEST(Variant, LeftCalledRightKeepsItsNamesWithAWarning) {
  Variant swapped;
  swapped.rename([](const std::string& name) {
    if (name.starts_with("Left")) return "Right" + name.substr(4);
    return name.starts_with("Right") ? "Left" + name.substr(5) : name;
  });
  const Character character = swapped.finish();
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  EXPECT_EQ(character.skeleton.nodes[humanoid->carrier_node(Segment::hand_l)].name, "LeftHand");
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("the feet point backwards"), std::string::npos);
}

TEST(Variant, OfMisleadingNames) {
  Variant limbs;
  limbs.rename([](const std::string& name) {
    static const std::map<std::string, std::string> other = {{"Arm", "UpLeg"},   {"ForeArm", "Leg"},
                                                             {"Hand", "Foot"},   {"UpLeg", "Arm"},
                                                             {"Leg", "ForeArm"}, {"Foot", "Hand"}};
    for (const std::string side : {"Left", "Right"})
      if (name.starts_with(side))
        if (const auto found = other.find(name.substr(side.size())); found != other.end())
          return side + found->second;
    return name;
  });
  expect_human("arms called legs", limbs);
}

}  // namespace
}  // namespace ukemi
