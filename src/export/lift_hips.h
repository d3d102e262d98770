// Motion of hips that a BVH gives no position channels.
#pragma once

#include "base/animation.h"
#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Moves the hips' motion onto the nearest joint above that has three position channels, in a BVH whose hips
/// have none. Other clips stay as they are. `frames`: poses of the character's skeleton.
void lift_hips(const Character& character, const Humanoid& humanoid, std::vector<Pose>& frames);

}  // namespace ukemi
