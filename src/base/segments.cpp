#include "base/segments.h"

namespace ukemi {
namespace {

constexpr PerSegment<std::string_view> kSegmentNames = {
    "pelvis",    "abdomen", "chest",      "head",       "clavicle_l", "upperarm_l",
    "forearm_l", "hand_l",  "clavicle_r", "upperarm_r", "forearm_r",  "hand_r",
    "thigh_l",   "shank_l", "foot_l",     "thigh_r",    "shank_r",    "foot_r"};
constexpr PerJoint<std::string_view> kJointNames = {
    "spine",   "chest",      "neck",       "clavicle_l", "shoulder_l", "elbow_l",
    "wrist_l", "clavicle_r", "shoulder_r", "elbow_r",    "wrist_r",    "hip_l",
    "knee_l",  "ankle_l",    "hip_r",      "knee_r",     "ankle_r"};
constexpr PerSegment<int> kParents = {0, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 0, 15, 16};

int mirrored_segment(int s) {
  if (s >= 4 && s <= 7) return s + 4;
  if (s >= 8 && s <= 11) return s - 4;
  if (s >= 12 && s <= 14) return s + 3;
  if (s >= 15 && s <= 17) return s - 3;
  return s;
}

}  // namespace

Segment parent_of(Segment s) { return segment_at(kParents[index(s)]); }
Segment mirror_of(Segment s) { return segment_at(mirrored_segment(index(s))); }
Joint mirror_of(Joint j) { return joint_at(mirrored_segment(index(j) + 1) - 1); }

std::string_view name(Segment s) { return kSegmentNames[index(s)]; }
std::string_view name(Joint j) { return kJointNames[index(j)]; }

std::optional<Segment> segment_named(std::string_view text) {
  for (int i = 0; i < kSegmentCount; ++i)
    if (name(segment_at(i)) == text) return segment_at(i);
  return std::nullopt;
}

std::optional<Joint> joint_named(std::string_view text) {
  for (int i = 0; i < kJointCount; ++i)
    if (name(joint_at(i)) == text) return joint_at(i);
  return std::nullopt;
}

}  // namespace ukemi
