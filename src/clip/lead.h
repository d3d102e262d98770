// What stands before the simulated part of a clip.
#pragma once

#include "clip/timeline.h"

namespace ukemi {

/// The smallest number of frames that lasts at least `seconds`.
int frames_in(double seconds, double fps);

/// Puts what the character does unhit before the impact: a still start holds its pose. Frame 0 moves to
/// `lead_s` (rounded up to whole frames) after the clip's start, and with it every mark. Props come in as
/// they were going in `scene`.
void add_lead(const Actor& actor, const Scene& scene, double gravity, double lead_s, Timeline& timeline);

}  // namespace ukemi
