#include "body/centre_of_mass.h"

namespace ukemi {

Vec3 centre_of_mass(const ArticulatedBody& body, const BodyPose& pose) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < kSegmentCount; ++i)
    sum += body.segments[i].mass_kg / body.mass_kg * (pose[i] * body.segments[i].centre_of_mass);
  return sum;
}

}  // namespace ukemi
