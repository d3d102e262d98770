// What a body starts from, and what it would do unhit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "humanoid/humanoid.h"
#include "simulate/simulate.h"

namespace ukemi {

struct Start {
  std::string name;  // "stand", or the clip's name
  bool from_clip = false;
  double at_s = 0.0;  // of the clip
  Pose pose;          // the file's units, as the file places it
  /// What plays around the impact, on the character's own skeleton; `at_s` after its start_s is the impact.
  std::optional<Animation> motion;
  /// Of a motion that ends as it began and moves on (a walk cycle): from its first to its last moment, in the
  /// world, about and along the floor.
  std::optional<Rigid> round;
  BodyPose segments;   // of `pose`, canonical, world
  double floor_m = 0;  // height of the floor in the world
  StartState state;    // what the simulation is given: the same segments above a floor at y = 0
};

/// Pose `time_s` after the impact (before it where negative) of what the character does unhit: the start
/// clip, which goes round or is held before its first and after its last moment, or the still start pose.
/// File units and place, like start.pose; at 0 that very pose.
Pose unhit_pose(const Skeleton& skeleton, const Humanoid& humanoid, const Start& start, double time_s);

/// How far the start velocities of the segments' origins are from those of the start clip (central
/// differences over 1/120 s), and at the joints from those of the parent segment: at most, m/s. 0 for a still
/// pose.
double velocity_jump(const Skeleton& skeleton, const Humanoid& humanoid, const Start& start);

/// How far the lowest heel or ball of a foot is above y = 0, metres.
double height_above_floor(const Character& character, const Humanoid& humanoid, const Pose& pose);

/// Height of the floor under some poses of a clip, metres: of the lowest heel or ball, in all but the lowest
/// twentieth of the poses. Toes bend, also where a rig has none: they may dig in.
double floor_of(const Character& character, const Humanoid& humanoid, const std::vector<Pose>& poses);

/// The pose with the whole figure moved by `offset` (world, metres).
Pose moved(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose, const Vec3& offset);

}  // namespace ukemi
