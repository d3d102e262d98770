// The settings of a batch, and what it is going to do.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/build_id.h"
#include "batch/batch_work.h"
#include "batch/journal.h"
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
  AfterBake after;                  // see batch_work
  std::string program{build_id()};  // the program that bakes; clips of another one are not kept
};

enum class Plan { bake, keep, left_out, elsewhere };  // elsewhere: another shard's

struct PlannedReaction {
  Plan plan = Plan::bake;
  std::string digest;          // of the inputs: what the manifest says
  std::string journal_digest;  // of the inputs and the program: what the journal says
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

}  // namespace ukemi
