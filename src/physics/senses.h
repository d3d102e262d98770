// What a behaviour senses of the body.
//
// Segment frames are anatomical: x to the front, y up along the segment in the neutral pose, z to the body's
// right. World: y up, the floor at y = 0. SI units, radians.
#pragma once

#include <vector>

#include "base/math.h"
#include "base/segments.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// One point where a segment touches something.
struct SegmentContact {
  enum class With { floor, prop, self };
  Segment segment = Segment::pelvis;
  With with = With::floor;
  Vec3 place = Vec3::Zero();   // world, m
  Vec3 normal = Vec3::Zero();  // unit, from what is touched into the segment
  double depth_m = 0.0;
};

/// The body at the end of an accepted step (or at the start). No engine type, nothing stored from one step to
/// the next.
struct Senses {
  double time_s = 0.0;
  BodyPose pose;                         // world_from_segment
  PerSegment<Vec3> centre;               // of mass, world, m
  PerSegment<Vec3> velocity;             // of the centre of mass, m/s
  PerSegment<Vec3> angular_velocity;     // world, rad/s
  PerJoint<SwingTwist> chart;            // identity at fused joints
  Vec3 com = Vec3::Zero();               // of the body
  Vec3 com_velocity = Vec3::Zero();      // m/s
  Vec3 angular_momentum = Vec3::Zero();  // about the centre of mass, kg m^2/s
  double fastest_m_s = 0.0;              // largest speed of a rigid body's centre
  double fastest_turning_rad_s = 0.0;
  std::vector<SegmentContact> contacts;

  Senses() {
    centre.fill(Vec3::Zero());
    velocity.fill(Vec3::Zero());
    angular_velocity.fill(Vec3::Zero());
  }
};

}  // namespace ukemi
