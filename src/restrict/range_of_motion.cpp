#include "restrict/range_of_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ukemi {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 nearest_on_edge(const Vec2& a, const Vec2& b, const Vec2& point) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return a + t * along;
}

bool contains(const std::vector<Vec2>& polygon, const Vec2& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
  }
  return inside;
}

/// Counter-clockwise, without collinear points (Andrew's monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& point, std::size_t keep) {
    while (hull.size() > keep && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const Vec2& point : points) add(point, 1);
  const std::size_t lower = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

/// theta cot(theta), 1 at 0.
double theta_cot(double theta) { return theta < 1e-4 ? 1.0 - theta * theta / 3.0 : theta / std::tan(theta); }

}  // namespace

SwingTwist swing_twist(const Quat& q) {
  const double c = std::hypot(q.w(), q.x());
  SwingTwist chart;
  if (c < 1e-12) {
    chart.swing = Vec2(kPi, 0.0);
    return chart;
  }
  chart.twist = 2.0 * std::atan2(q.x(), q.w());
  if (chart.twist > kPi) chart.twist -= 2.0 * kPi;
  if (chart.twist <= -kPi) chart.twist += 2.0 * kPi;
  const Vec2 half((q.w() * q.y() - q.x() * q.z()) / c, (q.w() * q.z() + q.x() * q.y()) / c);
  const double s = half.norm();
  chart.swing = half * (s < 1e-12 ? 2.0 : 2.0 * std::atan2(s, c) / s);
  return chart;
}

Quat joint_rotation(const SwingTwist& chart) {
  return exp_rotation(Vec3(0.0, chart.swing.x(), chart.swing.y())) *
         exp_rotation(Vec3(chart.twist, 0.0, 0.0));
}

// With n = a / theta and t = e_x x n: row = u_n n + u_t theta (cot(theta) t + e_x).
Vec3 swing_row(const SwingTwist& chart, const Vec2& u) {
  const double theta = chart.swing.norm();
  if (theta < 1e-9) return {0.0, u.x(), u.y()};
  const Vec2 n = chart.swing / theta;
  const Vec2 t(-n.y(), n.x());
  const double along = u.dot(n);
  const double across = u.dot(t);
  const Vec2 in_plane = along * n + across * theta_cot(theta) * t;
  return {across * theta, in_plane.x(), in_plane.y()};
}

// (e_x + d) / (1 + d_x), with d the link direction.
Vec3 twist_row(const SwingTwist& chart) {
  const double theta = chart.swing.norm();
  if (theta < 1e-9) return Vec3::UnitX();
  const double k = std::tan(0.5 * theta) / theta;
  return {1.0, k * chart.swing.y(), -k * chart.swing.x()};
}

// parent_from_child = C Q C^T R0, with C the joint's axes and R0 the reference rotation.
Quat JointFrame::joint_from_relative(const Quat& parent_from_child) const {
  return (parent_from_joint.conjugate() * parent_from_child * reference.conjugate() * parent_from_joint)
      .normalized();
}

Quat JointFrame::relative_from_joint(const Quat& joint) const {
  return (parent_from_joint * joint * parent_from_joint.conjugate() * reference).normalized();
}

Vec2 nearest_boundary_point(const std::vector<Vec2>& polygon, const Vec2& point) {
  Vec2 best = polygon.front();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 candidate = nearest_on_edge(polygon[i], polygon[(i + 1) % polygon.size()], point);
    if ((candidate - point).squaredNorm() < (best - point).squaredNorm()) best = candidate;
  }
  return best;
}

double polygon_distance(const std::vector<Vec2>& polygon, const Vec2& point) {
  const double distance = (nearest_boundary_point(polygon, point) - point).norm();
  return contains(polygon, point) ? -distance : distance;
}

double polygon_area(const std::vector<Vec2>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

double excess(const JointRange& range, const SwingTwist& chart) {
  const double twist = std::max(range.twist_min - chart.twist, chart.twist - range.twist_max);
  return std::max({0.0, twist, polygon_distance(range.polygon, chart.swing)});
}

SwingTwist clamp_to_range(const JointRange& range, const SwingTwist& chart) {
  SwingTwist inside = chart;
  inside.twist = std::clamp(chart.twist, range.twist_min, range.twist_max);
  if (!contains(range.polygon, chart.swing))
    inside.swing = nearest_boundary_point(range.polygon, chart.swing);
  return inside;
}

double widen_to_hold(JointRange& range, const SwingTwist& chart, double margin) {
  double widened = 0.0;
  const auto stretch = [&](double& limit, double value) {
    widened = std::max(widened, std::abs(value - limit));
    limit = value;
  };
  if (chart.twist + margin > range.twist_max) stretch(range.twist_max, chart.twist + margin);
  if (chart.twist - margin < range.twist_min) stretch(range.twist_min, chart.twist - margin);
  const double distance = polygon_distance(range.polygon, chart.swing);
  if (distance <= -margin) return widened;

  std::vector<Vec2> corners = range.polygon;
  const double radius = margin / std::cos(kPi / 8.0);
  for (int i = 0; i < 8; ++i) {
    const double angle = kPi * (2.0 * i + 1.0) / 8.0;
    corners.push_back(chart.swing + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  range.polygon = convex_hull(std::move(corners));
  return std::max(widened, distance + margin);
}

PerJoint<SwingTwist> charts_of(const RangeOfMotion& range, const PerSegment<Quat>& world_from_segment) {
  PerJoint<SwingTwist> charts;
  for (int j = 0; j < kJointCount; ++j) {
    const Joint joint = joint_at(j);
    const Quat relative =
        world_from_segment[index(parent_of(joint))].conjugate() * world_from_segment[index(child_of(joint))];
    charts[j] = swing_twist(range.joints[j].frame.joint_from_relative(relative));
  }
  return charts;
}

}  // namespace ukemi
