#include "bones/names.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

struct Case {
  const char* name;
  Part part;
  Side side;
};

class NameOf : public ::testing::TestWithParam<Case> {};

TEST_P(NameOf, FitsItsPartBest) {
  const NameReading reading = read_name(GetParam().name);
  EXPECT_EQ(reading.side, GetParam().side) << GetParam().name;
  EXPECT_GT(fit(reading, GetParam().part), 0) << GetParam().name << " stem " << reading.stem;
}

INSTANTIATE_TEST_SUITE_P(
    Conventions, NameOf,
    ::testing::Values(
        Case{"mixamorig:LeftUpLeg", Part::thigh, Side::left},
        Case{"mixamorig1_RightArm", Part::upper_arm, Side::right}, Case{"LHipJoint", Part::thigh, Side::left},
        Case{"lhand", Part::hand, Side::left}, Case{"Lefthand", Part::hand, Side::left},
        Case{"UpperLeg.L", Part::thigh, Side::left}, Case{"Bip01 R Calf", Part::shank, Side::right},
        Case{"ValveBiped.Bip01_L_UpperArm", Part::upper_arm, Side::left},
        Case{"CC_Base_L_Thigh", Part::thigh, Side::left}, Case{"CC_Base_Hip", Part::pelvis, Side::none},
        Case{"J_Bip_C_Hips", Part::pelvis, Side::none}, Case{"J_Bip_R_LowerArm", Part::forearm, Side::right},
        Case{"DEF-upper_arm.L", Part::upper_arm, Side::left}, Case{"UpArm_L", Part::upper_arm, Side::left},
        Case{"lShldrBend", Part::upper_arm, Side::left}, Case{"rShin", Part::shank, Side::right},
        Case{"LeftUpperArmBone", Part::upper_arm, Side::left},
        Case{"HeadTop_End", Part::head_top, Side::none}, Case{"Head_end", Part::head_top, Side::none},
        Case{"upperarm_r", Part::upper_arm, Side::right}, Case{"left_collar", Part::clavicle, Side::left},
        Case{"wrist.l", Part::hand, Side::left}, Case{"Armature|LeftFoot", Part::foot, Side::left}));

TEST(Names, HelpersFitNoBone) {
  for (const char* name :
       {"ik_foot_l", "CC_Base_L_ThighTwist01", "PoleTarget.L", "LowerLeg.L_end", "hand.ik.R"})
    for (int part = 0; part < kPartCount; ++part) {
      if (static_cast<Part>(part) == Part::toe || static_cast<Part>(part) == Part::head_top) continue;
      EXPECT_EQ(fit(read_name(name), static_cast<Part>(part)), 0) << name;
    }
}

TEST(Names, TheHeadIsNotItsTop) {
  EXPECT_EQ(fit(read_name("Head"), Part::head_top), 0);
  EXPECT_EQ(fit(read_name("Head_end"), Part::head), 0);
}

TEST(Names, WordsThatOnlyBeginLikeASideHaveNone) {
  EXPECT_EQ(read_name("LowerBack").side, Side::none);
  EXPECT_EQ(read_name("root").side, Side::none);
  EXPECT_EQ(read_name("RL_BoneRoot").side, Side::none);
  EXPECT_EQ(read_name("Belly").side, Side::none);
}

}  // namespace
}  // namespace ukemi
