// A reviewer's verdicts on a batch, as the review page writes them.
#pragma once

#include <filesystem>

#include "base/result.h"
#include "batch/plan.h"

namespace ukemi {

/// Takes the verdicts of a file into the plan's history and news: { "format": 1, "rejects": [{"character",
/// "name", "comment", "digest"}], "accepts": [{"character", "name"}] }.
/// 1. A rejected reaction that varies gets another take: the next seed.
/// 2. One that does not is left out, as the same would come again.
/// 3. An accepted one is no longer left out.
/// 4. A "digest" (may be left away) is the manifest's: where the reaction is another by now, the rejection
///    has been followed already and is passed over.
/// Errors: input (cannot be read, malformed, a reaction that the recipe does not describe).
Status take_rejects(const std::filesystem::path& file, BatchPlan& plan);

}  // namespace ukemi
