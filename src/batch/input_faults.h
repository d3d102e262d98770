// What is wrong with a batch's inputs, told without baking.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "batch/plan.h"

namespace ukemi {

struct InputFault {
  std::string character;  // its name in the recipe
  Error error;
  std::size_t reactions = 0;  // that it stops
};

/// Faults of what is to be baked: a character that cannot be read or is no humanoid, a map, a clip or a pose
/// that does not fit it. Each character is loaded once and tried once with each set of such settings; a
/// fault is told once of a character, in the order of the recipe.
std::vector<InputFault> input_faults(const BatchPlan& plan);

}  // namespace ukemi
