#include "humanoid/landmarks.h"

#include <algorithm>

namespace ukemi {

Vec3 dominant_axis(const Vec3& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return (v[axis] < 0.0 ? -1.0 : 1.0) * Vec3::Unit(axis);
}

namespace {

/// Every limb bone has a length to speak of.
bool has_limbs(const Landmarks& f) {
  const double least = 0.005 * f.rise().norm();
  for (int side = 0; side < 2; ++side)
    for (const Vec3& link : {f.link(kThigh[side], kShank[side]), f.link(kShank[side], kFoot[side]),
                             f.link(kUpperArm[side], kForearm[side]), f.link(kForearm[side], kHand[side])})
      if (!(link.norm() > least)) return false;
  return true;
}

}  // namespace

bool humanlike(const Landmarks& f) {
  if (!has_limbs(f)) return false;
  const Vec3 trunk = f.shoulders() - f.hips();
  const Vec3 across_hips = f.link(Segment::thigh_l, Segment::thigh_r);
  const Vec3 across_shoulders = f.link(Segment::upperarm_l, Segment::upperarm_r);
  return angle(f.hips() - f.ankles(), trunk) < radians(60) &&
         angle(across_hips, across_shoulders) < radians(70) &&
         std::abs(angle(trunk, across_hips) - radians(90)) < radians(45);
}

bool usable(const Landmarks& f) {
  if (!humanlike(f)) return false;
  const Vec3 trunk = f.shoulders() - f.hips();
  if (angle(f.link(Segment::thigh_l, Segment::thigh_r), f.link(Segment::upperarm_l, Segment::upperarm_r)) >
      radians(35))
    return false;
  for (int side = 0; side < 2; ++side) {
    const Vec3 thigh = f.link(kThigh[side], kShank[side]), shank = f.link(kShank[side], kFoot[side]);
    const Vec3 upper = f.link(kUpperArm[side], kForearm[side]), lower = f.link(kForearm[side], kHand[side]);
    if (angle(f.link(kThigh[side], kFoot[side]), -trunk) > radians(50) || angle(thigh, shank) > radians(100))
      return false;
    if (angle(upper, lower) > radians(100) || angle(upper, -trunk) > radians(135)) return false;
  }
  return true;
}

double leg_tilt(const Landmarks& f, const Vec3& up) {
  double worst = 0.0;
  for (int side = 0; side < 2; ++side)
    for (const Vec3& link : {f.link(kThigh[side], kShank[side]), f.link(kShank[side], kFoot[side])})
      worst = std::max(worst, angle(link, -up));
  return worst;
}

double neutrality(const Landmarks& f, const Vec3& up) {
  double sum = angle(f.shoulders() - f.hips(), up);
  for (int side = 0; side < 2; ++side) {
    sum += angle(f.link(kThigh[side], kShank[side]), -up) + angle(f.link(kShank[side], kFoot[side]), -up);
    sum += 0.5 * angle(f.link(kUpperArm[side], kForearm[side]), -up);
    sum += 0.5 * angle(f.link(kForearm[side], kHand[side]), -up);
  }
  return sum;
}

RestPoseClass class_of(const Landmarks& f, const Vec3& up) {
  double lowest = kPi, highest = 0.0;
  for (int side = 0; side < 2; ++side) {
    const double arm = angle(f.link(kUpperArm[side], kForearm[side]), -up);
    lowest = std::min(lowest, arm);
    highest = std::max(highest, arm);
    if (angle(f.link(kUpperArm[side], kForearm[side]), f.link(kForearm[side], kHand[side])) > radians(45))
      return RestPoseClass::other;
  }
  if (leg_tilt(f, up) > radians(30) || angle(f.shoulders() - f.hips(), up) > radians(25))
    return RestPoseClass::other;
  if (lowest > radians(72) && highest < radians(108)) return RestPoseClass::t_pose;
  if (highest < radians(20)) return RestPoseClass::neutral;
  if (lowest > radians(20) && highest <= radians(80)) return RestPoseClass::a_pose;
  return highest < radians(30) ? RestPoseClass::neutral : RestPoseClass::other;
}

bool exact_t_pose(const Landmarks& f, const Vec3& up) {
  if (leg_tilt(f, up) > radians(8)) return false;
  const Vec3 across = f.link(Segment::thigh_l, Segment::thigh_r);
  for (int side = 0; side < 2; ++side) {
    const Vec3 outwards = side == 0 ? Vec3(-across) : across;
    const Vec3 upper = f.link(kUpperArm[side], kForearm[side]), lower = f.link(kForearm[side], kHand[side]);
    if (std::abs(angle(upper, up) - radians(90)) > radians(6) || angle(upper, lower) > radians(6))
      return false;
    if (angle(upper, outwards) > radians(25)) return false;
  }
  return angle(f.shoulders() - f.hips(), up) < radians(12);
}

}  // namespace ukemi
