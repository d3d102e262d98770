// What a batch made, for people and programs: manifest.json and manifest.csv.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/record.h"
#include "batch/recipe.h"

namespace ukemi {

enum class ReactionStatus { done, failed, rejected };

/// One reaction of a manifest.
struct ManifestEntry {
  const Reaction* reaction = nullptr;
  ReactionStatus status = ReactionStatus::failed;
  std::string digest;
  std::optional<ReactionRecord> record;  // of what was baked
  std::string error;                     // why the reaction failed or was rejected
};

struct Manifest {
  const Recipe* recipe = nullptr;
  std::size_t planned = 0;  // reactions that the batch is to have
  std::vector<ManifestEntry> entries;
};

/// JSON, format 1. The same for every number of workers, shard split and resume.
std::string manifest_json(const Manifest& manifest);

/// The same as a table (RFC 4180). Texts that a spreadsheet would take for a formula get a ' before them.
std::string manifest_csv(const Manifest& manifest);

std::string_view name(ReactionStatus status);

}  // namespace ukemi
