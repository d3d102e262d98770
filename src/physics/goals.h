// What a behaviour asks of the muscles.
#pragma once

#include <optional>
#include <vector>

#include "base/math.h"
#include "base/segments.h"

namespace ukemi {

/// A spring, a damper and a torque at one joint, taken implicitly:
///   torque on the child = feed_forward - stiffness * error - damping * (omega - velocity), the opposite on
///   the parent;
/// error: rotation vector from the goal to the present rotation; omega: of the child relative to the parent.
struct JointGoal {
  Quat parent_from_child = Quat::Identity();  // goal, between segment frames
  Vec3 velocity = Vec3::Zero();               // wanted omega, world, rad/s
  Vec3 feed_forward_n_m = Vec3::Zero();       // world
  double stiffness_n_m_rad = 0.0;
  double damping_n_m_s_rad = 0.0;
  /// Torque about the parent segment's x (abduction), y (turning) and z (flexion): least and most, N m.
  Vec3 least_n_m = Vec3::Zero(), most_n_m = Vec3::Zero();
};

/// Tone: a spring towards a pose that gives way: what it asks for stays below a cap by growing softer, so
/// that it never hits its cap hard.
struct SoftGoal {
  Quat parent_from_child = Quat::Identity();
  double cap_n_m = 0.0;  // given at an error of 0.35 rad; damping is 0.12 s times the stiffness
};

/// What is asked of every joint. Goals of several controllers add up; the sum is capped by what the joint can
/// give.
struct Goals {
  PerJoint<std::vector<JointGoal>> joints;
  PerJoint<std::optional<SoftGoal>> tone;
  /// Soles do not slip while the body balances on them (friction of the soles without a bound).
  bool firm_soles = false;
  /// Feet that swing: their toes, stiff in this body, do not catch on the floor (no friction there).
  PerSegment<bool> glides{};
  /// A force from outside on the pelvis, world, N: for outcomes that no person reaches (--assist).
  Vec3 help_n = Vec3::Zero();

  /// Removes all goals, but keeps the memory for the next ones.
  void clear() {
    for (std::vector<JointGoal>& joint : joints) joint.clear();
    tone.fill(std::nullopt);
    firm_soles = false;
    glides.fill(false);
    help_n.setZero();
  }
};

}  // namespace ukemi
