#include "base/segments.h"

#include <algorithm>
#include <string>
#include <utility>

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

/// What artists and engines call the segments; of limbs the left one.
constexpr std::pair<std::string_view, Segment> kAliases[] = {
    {"hips", Segment::pelvis},       {"hip", Segment::pelvis},          {"spine", Segment::abdomen},
    {"belly", Segment::abdomen},     {"waist", Segment::abdomen},       {"stomach", Segment::abdomen},
    {"torso", Segment::chest},       {"upperchest", Segment::chest},    {"ribs", Segment::chest},
    {"skull", Segment::head},        {"clavicle", Segment::clavicle_l}, {"shoulder", Segment::clavicle_l},
    {"collar", Segment::clavicle_l}, {"upperarm", Segment::upperarm_l}, {"lowerarm", Segment::forearm_l},
    {"forearm", Segment::forearm_l}, {"hand", Segment::hand_l},         {"upperleg", Segment::thigh_l},
    {"upleg", Segment::thigh_l},     {"thigh", Segment::thigh_l},       {"lowerleg", Segment::shank_l},
    {"calf", Segment::shank_l},      {"shin", Segment::shank_l},        {"shank", Segment::shank_l},
    {"foot", Segment::foot_l},       {"toes", Segment::foot_l},         {"toe", Segment::foot_l},
    {"ball", Segment::foot_l},       {"neck", Segment::head},           {"face", Segment::head},
    {"jaw", Segment::head},          {"gut", Segment::abdomen}};

/// Lower case letters alone: "Left Upper-Leg" -> "leftupperleg".
std::string letters_of(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    if (c >= 'A' && c <= 'Z') letters += static_cast<char>(c - 'A' + 'a');
    if (c >= 'a' && c <= 'z') letters += c;
  }
  return letters;
}

/// Takes the side off: "leftfoot" or "foot_l" (text: as it was written). Nothing where there is none.
std::optional<bool> take_side_is_left(std::string_view text, std::string& letters) {
  for (const auto& [word, left] : {std::pair(std::string_view("left"), true), {"right", false}}) {
    if (letters.starts_with(word)) return letters.erase(0, word.size()), left;
    if (letters.ends_with(word)) return letters.resize(letters.size() - word.size()), left;
  }
  if (text.size() < 3) return std::nullopt;
  const char first = text[0], last = text.back();
  const auto separates = [](char c) { return c == '_' || c == '.' || c == ' ' || c == '-'; };
  const auto is_side = [](char c) { return c == 'l' || c == 'L' || c == 'r' || c == 'R'; };
  if (is_side(last) && separates(text[text.size() - 2]))
    return letters.pop_back(), last == 'l' || last == 'L';
  if (is_side(first) && separates(text[1])) return letters.erase(0, 1), first == 'l' || first == 'L';
  return std::nullopt;
}

/// "spine_03" -> 3; 0 where there is none.
int number_in(std::string_view text) {
  int number = 0;
  for (const char c : text)
    if (c >= '0' && c <= '9') number = std::min(10 * number + (c - '0'), 99);
  return number;
}

/// "J_Bip_L_UpperArm", "mixamorig:Spine" and the like without what all bones of a rig begin with.
std::string_view without_prefix(std::string_view text) {
  for (const std::string_view prefix :
       {"J_Bip_", "mixamorig:", "mixamorig_", "mixamorig", "bip01 ", "bip001 "})
    if (text.starts_with(prefix) && text.size() > prefix.size()) {
      text.remove_prefix(prefix.size());
      return text.starts_with("C_") ? text.substr(2) : text;
    }
  return text;
}

std::optional<Segment> segment_of_alias(std::string_view written) {
  const std::string_view text = without_prefix(written);
  std::string letters = letters_of(text);
  for (int i = 0; i < kSegmentCount; ++i)
    if (name(segment_at(i)) == letters) return segment_at(i);
  if (letters == "spine" && number_in(text) >= 3) return Segment::chest;  // spine_01 to 05 of Unreal
  const auto left = take_side_is_left(text, letters);
  for (const auto& [alias, segment] : kAliases) {
    const bool has_sides = mirrored_segment(index(segment)) != index(segment);
    if (alias != letters || has_sides != left.has_value()) continue;
    return !left || *left ? segment : segment_at(mirrored_segment(index(segment)));
  }
  return std::nullopt;
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
  return segment_of_alias(text);
}

std::optional<Joint> joint_named(std::string_view text) {
  for (int i = 0; i < kJointCount; ++i)
    if (name(joint_at(i)) == text) return joint_at(i);
  return std::nullopt;
}

}  // namespace ukemi
