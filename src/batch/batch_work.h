// What a worker of a batch does: bakes one reaction and writes its files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/record.h"
#include "batch/recipe.h"
#include "batch/workers.h"

namespace ukemi {

/// One job: {"reaction": INDEX, "digest": "...", "write": true}.
std::string batch_job(std::size_t reaction, const std::string& digest, bool write);

/// Takes such jobs, answers with record lines. Keeps the characters that it loaded last. Recipe and reactions
/// must outlive it; files go below `folder`.
Work batch_work(const Recipe& recipe, const std::vector<Reaction>& reactions, std::filesystem::path folder);

}  // namespace ukemi
