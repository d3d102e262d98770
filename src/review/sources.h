// The reactions that a review page shows, as a batch's manifest or the files of a folder tell them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// One reaction. Paths are relative to the reviewed folder; empty where there is none.
/// Contract: settings_json and figures_json are JSON objects; what does not apply is null or missing.
struct ReviewSource {
  std::string character;
  std::string name;
  std::string status = "done";  // done, failed, rejected
  std::string error;            // of a reaction that failed
  std::string digest;           // of the baked reaction; "" where it is unknown
  std::filesystem::path clip;   // that is played: the first .glb, else .gltf, else .bvh of the outputs
  std::filesystem::path report;
  std::filesystem::path sheet;
  std::vector<std::string> outputs;
  std::vector<std::string> warnings;
  std::string settings_json = "{}";
  std::string figures_json = "{}";
};

struct ReviewSources {
  std::string recipe;  // name of the recipe; "" without a manifest
  std::vector<ReviewSource> reactions;
};

/// Errors: see write_review.
Result<ReviewSources> review_sources(const std::filesystem::path& folder, Diagnostics& diagnostics);

/// Which of a reaction's outputs is played: the first .glb, else .gltf, else .bvh; "" for none.
std::filesystem::path clip_among(const std::vector<std::string>& outputs);

/// SHA-256 of the folder's manifest; "" where there is none.
std::string manifest_digest(const std::filesystem::path& folder);

}  // namespace ukemi
