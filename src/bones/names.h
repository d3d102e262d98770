// What a node's name says about the part of the body it moves.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/segments.h"

namespace ukemi {

enum class Side { none, left, right };

/// Parts that names are matched against; limbs and fingers exist on both sides.
enum class Part {
  pelvis,
  spine,
  neck,
  head,
  head_top,
  clavicle,
  upper_arm,
  forearm,
  hand,
  finger,
  thigh,
  shank,
  foot,
  toe,
};
inline constexpr int kPartCount = 14;

/// A name taken apart: "mixamorig:LeftUpLeg" -> stem "upleg", left.
struct NameReading {
  std::string stem;  // lower case, no separators, prefix, side, number or filler words
  Side side = Side::none;
  bool helper = false;  // IK, control, twist, end and other nodes beside the bones that deform
  bool end = false;     // marks the end of a bone: "_end", "Nub", "_tip"
  int filler = 0;       // words dropped that a plain bone name lacks
  int number = -1;      // first number after the stem
};

NameReading read_name(std::string_view name);

/// How well the name fits the part, 0 (not at all) to 10. Helpers and ends fit nothing but head_top and toe.
int fit(const NameReading& reading, Part part);

/// The part and side of a VRM human bone ("leftUpperArm"); nothing for bones the body has no segment for.
struct VrmBone {
  Part part;
  Side side;
};
std::optional<VrmBone> vrm_bone(std::string_view name);

}  // namespace ukemi
