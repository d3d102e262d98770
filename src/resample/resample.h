// Simulated segments to joint rotations of the character's own skeleton.
#pragma once

#include "base/animation.h"
#include "base/character.h"
#include "humanoid/humanoid.h"
#include "simulate/trajectory.h"

namespace ukemi {

/// How far the clip's own forward kinematics is from the simulated segments.
struct ResampleError {
  double position_max_m = 0.0;    // joint centres, all segments
  double rotation_max_deg = 0.0;  // segments
};

/// One pose per trajectory frame. `start` and `start_segments` are the start pose and the segments it had in the
/// simulation; frame 0 is `start` exactly where the trajectory begins with it. Quaternion signs are continuous.
Clip resample(const Character& character, const Humanoid& humanoid, const Pose& start,
              const BodyPose& start_segments, const Trajectory& trajectory, ResampleError& error);

}  // namespace ukemi
