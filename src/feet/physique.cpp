#include "feet/physique.h"

#include <cmath>

namespace ukemi {

Physique::Physique(const ArticulatedBody& body, double leg_m, double gravity_m_s2)
    : mass_kg(body.mass_kg),
      gravity(gravity_m_s2),
      strength(body.mass_kg * body.height_m / (73.0 * 1.741)),
      size(leg_m / 0.857),
      tempo(std::sqrt(size)),
      leg_length_m(leg_m) {
  for (int s = 0; s < kSegmentCount; ++s) {
    masses_kg[s] = body.segments[s].mass_kg;
    for (Segment up = segment_at(s); up != Segment::pelvis; up = parent_of(up))
      below[index(joint_above(up))].push_back(s);
  }
  for (int j = 0; j < kJointCount; ++j) fused[j] = body.joints[j].fused;
}

Vec3 Physique::weight_torque(const Senses& senses, Joint joint) const {
  const Vec3& at = joint_at(senses, joint);
  Vec3 torque = Vec3::Zero();
  for (const int s : below[index(joint)])
    torque += (senses.centre[s] - at).cross(Vec3(0.0, -masses_kg[s] * gravity, 0.0));
  return torque;
}

}  // namespace ukemi
