// Motion of hips that a BVH gives no position channels.
#pragma once

#include "base/animation.h"
#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Of a BVH whose hips have no position channels: moves their way onto the nearest joint above that has all
/// three. Other clips stay as they are. `frames`: poses of the character's skeleton.
void lift_hips(const Character& character, const Humanoid& humanoid, std::vector<Pose>& frames);

}  // namespace ukemi
