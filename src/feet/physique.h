// What a behaviour knows of its own body: masses, strength, size.
#pragma once

#include <algorithm>
#include <vector>

#include "body/body.h"
#include "physics/senses.h"

namespace ukemi {

struct Physique {
  Physique(const ArticulatedBody& body, double leg_length_m, double gravity_m_s2);

  double mass_kg, gravity;  // gravity: m/s^2, negative where it pulls up
  double strength;          // mass times height, of a man of 73 kg and 1.741 m
  double size;   // leg length over that of the man whom lengths were found on (0.857 m): scales lengths
  double tempo;  // its root: scales times and speeds
  double leg_length_m;
  PerSegment<double> masses_kg;
  PerJoint<std::vector<int>> below;  // segments that hang on a joint
  PerJoint<bool> fused{};

  /// What presses a body to the ground, m/s^2: 0 where gravity pulls up.
  double weight_m_s2() const { return std::max(gravity, 0.0); }

  /// Torque about a joint of the weight that hangs on it, world, N m.
  Vec3 weight_torque(const Senses& senses, Joint joint) const;
};

/// Where a joint is: the origin of the segment below it.
inline const Vec3& joint_at(const Senses& senses, Joint joint) {
  return senses.pose[index(child_of(joint))].translation;
}

}  // namespace ukemi
