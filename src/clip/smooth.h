// A zero-phase low-pass filter for clips.
#pragma once

#include "base/animation.h"

namespace ukemi {

/// Butterworth of second order, run forward and backward: no lag, -6 dB at `cutoff_hz` (below fps / 2). The
/// clip is continued beyond its ends by its point reflection, which keeps the first and the last frame where
/// they are.
void smooth(Clip& clip, double cutoff_hz);

}  // namespace ukemi
