#include "base/segments.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Segments, GoByTheirNamesAndByThoseOfArtistsAndEngines) {
  for (int i = 0; i < kSegmentCount; ++i) EXPECT_EQ(segment_named(name(segment_at(i))), segment_at(i));
  const std::pair<const char*, Segment> kCases[] = {{"hips", Segment::pelvis},
                                                    {"Hips", Segment::pelvis},
                                                    {"torso", Segment::chest},
                                                    {"UpperChest", Segment::chest},
                                                    {"spine", Segment::abdomen},
                                                    {"left upper leg", Segment::thigh_l},
                                                    {"LeftUpperLeg", Segment::thigh_l},
                                                    {"rightLowerLeg", Segment::shank_r},
                                                    {"calf_l", Segment::shank_l},
                                                    {"lowerarm_r", Segment::forearm_r},
                                                    {"LowerArm.R", Segment::forearm_r},
                                                    {"L_Foot", Segment::foot_l},
                                                    {"leftShoulder", Segment::clavicle_l},
                                                    {"right hand", Segment::hand_r},
                                                    {"Chest", Segment::chest},
                                                    {"Neck", Segment::head},
                                                    {"gut", Segment::abdomen},
                                                    {"LeftToes", Segment::foot_l},
                                                    {"ball_r", Segment::foot_r},
                                                    {"neck_01", Segment::head},
                                                    {"spine_01", Segment::abdomen},
                                                    {"spine_03", Segment::chest},
                                                    {"J_Bip_C_Hips", Segment::pelvis},
                                                    {"J_Bip_L_UpperArm", Segment::upperarm_l},
                                                    {"mixamorig:Spine", Segment::abdomen},
                                                    {"thigh_r", Segment::thigh_r}};
  for (const auto& [text, segment] : kCases) EXPECT_EQ(segment_named(text), segment) << text;
}

TEST(Segments, OfLimbsNeedASideAndOthersHaveNone) {
  for (const char* text : {"hand", "calf", "hips_l", "left torso", "", "l", "_l", "left", "leftright hand"})
    EXPECT_FALSE(segment_named(text)) << text;
}

}  // namespace
}  // namespace ukemi
