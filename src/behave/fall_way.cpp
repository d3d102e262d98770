#include "behave/fall_way.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kFiltered_s = 0.08;  // time constant of the side that goes down
constexpr double kFallShare = 0.8;    // of the fall's way against that of gravity
constexpr double kGravity_m_s2 = 9.81;

bool is_foot(Segment s) { return s == Segment::foot_l || s == Segment::foot_r; }

bool beyond_feet(const Senses& senses) {
  return std::any_of(senses.contacts.begin(), senses.contacts.end(), [](const SegmentContact& c) {
    return c.with == SegmentContact::With::floor && !is_foot(c.segment);
  });
}

/// Box about both soles on the ground: (x, z).
Eigen::AlignedBox2d box_of_soles(const FallBody& body, const Senses& senses) {
  Eigen::AlignedBox2d box;
  for (const BodySide side : kSides)
    for (const Vec3& corner : sole_corners(body, senses, side)) box.extend(Vec2(corner.x(), corner.z()));
  return box;
}

}  // namespace

void FallDirection::update(const FallBody& body, const Senses& senses, double h) {
  down_ = down_ || beyond_feet(senses);
  if (!down_) follow_fall(body, senses);
  follow_side(senses, h);
}

// The capture point (Hof 2005: c + v / sqrt(g / height)) against the middle of the soles.
void FallDirection::follow_fall(const FallBody& body, const Senses& senses) {
  const Eigen::AlignedBox2d box = box_of_soles(body, senses);
  const Vec2 centre(senses.com.x(), senses.com.z());
  const double time_s = std::sqrt(std::max(senses.com.y(), 0.1) / kGravity_m_s2);
  const Vec2 velocity(senses.com_velocity.x(), senses.com_velocity.z());
  const Vec2 off = centre + time_s * velocity - box.center();
  if (off.norm() > 1e-3) way_.along = Vec3(off.x(), 0.0, off.y()).normalized();
  way_.beyond_m = std::max(way_.beyond_m, box.exteriorDistance(centre));
}

// d = unit of the (front, right) part of the way down in the chest, the way down being 0.8 u - e_y: upright
// the fall decides, lying gravity does, and nothing switches between.
void FallDirection::follow_side(const Senses& senses, double h) {
  const Vec3 down = kFallShare * way_.along - Vec3::UnitY();
  const Vec3 local = senses.pose[index(Segment::chest)].rotation.conjugate() * down;
  const Vec2 flat(local.x(), local.z());
  if (flat.norm() < 1e-6) return;
  const double share = way_.side_down.norm() < 1e-9 ? 1.0 : 1.0 - std::exp(-h / kFiltered_s);
  const Vec2 mixed = way_.side_down + share * (flat.normalized() - way_.side_down);
  if (mixed.norm() < 1e-6) return;
  const Vec2 d = mixed.normalized();
  way_.side_down = d;
  way_.forward = d.x() > 0.0 ? d.x() * d.x() : 0.0;
  way_.backward = d.x() < 0.0 ? d.x() * d.x() : 0.0;
  way_.sideways = d.y() * d.y();
  way_.side = d.y() < 0.0 ? -1.0 : 1.0;
}

}  // namespace ukemi
