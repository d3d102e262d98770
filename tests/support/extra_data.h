// Characters and motion made by others: the folder that UKEMI_EXTRA_DATA names, with its MANIFEST.tsv.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "support/tab_separated.h"

namespace ukemi {

/// The folder; nothing where the variable names none. Tests then skip themselves and say so (kNoExtraData).
inline std::optional<std::filesystem::path> extra_data() {
  const char* folder = std::getenv("UKEMI_EXTRA_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return folder;
}
inline constexpr const char* kNoExtraData =
    "UKEMI_EXTRA_DATA names no folder: files made by others are left out";

/// A row of the manifest.
struct ExtraFile {
  std::string file;     // relative to the folder
  std::string verdict;  // "humanoid", "refused-nonhumanoid" or "malformed"
};

/// The rows whose file starts with `prefix`; none where there is no manifest.
inline std::vector<ExtraFile> extra_files(const std::filesystem::path& folder,
                                          const std::string& prefix = "") {
  std::ifstream manifest(folder / "MANIFEST.tsv");
  std::vector<ExtraFile> files;
  std::string line;
  std::getline(manifest, line);
  std::size_t verdict = 0;
  for (const std::string& title : tab_separated(line)) {
    if (title == "expected verdict") break;
    ++verdict;
  }
  while (std::getline(manifest, line)) {
    const std::vector<std::string> cells = tab_separated(line);
    if (cells.size() > verdict && cells[0].starts_with(prefix)) files.push_back({cells[0], cells[verdict]});
  }
  return files;
}

}  // namespace ukemi
