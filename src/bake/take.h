// One take of a prepared bake: simulated, then made a clip.
#pragma once

#include "bake/baked.h"
#include "base/character.h"
#include "base/result.h"
#include "prepare/settings.h"

namespace ukemi {

/// Errors: simulation.
Result<SimulationResult> simulate_take(const BakeSettings& settings, const Prepared& prepared,
                                       const BehaviourSettings& behaviour, Diagnostics& diagnostics);

/// The simulation, its still tail trimmed, as a clip with lead and recovery, its figures and its
/// score. Errors: usage (too many frames), those of the recovery.
Result<BakedClip> clip_of_take(const Character& character, const BakeSettings& settings,
                               const Prepared& prepared, SimulationResult simulation);

}  // namespace ukemi
