// Keeps the skin of a finished timeline above the floor.
#pragma once

#include "base/result.h"
#include "clip/timeline.h"
#include "judge/skin_on_floor.h"

namespace ukemi {

/// Raises frames whose blended skin lies more than 9 mm below the floor (see `lifts`): between two bones it
/// may lie deeper than rigid segments show. Returns the largest lift, metres.
double lift_blended_skin(const Actor& actor, const SkinOverFloor& skin, Timeline& timeline);

/// Warns of skin that still sinks into the floor by more than 20 mm, and of parts that the simulation does
/// not know (hair, skirts, what hands hold) where they sink.
void warn_of_sinking_skin(const Character& character, const SkinOnFloor& skin, Diagnostics& diagnostics);

}  // namespace ukemi
