// What a simulation can be given.
#pragma once

#include <optional>

#include "base/result.h"
#include "body/body.h"
#include "restrict/range_of_motion.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Explicit torques explode where k h is beyond this (k 1/s, h s).
inline constexpr double kMaxExplicitGain = 0.1;
/// Frames of one trajectory.
inline constexpr double kMaxFrames = 100000.0;

/// What no simulation can be run with: numbers that are not finite or out of their range, a body without
/// mass, a start that is no pose. Errors: usage (settings, scene), input (body, start, range).
std::optional<Error> fault_of(const ArticulatedBody& body, const RangeOfMotion& range,
                              const StartState& start, const Scene& scene,
                              const SimulationSettings& settings);

}  // namespace ukemi
