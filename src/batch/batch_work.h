// What a worker of a batch does: bakes one reaction and writes its files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bake/record.h"
#include "batch/recipe.h"
#include "batch/workers.h"

namespace ukemi {

/// One job: {"reaction": INDEX, "digest": "...", "write": true}.
std::string batch_job(std::size_t reaction, const std::string& digest, bool write);

/// Called in the worker once a reaction's files are written.
using AfterBake = std::function<void(const ReactionRecord& record, const BakeSettings& settings)>;

/// Takes such jobs, answers with record lines. Keeps the characters that it loaded last. Recipe and reactions
/// must outlive it; files go below `folder`. `after` may be empty.
Work batch_work(const Recipe& recipe, const std::vector<Reaction>& reactions, std::filesystem::path folder,
                AfterBake after = {});

}  // namespace ukemi
