// Rotations about coordinate axes in any order, as BVH channels hold them.
#pragma once

#include <array>
#include <optional>

#include "base/math.h"

namespace ukemi {

/// Three different axes (0 x, 1 y, 2 z): R = R_a(angle 0) R_b(angle 1) R_c(angle 2).
using AxisOrder = std::array<int, 3>;

Quat from_euler(const Vec3& angles, const AxisOrder& order);

/// Angles in radians that give `rotation` to rounding, everywhere. Of all equivalent triples the one nearest
/// to `previous`; without a previous one, the middle angle lies within a quarter turn.
Vec3 to_euler(const Quat& rotation, const AxisOrder& order, const std::optional<Vec3>& previous);

}  // namespace ukemi
