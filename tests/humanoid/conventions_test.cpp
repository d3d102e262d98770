// The same figure under the names that other programs give its bones.
#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

using testing::figure;

/// Names of pelvis, lowest spine bone, neck, head and of the left limbs; the right ones are the left with the
/// side exchanged.
struct Convention {
  const char* name;
  std::array<const char*, 4> trunk;  // pelvis, spine, neck, head
  std::array<const char*, 5> arm;    // clavicle, upper arm, forearm, hand, middle finger
  std::array<const char*, 4> leg;    // thigh, shank, foot, toe
  const char* left;
  const char* right;
  const char* head_top = "HeadTop_End";
};

void PrintTo(const Convention& convention, std::ostream* out) { *out << convention.name; }

const Convention kConventions[] = {
    {"Unreal",
     {"pelvis", "spine_01", "neck_01", "head"},
     {"clavicle_l", "upperarm_l", "lowerarm_l", "hand_l", "middle_01_l"},
     {"thigh_l", "calf_l", "foot_l", "ball_l"},
     "_l",
     "_r"},
    {"Unity",
     {"Hips", "Spine", "Neck", "Head"},
     {"LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand", "Left Middle Proximal"},
     {"LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes"},
     "Left",
     "Right"},
    {"Mixamo, second copy",
     {"mixamorig1:Hips", "mixamorig1:Spine", "mixamorig1:Neck", "mixamorig1:Head"},
     {"mixamorig1:LeftShoulder", "mixamorig1:LeftArm", "mixamorig1:LeftForeArm", "mixamorig1:LeftHand",
      "mixamorig1:LeftHandMiddle1"},
     {"mixamorig1:LeftUpLeg", "mixamorig1:LeftLeg", "mixamorig1:LeftFoot", "mixamorig1:LeftToeBase"},
     "Left",
     "Right"},
    {"Blender metarig",
     {"spine", "spine.001", "spine.004", "spine.006"},
     {"shoulder.L", "upper_arm.L", "forearm.L", "hand.L", "f_middle.01.L"},
     {"thigh.L", "shin.L", "foot.L", "toe.L"},
     ".L",
     ".R",
     "spine.006_end"},
    {"Rigify deform bones",
     {"DEF-spine", "DEF-spine.001", "DEF-spine.004", "DEF-spine.006"},
     {"DEF-shoulder.L", "DEF-upper_arm.L", "DEF-forearm.L", "DEF-hand.L", "DEF-f_middle.01.L"},
     {"DEF-thigh.L", "DEF-shin.L", "DEF-foot.L", "DEF-toe.L"},
     ".L",
     ".R",
     "DEF-spine.006_end"},
    {"3ds Max Biped",
     {"Bip01 Pelvis", "Bip01 Spine", "Bip01 Neck", "Bip01 Head"},
     {"Bip01 L Clavicle", "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand", "Bip01 L Finger2"},
     {"Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot", "Bip01 L Toe0"},
     " L ",
     " R ",
     "Bip01 HeadNub"},
    {"ValveBiped",
     {"ValveBiped.Bip01_Pelvis", "ValveBiped.Bip01_Spine", "ValveBiped.Bip01_Neck1",
      "ValveBiped.Bip01_Head1"},
     {"ValveBiped.Bip01_L_Clavicle", "ValveBiped.Bip01_L_UpperArm", "ValveBiped.Bip01_L_Forearm",
      "ValveBiped.Bip01_L_Hand", "ValveBiped.Bip01_L_Finger2"},
     {"ValveBiped.Bip01_L_Thigh", "ValveBiped.Bip01_L_Calf", "ValveBiped.Bip01_L_Foot",
      "ValveBiped.Bip01_L_Toe0"},
     "_L_",
     "_R_"},
    {"Daz Genesis",
     {"pelvis", "abdomenLower", "neckLower", "head"},
     {"lCollar", "lShldrBend", "lForearmBend", "lHand", "lMid1"},
     {"lThighBend", "lShin", "lFoot", "lToe"},
     "l",
     "r"},
    {"Daz Genesis 9",
     {"pelvis", "spine1", "neck1", "head"},
     {"l_shoulder", "l_upperarm", "l_forearm", "l_hand", "l_mid1"},
     {"l_thigh", "l_shin", "l_foot", "l_toes"},
     "l_",
     "r_"},
    {"Poser",
     {"Hip", "Abdomen", "Neck", "Head"},
     {"Left Collar", "Left Shoulder", "Left Forearm", "Left Hand", "Left Mid 1"},
     {"Left Thigh", "Left Shin", "Left Foot", "Left Toe"},
     "Left",
     "Right"},
    {"SMPL",
     {"Pelvis", "Spine1", "Neck", "Head"},
     {"L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist", "L_Hand"},
     {"L_Hip", "L_Knee", "L_Ankle", "L_Foot"},
     "L_",
     "R_"},
    {"SMPL-X",
     {"pelvis", "spine1", "neck", "head"},
     {"left_collar", "left_shoulder", "left_elbow", "left_wrist", "left_middle1"},
     {"left_hip", "left_knee", "left_ankle", "left_foot"},
     "left",
     "right"},
    {"VRoid",
     {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Neck", "J_Bip_C_Head"},
     {"J_Bip_L_Shoulder", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand", "J_Bip_L_Middle1"},
     {"J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot", "J_Bip_L_ToeBase"},
     "_L_",
     "_R_"},
    {"Character Creator",
     {"CC_Base_Pelvis", "CC_Base_Waist", "CC_Base_NeckTwist01", "CC_Base_Head"},
     {"CC_Base_L_Clavicle", "CC_Base_L_Upperarm", "CC_Base_L_Forearm", "CC_Base_L_Hand", "CC_Base_L_Mid1"},
     {"CC_Base_L_Thigh", "CC_Base_L_Calf", "CC_Base_L_Foot", "CC_Base_L_ToeBase"},
     "_L_",
     "_R_"},
    {"Rokoko",
     {"Hips", "Spine", "Neck", "Head"},
     {"LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "LeftFinger3Proximal"},
     {"LeftThigh", "LeftShin", "LeftFoot", "LeftToe"},
     "Left",
     "Right"},
    {"Xsens",
     {"Pelvis", "L5", "Neck", "Head"},
     {"LeftShoulder", "LeftUpperArm", "LeftForeArm", "LeftHand", "LeftThirdMC"},
     {"LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToe"},
     "Left",
     "Right"},
    {"OptiTrack",
     {"Hip", "Ab", "Neck", "Head"},
     {"LShoulder", "LUArm", "LFArm", "LHand", "LMiddle1"},
     {"LThigh", "LShin", "LFoot", "LToe"},
     "L",
     "R"},
    {"MakeHuman default",
     {"root", "spine05", "neck01", "head"},
     {"clavicle.L", "upperarm01.L", "lowerarm01.L", "wrist.L", "finger3-1.L"},
     {"upperleg01.L", "lowerleg01.L", "foot.L", "toe1-1.L"},
     ".L",
     ".R"},
    {"Kinect-like",
     {"SpineBase", "SpineMid", "Neck", "Head"},
     {"ClavicleLeft", "ShoulderLeft", "ElbowLeft", "WristLeft", "HandTipLeft"},
     {"HipLeft", "KneeLeft", "AnkleLeft", "FootLeft"},
     "Left",
     "Right"},
    {"Maya HumanIK joints",
     {"Character1_Hips", "Character1_Spine", "Character1_Neck", "Character1_Head"},
     {"Character1_LeftShoulder", "Character1_LeftArm", "Character1_LeftForeArm", "Character1_LeftHand",
      "Character1_LeftHandMiddle1"},
     {"Character1_LeftUpLeg", "Character1_LeftLeg", "Character1_LeftFoot", "Character1_LeftToeBase"},
     "Left",
     "Right"},
    {"Studio joints",
     {"jnt_c_pelvis", "jnt_c_spine_01", "jnt_c_neck", "jnt_c_head"},
     {"jnt_l_clavicle", "jnt_l_upperArm", "jnt_l_elbow", "jnt_l_wrist", "jnt_l_middle_01"},
     {"jnt_l_hip", "jnt_l_knee", "jnt_l_ankle", "jnt_l_ball"},
     "_l_",
     "_r_"},
};

std::string other_side(std::string name, const Convention& convention) {
  const std::string left = convention.left;
  const auto at = name.find(left);
  name.replace(at, left.size(), convention.right);
  return name;
}

/// Index of each renamed bone by the name it had.
Character renamed(const Convention& convention) {
  Character character = figure();
  std::map<std::string, std::string> names;
  const auto add = [&](const std::string& bone, const char* name) {
    names["mixamorig:Left" + bone] = name;
    names["mixamorig:Right" + bone] = other_side(name, convention);
  };
  const char* const trunk[] = {"Hips", "Spine", "Neck", "Head"};
  for (int i = 0; i < 4; ++i) names[std::string("mixamorig:") + trunk[i]] = convention.trunk[i];
  const char* const arm[] = {"Shoulder", "Arm", "ForeArm", "Hand", "HandMiddle1"};
  for (int i = 0; i < 5; ++i) add(arm[i], convention.arm[i]);
  const char* const leg[] = {"UpLeg", "Leg", "Foot", "ToeBase"};
  for (int i = 0; i < 4; ++i) add(leg[i], convention.leg[i]);
  names["mixamorig:Spine1"] = "b2";
  names["mixamorig:Spine2"] = "b3";
  names["mixamorig:HeadTop_End"] = convention.head_top;
  for (Node& node : character.skeleton.nodes)
    if (names.contains(node.name)) node.name = names[node.name];
  return character;
}

class NamingConvention : public ::testing::TestWithParam<Convention> {};

TEST_P(NamingConvention, MapsLikeTheFigureItself) {
  Diagnostics diagnostics;
  const auto expected = map_humanoid(figure(), {}, diagnostics);
  const Character character = renamed(GetParam());
  const auto found = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().what;
  for (int s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(found->segments[s].chain, expected->segments[s].chain) << name(segment_at(s));
    const bool is_limb = segment_at(s) >= Segment::clavicle_l;
    EXPECT_EQ(is_limb ? found->segments[s].by : "name", "name") << name(segment_at(s));
  }
  EXPECT_EQ(found->toes, expected->toes);
}

INSTANTIATE_TEST_SUITE_P(Names, NamingConvention, ::testing::ValuesIn(kConventions));

}  // namespace
}  // namespace ukemi
