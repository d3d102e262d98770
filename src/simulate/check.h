// What a simulation can be given.
#pragma once

#include <optional>

#include "base/result.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Frames of one trajectory.
inline constexpr double kMaxFrames = 100000.0;

/// What no simulation can be run with: numbers that are not finite or out of their range, a body without
/// mass, a start that is not a pose. Errors: usage (settings, scene), input (body, start, range).
std::optional<Error> fault_of(const SimulationInput& input);

}  // namespace ukemi
