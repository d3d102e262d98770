// Many reactions: planned from a recipe, baked by workers, resumable at any moment.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "batch/journal.h"
#include "batch/manifest.h"
#include "batch/recipe.h"
#include "batch/workers.h"

namespace ukemi {

/// Part `index` of `count`, from 1: every count-th reaction.
struct Shard {
  int index = 1;
  int count = 1;
  bool whole() const { return count == 1; }
};

struct BatchSettings {
  std::filesystem::path recipe;
  std::filesystem::path folder;
  Shard shard;
  bool resume = false;                       // keep what the folder has already
  bool force = false;                        // bake everything again
  std::vector<std::filesystem::path> merge;  // take over what these have; bake nothing
  std::filesystem::path rejects;             // a reviewer's, see take_rejects; empty: none
  std::optional<double> max_excess_deg;      // reject what leaves the range of motion farther
  bool reject_unsettled = false;             // reject what does not come to rest
  WorkerSettings workers;
};

enum class Plan { bake, keep, left_out, elsewhere };  // elsewhere: another shard's

struct PlannedReaction {
  Plan plan = Plan::bake;
  std::string digest;
};

/// What a batch is going to do.
struct BatchPlan {
  Recipe recipe;
  std::vector<Reaction> reactions;
  std::vector<PlannedReaction> planned;  // one for each
  History history;                       // of the folder, the verdicts of `rejects` included
  Verdicts news;                         // verdicts that the folder does not know yet
  std::size_t count(Plan plan) const;
};

/// Reads the recipe and what the folder has. Errors: those of the recipe; input (a character cannot be read);
/// usage (the folder has a batch, and neither resume nor force is given; malformed rejects).
Result<BatchPlan> plan_batch(const BatchSettings& settings);

/// Seconds that baking would take, from what the folder's reactions took, else from baking one of each
/// character (eight at most) in memory. Errors: internal.
Result<double> estimate_seconds(const BatchPlan& plan, const BatchSettings& settings);

struct BatchProgress {
  std::size_t finished = 0, failed = 0, total = 0;
  const ReactionRecord* last = nullptr;  // that has just ended
};

struct BatchResult {
  std::vector<ManifestEntry> entries;  // those that are done, failed or rejected
  std::size_t baked = 0;               // in this run
  std::size_t kept = 0;                // from earlier ones
  bool stopped = false;                // before its end
  std::optional<Error> cannot_write;   // why it was
};

/// Bakes what the plan says and writes manifest.json and manifest.csv (of a shard: manifest.I-of-N.json and
/// .csv). `progress` is told of each end, `stopped` is asked about ten times a second. Errors: output.
Result<BatchResult> run_batch(const BatchPlan& plan, const BatchSettings& settings,
                              const std::function<void(const BatchProgress&)>& progress,
                              const std::function<bool()>& stopped);

}  // namespace ukemi
