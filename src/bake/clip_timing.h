// What stands before and after the simulated part of a clip: the lead, and the way back to a pose or clip.
#pragma once

#include "bake/bake.h"

namespace ukemi {

/// The smallest number of frames that lasts at least `seconds`.
int frames_in(double seconds, double fps);

/// Puts what the character does unhit before the impact: a still start holds its pose. Frame 0 moves to
/// settings.lead_s (rounded up to whole frames) after the clip's start, and with it every mark. Props come in
/// as they were going.
void add_lead(const Character& character, const BakeSettings& settings, BakeOutcome& outcome);

/// Blends from the last frame, with its velocities, to what settings.recover_to names, in settings.recover_s.
/// The figure recovers where it is: who stands keeps his feet, who lies gets up towards his feet or head, and
/// the clip he goes back to gathers way meanwhile; at the end it is where it would be without the blow.
/// The lowest skin point goes evenly from its height to that of the pose or clip, so that nothing sinks into
/// the floor or floats.
void add_recovery(const Character& character, const BakeSettings& settings, BakeOutcome& outcome);

/// Bones that carry no segment play the start clip after the impact, where there is one.
void play_extra_bones(const Character& character, BakeOutcome& outcome);

}  // namespace ukemi
