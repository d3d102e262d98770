// The part of a foot that stands on the floor.
#pragma once

#include <array>

#include "body/body.h"

namespace ukemi {

/// Corners of the sole in the foot's frame, counter-clockwise seen from below: the lower corners of the
/// foot's box, else a rectangle below its capsules. `world_from_foot`: of the foot as it stands.
std::array<Vec3, 4> sole_of(const BodySegment& foot, const Quat& world_from_foot);

}  // namespace ukemi
