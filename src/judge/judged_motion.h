// A person's motion as it is judged: segments over time, and where head, hands and feet end.
#pragma once

#include <array>
#include <vector>

#include "base/character.h"
#include "base/segments.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Points that stick out of the last segments, in the frames of these, metres. Sides: left, right.
struct BodyEnds {
  Vec3 crown = Vec3::Zero();           // of the head
  std::array<Vec3, 2> knuckle{};       // base of the middle finger; zero where the hand is fused
  std::array<Vec3, 2> ball_of_foot{};  // where the toes begin
};

/// The ends in `pose`, whose segments are `segments`: what the rig says (nodes, end sites of a BVH), else
/// common proportions.
BodyEnds body_ends(const Character& character, const Humanoid& humanoid, const Pose& pose,
                   const BodyPose& segments);

/// Contract: at least one frame; every number finite; metres, y up; frame i at i / fps.
struct JudgedMotion {
  double fps = 60.0;
  std::vector<BodyPose> frames;
  PerSegment<bool> fused{};  // their joints are not judged
  BodyEnds ends;
  double height_m = 1.75;
  double mass_kg = 73.0;
};

/// A clip of a character, with the rotations that its nodes have (segments_of). Mass: that of a man of this
/// height.
JudgedMotion judged_motion(const Character& character, const Humanoid& humanoid, const Clip& clip);

}  // namespace ukemi
