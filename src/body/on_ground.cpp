#include "body/on_ground.h"

#include <algorithm>
#include <cmath>

#include "restrict/range_of_motion.h"

namespace ukemi {

Vec2 forward_of(double yaw) { return {std::cos(yaw), -std::sin(yaw)}; }
Vec2 right_of(double yaw) { return {std::sin(yaw), std::cos(yaw)}; }
double yaw_of(const Vec3& direction) { return std::atan2(-direction.z(), direction.x()); }
double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  const auto turns_right = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 u = b - a;
    const Vec2 v = c - a;
    return u.x() * v.y() - u.y() * v.x() <= 0.0;
  };
  std::vector<Vec2> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= first + 2 && turns_right(hull[hull.size() - 2], hull.back(), *p)) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

double beyond(const std::vector<Vec2>& polygon, const Vec2& point) {
  return polygon_distance(polygon, point);
}

Vec2 into(const std::vector<Vec2>& polygon, const Vec2& point) {
  return beyond(polygon, point) <= 0.0 ? point : nearest_boundary_point(polygon, point);
}

double min_jerk(double x) {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

}  // namespace ukemi
