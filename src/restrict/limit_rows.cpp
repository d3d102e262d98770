#include "restrict/limit_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ukemi {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

struct EdgeView {
  Vec2 from, to, outward;
  double signed_distance;  // of the line, positive inside
  double along;            // where the point projects, in edge lengths
};

EdgeView look_at_edge(const std::vector<Vec2>& polygon, std::size_t i, const Vec2& point) {
  EdgeView view;
  view.from = polygon[i];
  view.to = polygon[(i + 1) % polygon.size()];
  const Vec2 edge = view.to - view.from;
  const double length = edge.norm();
  view.outward = Vec2(edge.y(), -edge.x()) / length;
  view.signed_distance = view.outward.dot(view.from - point);
  view.along = edge.dot(point - view.from) / (length * length);
  return view;
}

bool is_reflex(const std::vector<Vec2>& polygon, std::size_t i) {
  const std::size_t n = polygon.size();
  const Vec2& corner = polygon[i % n];
  return cross(corner - polygon[(i + n - 1) % n], polygon[(i + 1) % n] - corner) < 0.0;
}

void add_swing_row(const SwingTwist& chart, const Vec2& outward, double distance,
                   std::vector<LimitRow>& rows) {
  rows.push_back({swing_row(chart, outward), distance});
}

/// The chord along `axis` (0: a_y varies, 1: a_z varies) that holds `point`, or comes nearest to it.
std::array<double, 2> chord(const std::vector<Vec2>& polygon, const Vec2& point, int axis) {
  const int other = 1 - axis;
  std::vector<double> crossings;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    if ((a[other] > point[other]) == (b[other] > point[other])) continue;
    crossings.push_back(a[axis] + (b[axis] - a[axis]) * (point[other] - a[other]) / (b[other] - a[other]));
  }
  std::sort(crossings.begin(), crossings.end());
  std::array<double, 2> best{point[axis], point[axis]};  // at a corner the chord has no length
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const double away = std::max({0.0, crossings[i] - point[axis], point[axis] - crossings[i + 1]});
    if (away >= nearest) continue;
    nearest = away;
    best = {crossings[i], crossings[i + 1]};
  }
  return best;
}

}  // namespace

void edge_rows(const JointRange& range, const SwingTwist& chart, std::vector<LimitRow>& rows) {
  rows.clear();
  const Vec2& p = chart.swing;
  const std::size_t n = range.polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const EdgeView view = look_at_edge(range.polygon, i, p);
    const bool past_start = view.along < 0.0 && is_reflex(range.polygon, i);
    const bool past_end = view.along > 1.0 && is_reflex(range.polygon, i + 1);
    if (!past_start && !past_end) {
      add_swing_row(chart, view.outward, view.signed_distance, rows);
    } else if (past_start && view.signed_distance > 0.0) {
      // Each reflex corner starts one edge: its row comes from there, and only while the point is inside.
      const Vec2 to_corner = view.from - p;
      const EdgeView before = look_at_edge(range.polygon, (i + n - 1) % n, p);
      if (before.along > 1.0 && to_corner.norm() > 1e-9)
        add_swing_row(chart, to_corner.normalized(), to_corner.norm(), rows);
    }
  }
  const Vec3 twist = twist_row(chart);
  rows.push_back({twist, range.twist_max - chart.twist});
  rows.push_back({-twist, chart.twist - range.twist_min});
}

ChordStops chord_stops(const JointRange& range, const SwingTwist& chart) {
  const Vec2 p = polygon_distance(range.polygon, chart.swing) > 0.0
                     ? nearest_boundary_point(range.polygon, chart.swing)
                     : chart.swing;
  return {chord(range.polygon, p, 0), chord(range.polygon, p, 1)};
}

}  // namespace ukemi
