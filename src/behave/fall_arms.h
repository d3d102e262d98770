// Arms that reach for the ground where the body will come down.
#pragma once

#include "behave/fall_posture.h"

namespace ukemi {

/// What a hand is to do, world.
struct HandTarget {
  Vec3 wrist = Vec3::Zero();
  double stretch = 0.93;           // of the arm's length: the wrist goes no farther from the shoulder
  Vec3 elbow_way = Vec3::UnitY();  // to which side of the line shoulder - wrist the elbow goes
  Vec3 fingers = Vec3::UnitX();    // way that the fingers point, palm to the ground
};

/// Rotations of one arm's joints, parent_from_child.
struct ArmPose {
  Quat shoulder = Quat::Identity(), elbow = Quat::Identity(), wrist = Quat::Identity();
};

/// Where the hand of this side should meet the ground.
HandTarget landing_place(const FallBody& body, const Senses& senses, const FallWay& way,
                         const FallVariation& variation, BodySide side);

/// Two-bone inverse kinematics against the clavicle as it is: the wrist at the target as far as 0.35 of the
/// arm's length to the target's stretch reach (the elbow is never straight), the palm down as far as the
/// forearm turns (82 degrees) and against the forearm as it is.
ArmPose arm_reaching(const FallBody& body, const Senses& senses, const HandTarget& target, BodySide side);

/// Seconds until the shoulder is as near to the ground as a bent arm is long, at most 0.5.
double time_to_brace(const FallBody& body, const Senses& senses, BodySide side);

}  // namespace ukemi
