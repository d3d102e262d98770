// Clips that walk or run on the spot, as many are made for games: the game moves the figure.
#pragma once

#include <optional>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// With what velocity a clip on the spot would go over the ground, along the world's x and z, m/s: against
/// the way in which the feet that are down slide back. Nothing where the figure goes itself, where feet stand
/// still, or where they do not agree on one way.
std::optional<Vec2> gait_in_place(const Character& character, const Humanoid& humanoid,
                                  const Animation& clip);

}  // namespace ukemi
