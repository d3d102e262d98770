// Which points of the limbs bear on the floor during a motion, and where.
#pragma once

#include <vector>

#include "rise/whole_body.h"

namespace ukemi {

/// Frames [first, last] in which a point bears, and where on the floor (y = 0).
struct Bearing {
  int first = 0, last = 0;
  Vec3 place = Vec3::Zero();
};

/// A point of the skin that bears now and then without sliding.
struct BearingPoint {
  Segment segment = Segment::foot_l;
  Vec3 point = Vec3::Zero();  // segment frame
  std::vector<Bearing> rests;
};

/// Up to two points of every hand, forearm, shank and foot: those that bear longest, apart from one another.
/// A point bears while it is low and slow for an eighth of a second and more, and goes no farther than a
/// twentieth of the height.
std::vector<BearingPoint> bearing_points(const WholeBody& whole, const std::vector<BodyPose>& motion,
                                         double fps);

}  // namespace ukemi
