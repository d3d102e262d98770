// A run of a limp body with the program's own tables.
#pragma once

#include "behave/tone.h"
#include "simulate/simulate.h"

namespace ukemi::test {

inline Result<SimulationResult> simulate_limp(const ArticulatedBody& body, const RangeOfMotion& range,
                                              const StartState& start, const Scene& scene,
                                              const SimulationSettings& settings, Diagnostics& diagnostics) {
  const auto thresholds = load_active_thresholds("");
  if (!thresholds) return thresholds.error();
  const MuscleStrength none{};
  return simulate({body, range, *thresholds, none, start, scene, settings, limp_behaviour(body, settings)},
                  diagnostics);
}

}  // namespace ukemi::test
