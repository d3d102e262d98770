// How fast the joints of a clip turn, about the axes that the active restriction acts on.
#pragma once

#include <vector>

#include "base/character.h"
#include "base/segments.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// What a person does in a frame, as far as the speeds of joints depend on it.
enum class Activity { standing, walking, other };

/// Frames are the intervals between the poses of a clip.
struct JointSpeeds {
  double fps = 0.0;
  std::vector<Activity> activity;
  /// Angular velocity of the child relative to the parent along (a_y, a_z, alpha) of the swung frame, rad/s;
  /// empty for a joint above a fused segment.
  PerJoint<std::vector<Vec3>> speeds;
  PerJoint<std::vector<bool>> glitch;  // near a jump that no joint makes
};

/// Of uniformly sampled poses; rolls fixed to the nodes from the first frame on, but the forearm takes the
/// hand's twist. `cutoff_hz` 0: not filtered.
JointSpeeds joint_speeds(const Skeleton& skeleton, const Humanoid& humanoid, const RangeOfMotion& range,
                         const Clip& clip, double cutoff_hz);

}  // namespace ukemi
