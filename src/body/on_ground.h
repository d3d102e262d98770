// Points and polygons on the ground, as (x, z) of the world, metres.
#pragma once

#include <vector>

#include "base/math.h"

namespace ukemi {

inline Vec2 on_ground(const Vec3& v) { return {v.x(), v.z()}; }
inline Vec3 at_height(const Vec2& p, double y) { return {p.x(), y, p.y()}; }

/// Unit vectors of a heading: yaw is the rotation about y that takes +x there.
Vec2 forward_of(double yaw);
Vec2 right_of(double yaw);
/// Yaw of a direction's ground part, rad.
double yaw_of(const Vec3& direction);
/// The angle in (-pi, pi].
double wrapped(double angle);

/// Convex hull, counter-clockwise in (x, z).
std::vector<Vec2> convex_hull(std::vector<Vec2> points);
/// The point, or the nearest one of a convex polygon.
Vec2 into(const std::vector<Vec2>& polygon, const Vec2& point);
/// Distance outside a convex polygon, less than 0 inside.
double beyond(const std::vector<Vec2>& polygon, const Vec2& point);

/// 0 at 0, 1 at 1, with no speed and no acceleration at either end; held outside.
double min_jerk(double x);

}  // namespace ukemi
