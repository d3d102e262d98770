// Rotations alone of the segments of a pose, as the ranges of motion take them.
#pragma once

#include "humanoid/humanoid.h"

namespace ukemi {

/// World rotation of every segment's anatomical frame.
inline PerSegment<Quat> rotations_of(const BodyPose& body) {
  PerSegment<Quat> rotations;
  for (int s = 0; s < kSegmentCount; ++s) rotations[s] = body[s].rotation;
  return rotations;
}

}  // namespace ukemi
