// The passive restriction as rows: linear bounds on the joint's angular velocity (Era et al., section 4.1).
#pragma once

#include <array>
#include <vector>

#include "restrict/range_of_motion.h"

namespace ukemi {

/// row . omega <= distance / h keeps the joint inside for a step h: omega is the child's angular velocity
/// relative to the parent in the joint frame, distance the rest of the way to the boundary (negative
/// outside), radians.
struct LimitRow {
  Vec3 row = Vec3::UnitX();
  double distance = 0.0;
};

/// One row per polygon edge, along the edge's gradient, and two for the twist. At a reflex corner the row
/// goes along the direction to the corner instead of the edges that end there; edges hidden behind it have no
/// row.
void edge_rows(const JointRange& range, const SwingTwist& chart, std::vector<LimitRow>& rows);

/// Stops along a_y and a_z: the ends of the horizontal and of the vertical chord of the polygon through the
/// chart (Figure 4), through the nearest boundary point when it lies outside.
struct ChordStops {
  std::array<double, 2> a_y{};  // theta_ylo, theta_yhi
  std::array<double, 2> a_z{};  // theta_zlo, theta_zhi
};
ChordStops chord_stops(const JointRange& range, const SwingTwist& chart);

}  // namespace ukemi
