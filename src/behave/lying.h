// How a person comes to lie: the poses that a body settles into, and its breath.
#pragma once

#include <string_view>

#include "behave/fall_posture.h"

namespace ukemi {

enum class EndPose { standing, kneeling, seated, supine, prone, left_side, right_side };
std::string_view name(EndPose pose);

/// Which pose the body is in, from the attitude of its chest and what touches the floor.
EndPose end_pose_of(const Senses& senses);

/// Joint rotations from the neutral pose that a person lies in, parent_from_child, not clamped. The arms of a
/// seated body, which prop it, are left as they are given.
void lie(EndPose pose, const FallVariation& variation, PerJoint<Quat>& goals);

/// The legs of a body that goes over its knees on to the belly: stretched, until it lies.
void sprawl(PerJoint<Quat>& goals);

/// Breathing: how far chest, spine and neck are turned about z (extension is positive) `time_s` after the
/// first breath, rad, and how fast, rad/s; other joints do not take part. The chest rises and falls by
/// about 4.5 mm in a man.
struct BreathTurn {
  double angle = 0.0, speed = 0.0;
};
BreathTurn breath(Joint joint, double time_s);

}  // namespace ukemi
