// What a person's joints can give.
#pragma once

#include "base/math.h"
#include "base/result.h"
#include "base/segments.h"
#include "body/body.h"

namespace ukemi {

/// Largest torque on the child about the parent segment's x (abduction), y (turning) and z (flexion), N m:
/// `least` is that of the negative way and not above 0.
struct JointStrength {
  Vec3 least_n_m = Vec3::Zero(), most_n_m = Vec3::Zero();
};
using MuscleStrength = PerJoint<JointStrength>;

/// Of a healthy adult of the body's mass and height (torque grows with mass times height) times `share`; a
/// woman's are smaller (assets/muscles.toml). Errors: input (the file, with line and joint).
Result<MuscleStrength> muscle_strength(const ArticulatedBody& body, Sex sex, double share);

}  // namespace ukemi
