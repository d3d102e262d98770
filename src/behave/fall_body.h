// What a fall needs to know of a body: its lengths, its soles, what its joints can give.
#pragma once

#include <array>

#include "body/body.h"
#include "body/muscles.h"
#include "feet/sides.h"
#include "physics/senses.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

struct ArmSize {
  double upper_m = 0.3;  // shoulder to elbow
  double fore_m = 0.26;  // elbow to wrist
  double reach_m() const { return upper_m + fore_m; }
};

/// Lengths grow with `lambda`, times with its root (Froude: the same motion in another size).
struct FallBody {
  FallBody(const ArticulatedBody& body, const RangeOfMotion& range, const MuscleStrength& strength);

  double mass_kg = 0.0;
  double leg_m = 0.0;   // hip to ankle, straight
  double lambda = 1.0;  // leg over that of a man of 1.78 m (0.857 m)
  double tau = 1.0;     // its root
  PerSide<ArmSize> arms;
  PerSide<double> thigh_m{}, shank_m{};
  PerSide<std::array<Vec3, 4>> sole;  // corners, frame of the foot
  PerSegment<double> mass{};          // kg
  PerJoint<Vec3> anchor;              // joint centre in the parent's frame
  PerJoint<bool> fused{};
  RangeOfMotion range;
  MuscleStrength strength;
  PerJoint<double> stiffness{};  // at full effort, N m/rad

  /// The nearest rotation that lies inside the joint's range by `margin` (rad).
  Quat inside(Joint joint, const Quat& parent_from_child, double margin) const;
};

/// World positions of the corners of a sole.
std::array<Vec3, 4> sole_corners(const FallBody& body, const Senses& senses, BodySide side);
/// The present rotation of a joint, parent_from_child.
Quat joint_rotation_of(const BodyPose& pose, Joint joint);
/// Whether the segment touches the floor.
bool on_floor(const Senses& senses, Segment segment);

}  // namespace ukemi
