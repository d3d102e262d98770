// Looks for the take that a director asks for among what a person might do.
#pragma once

#include <functional>
#include <vector>

#include "bake/baked.h"
#include "base/character.h"
#include "base/result.h"
#include "prepare/settings.h"

namespace ukemi {

/// How a search is run. The answer does not depend on `threads`.
struct SearchRun {
  int threads = 1;
  std::function<void(int done, int most)> after_each;  // may be empty
  std::function<bool()> stopped;                       // asked between trials; may be empty
};

/// Trials that the settings allow.
int most_trials(const BakeSettings& settings);

/// What is tried, in this order: first what the body does without help.
std::vector<Choice> choices_for(const BakeSettings& settings);

/// 1. Without an outcome: the trial with the best score.
/// 2. With one: the best of those that reach it. Trials end with the first that stands with at most one
///    step, or that falls and meets nine tenths of the criteria.
/// 3. Where none does and --assist is on, a force from outside, found by halving; else the first trial,
///    with a warning.
/// Warnings of the trial that is kept. Errors: those of the takes.
Result<BakedClip> search_take(const Character& character, const BakeSettings& settings,
                              const Prepared& prepared, const SearchRun& run, Diagnostics& diagnostics);

}  // namespace ukemi
