// Simulated segments to joint rotations of the character's own skeleton.
#pragma once

#include "base/animation.h"
#include "base/character.h"
#include "humanoid/humanoid.h"
#include "body/trajectory.h"

namespace ukemi {

/// How far the clip's own forward kinematics is from the simulated segments. Both are compared with their own
/// start: the rig's joint centres and last bones against what the motion of the simulated segment makes of
/// them.
struct ResampleError {
  double position_max_m = 0.0;  // centres of all joints that are one node; a bend shared by several has none
  double rotation_max_deg = 0.0;  // segments
  /// Joint centres that no segment of several bones carries: at most the sum of the joint separations on the
  /// way. Bones that share a bend of angle a, d apart, keep their length where the simulated segment turns
  /// about their mean; what they carry lies d (1 - cos(a/2)) further out.
  double position_single_bones_max_m = 0.0;
};

/// One pose per trajectory frame. `start` and `start_segments` are the start pose and the segments it had in
/// the simulation; frame 0 is `start` exactly where the trajectory begins with it. Quaternion signs are
/// continuous.
Clip resample(const Character& character, const Humanoid& humanoid, const Pose& start,
              const BodyPose& start_segments, const Trajectory& trajectory, ResampleError& error);

}  // namespace ukemi
