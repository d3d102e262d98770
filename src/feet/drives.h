// Springs towards postures, as strong as people's muscles are.
#pragma once

#include "feet/legs.h"
#include "feet/physique.h"
#include "physics/goals.h"

namespace ukemi {

/// How a joint is driven.
struct Drive {
  Quat goal = Quat::Identity();      // parent_from_child
  Vec3 velocity = Vec3::Zero();      // wanted of the child against the parent, world, rad/s
  Vec3 feed_forward = Vec3::Zero();  // world, N m
  double share = 1.0;                // of the stiffness that is the joint's
  double damping_s = 0.12;           // over the stiffness
};

/// Adds what `strength` (1: a healthy adult) makes of a drive. A joint that is fused asks for nothing.
void ask_joint(const Physique& physique, double strength, Joint joint, const Drive& drive, Goals& goals);

/// Time between two postures that give a speed, s.
constexpr double kAhead_s = 0.004;

/// Drives a leg in the air towards a posture (world) that it should have now, and to the one that it should
/// have kAhead_s later. Its foot glides where it touches the floor.
void ask_swinging_leg(const Physique& physique, double strength, const Leg& leg, const Senses& senses,
                      const LegPosture& now, const LegPosture& soon, Goals& goals);

}  // namespace ukemi
