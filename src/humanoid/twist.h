// Bones along a limb that spread its twist, so that the skin does not wring at one joint.
#pragma once

#include <vector>

#include "humanoid/humanoid.h"

namespace ukemi {

/// Bones named twist or roll that hang on the bone of an upper arm, forearm, thigh or shank, or on each
/// other. `humanoid` has its segments and reference pose.
std::vector<TwistBone> find_twist_bones(const Skeleton& skeleton, const Humanoid& humanoid);

/// What `turn` (of a segment, relative to its parent) is without `lost` of its twist about `axis` (unit,
/// before the turn): the swing in full, the twist in part.
Quat with_less_twist(const Quat& turn, const Vec3& axis, double lost);

}  // namespace ukemi
