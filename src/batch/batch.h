// Many reactions: planned from a recipe, baked by workers, resumable at any moment.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "base/result.h"
#include "batch/manifest.h"
#include "batch/plan.h"

namespace ukemi {

/// Reads the recipe and what the folder has. Errors: those of the recipe; input (a character cannot be read);
/// usage (the folder has a batch, and neither resume nor force is given; malformed rejects).
Result<BatchPlan> plan_batch(const BatchSettings& settings);

/// Seconds that baking would take, from what the folder's reactions took, else from baking one of each
/// character (eight at most) in memory. Errors: internal.
Result<double> estimate_seconds(const BatchPlan& plan, const BatchSettings& settings);

struct BatchProgress {
  std::size_t finished = 0, failed = 0, total = 0;
  const ReactionRecord* last = nullptr;  // the one that has just ended
};

struct BatchResult {
  std::vector<ManifestEntry> entries;  // those that are done, failed or rejected
  std::size_t baked = 0;               // in this run
  std::size_t kept = 0;                // from earlier ones
  bool stopped = false;                // before all was baked
  std::optional<Error> cannot_write;   // why writing failed
};

/// Bakes what the plan says and writes manifest.json and manifest.csv (of a shard: manifest.I-of-N.json and
/// .csv). `progress` is told of each end, `stopped` is asked about ten times a second. Errors: output.
Result<BatchResult> run_batch(const BatchPlan& plan, const BatchSettings& settings,
                              const std::function<void(const BatchProgress&)>& progress,
                              const std::function<bool()>& stopped);

}  // namespace ukemi
