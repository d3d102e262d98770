// The posture of a body that falls with care: trunk, neck, shoulder girdle, legs.
#pragma once

#include "behave/fall_way.h"
#include "feet/sides.h"

namespace ukemi {

/// What makes two falls of the same body differ. Angles in radians.
struct FallVariation {
  double leg_bend = 0.12;     // share by which the right leg bends more than the left, and the left less
  double trunk_turn = 0.0;    // to the left
  double head_turn = 0.0;     // to the left
  double arm_delay_s = 0.03;  // of the right arm; less than 0: of the left
  PerSide<Vec2> hand_m{Vec2::Zero(), Vec2::Zero()};  // where the hands go besides: along the fall, outwards
  PerSide<double> stretch{0.93, 0.93};               // of the arm's length that the hand reaches at most
  double lying_side = 1.0;  // -1 left, 1 right: the side that does more where a pose is not symmetric
};
FallVariation fall_variation(std::uint64_t seed);

/// 0 to 1: how far a forward fall has become a dive, the trunk level before the knees are down. Its legs are
/// stretched, so that it lands on hands and belly.
double dive(const FallBody& body, const Senses& senses, const FallWay& way);

/// Joint rotations from the neutral pose, parent_from_child, not yet clamped to the range: the joints of the
/// arms are left as they are given. `flat`: see dive().
void crouch(const FallWay& way, const FallVariation& variation, double lambda, double flat,
            PerJoint<Quat>& goals);

}  // namespace ukemi
