#include "feet/legs.h"

#include <algorithm>
#include <cmath>

#include "body/on_ground.h"
#include "body/sole.h"

namespace ukemi {
namespace {

constexpr double kLongestReach = 0.9995;  // of the leg: a straight knee has no side to bend to

Quat turned(double yaw) { return Quat(Eigen::AngleAxisd(yaw, Vec3::UnitY())); }

/// Axes of a link: y against it, z along the hinge.
Quat link_frame(const Vec3& link, const Vec3& hinge) {
  const Vec3 y = -link.normalized();
  const Vec3 z = (hinge - hinge.dot(y) * y).normalized();
  Mat3 axes;
  axes << y.cross(z), y, z;
  return Quat(axes);
}

}  // namespace

Leg::Leg(const ArticulatedBody& body, const BodyPose& home, BodySide side)
    : thigh(side == BodySide::left ? Segment::thigh_l : Segment::thigh_r),
      shank(side == BodySide::left ? Segment::shank_l : Segment::shank_r),
      foot(side == BodySide::left ? Segment::foot_l : Segment::foot_r),
      hip(joint_above(thigh)),
      knee(joint_above(shank)),
      ankle(joint_above(foot)) {
  const Rigid& pelvis = home[index(Segment::pelvis)];
  const Vec3 hip_at = home[index(thigh)].translation;
  const Vec3 knee_at = home[index(shank)].translation;
  const Vec3 ankle_at = home[index(foot)].translation;
  thigh_m = (knee_at - hip_at).norm();
  shank_m = (ankle_at - knee_at).norm();
  hip_in_pelvis = pelvis.inverse() * hip_at;
  home_foot = home[index(foot)].rotation;
  home_yaw = yaw_of(home_foot * Vec3::UnitX());
  sole = sole_of(body.segments[index(foot)], home_foot);
  for (const Vec3& corner : sole) sole_middle += 0.25 * corner;
  home_ankle_m = -(home_foot * sole_middle).y();
  home_straightness = (ankle_at - hip_at).norm() / length_m();
  home_hinge_ = home[index(thigh)].rotation * Vec3::UnitZ();
  const LegPosture bare = reach(hip_at, ankle_at, 0.0, 0.0);
  thigh_fix_ = bare.thigh.conjugate() * home[index(thigh)].rotation;
  shank_fix_ = bare.shank.conjugate() * home[index(shank)].rotation;
}

LegPosture Leg::reach(const Vec3& hip_at, const Vec3& ankle_at, double yaw, double foot_yaw) const {
  const Quat heading = turned(yaw);
  const Vec3 span = ankle_at - hip_at;
  const double shortest = std::abs(thigh_m - shank_m) + 0.05 * length_m();
  const double distance = std::clamp(span.norm(), shortest, kLongestReach * length_m());
  const Vec3 down = span.normalized();
  Vec3 hinge = heading * home_hinge_;
  hinge = (hinge - hinge.dot(down) * down).normalized();
  const double cosine =
      (thigh_m * thigh_m + distance * distance - shank_m * shank_m) / (2.0 * thigh_m * distance);
  const double bend = std::acos(std::clamp(cosine, -1.0, 1.0));
  const Vec3 along_thigh = Eigen::AngleAxisd(bend, hinge) * down;
  const Vec3 along_shank = distance * down - thigh_m * along_thigh;
  return {link_frame(along_thigh, hinge) * thigh_fix_, link_frame(along_shank, hinge) * shank_fix_,
          turned(foot_yaw) * home_foot};
}

double Leg::yaw(const Senses& senses) const {
  return wrapped(yaw_of(senses.pose[index(foot)].rotation * Vec3::UnitX()) - home_yaw);
}

Vec2 Leg::sole_at(const Senses& senses) const { return on_ground(senses.pose[index(foot)] * sole_middle); }

std::array<Vec2, 4> Leg::sole_corners(const Senses& senses, double margin) const {
  std::array<Vec2, 4> corners;
  for (int i = 0; i < 4; ++i) {
    Vec3 corner = sole[i];
    const Vec3 along = 0.5 * (sole[(i + 1) % 4] - sole[i]);
    const Vec3 across = 0.5 * (sole[(i + 3) % 4] - sole[i]);
    for (const Vec3& half : {along, across}) {
      const double length = half.norm();
      if (length > 1e-6) corner += std::min(margin, 0.9 * length) * half / length;
    }
    corners[i] = on_ground(senses.pose[index(foot)] * corner);
  }
  return corners;
}

double Leg::lowest_corner(const Senses& senses) const {
  double lowest = 1e9;
  for (const Vec3& corner : sole) lowest = std::min(lowest, (senses.pose[index(foot)] * corner).y());
  return lowest;
}

bool Leg::touches(const Senses& senses) const {
  return std::any_of(senses.contacts.begin(), senses.contacts.end(), [this](const SegmentContact& contact) {
    return contact.segment == foot && contact.with == SegmentContact::With::floor;
  });
}

}  // namespace ukemi
