// Legs of a body: lengths, soles, and the posture that reaches from a hip to an ankle.
#pragma once

#include <array>
#include <vector>

#include "body/body.h"
#include "feet/sides.h"
#include "physics/senses.h"

namespace ukemi {

/// World orientations of a leg's segments.
struct LegPosture {
  Quat thigh, shank, foot;
};

/// One leg, as it stands in a reference pose ("home").
class Leg {
 public:
  /// `home`: a pose that stands on the ground.
  Leg(const ArticulatedBody& body, const BodyPose& home, BodySide side);

  Segment thigh, shank, foot;
  Joint hip, knee, ankle;
  double thigh_m = 0.0, shank_m = 0.0;  // joint to joint
  double length_m() const { return thigh_m + shank_m; }
  Vec3 hip_in_pelvis = Vec3::Zero();
  std::array<Vec3, 4> sole;           // corners, foot frame
  Vec3 sole_middle = Vec3::Zero();    // foot frame
  Quat home_foot = Quat::Identity();  // world
  double home_yaw = 0.0;              // of the foot
  double home_ankle_m = 0.0;          // above the ground
  double home_straightness = 1.0;     // hip to ankle over length

  /// Thigh and shank that reach from a hip to an ankle (or as far as they can); the knee bends as at home,
  /// with everything turned by `yaw` from there. The home posture is reproduced exactly. The foot is flat at
  /// `foot_yaw` from home.
  LegPosture reach(const Vec3& hip_at, const Vec3& ankle_at, double yaw, double foot_yaw) const;

  /// Yaw of the foot from its home yaw.
  double yaw(const Senses& senses) const;
  /// On the ground.
  Vec2 sole_at(const Senses& senses) const;
  /// Corners of the sole on the ground, moved inward by `margin` m.
  std::array<Vec2, 4> sole_corners(const Senses& senses, double margin) const;
  double lowest_corner(const Senses& senses) const;
  bool touches(const Senses& senses) const;

 private:
  Vec3 home_hinge_ = Vec3::UnitZ();  // knee axis, world
  Quat thigh_fix_ = Quat::Identity(), shank_fix_ = Quat::Identity();
};

}  // namespace ukemi
