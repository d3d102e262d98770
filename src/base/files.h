// Files: whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// Whole content of a regular file. Errors: input (missing, directory, FIFO, unreadable, larger than
/// max_bytes).
Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Writes beside the target and renames: the file appears whole or not at all. Errors: output.
Status write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Status write_file(const std::filesystem::path& path, std::string_view text);

/// A file of the project's assets folder: $UKEMI_ASSETS, share/ukemi beside the program's folder, or the
/// source tree.
Result<std::filesystem::path> find_asset(const std::filesystem::path& relative);

}  // namespace ukemi
