// Files: whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
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

/// Files that appear together. What is added has no name until commit() and vanishes with the process (on
/// file systems without such files it lies beside its target under a name of its own). A name that is a link
/// is followed and stays one; a file that is replaced keeps its permissions.
class PendingFiles {
 public:
  PendingFiles() = default;
  ~PendingFiles();
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;

  /// Errors: output (no space, no permission, a directory, a device).
  Status add(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
  Status add(const std::filesystem::path& path, std::string_view text);
  /// Errors: output; then the files from the failing one on are not there.
  Status commit();

 private:
  struct Pending {
    std::filesystem::path path;       // as the user wrote it
    std::filesystem::path target;     // links followed
    std::filesystem::path temporary;  // empty: nameless
    int descriptor = -1;
  };
  static bool place(Pending& file);
  std::vector<Pending> files_;
};

/// `folder / relative`, where that is a place below `folder`, also after links are followed; nothing for
/// absolute paths, "..", and links that lead out.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                const std::filesystem::path& relative);

/// A file of the project's assets folder: $UKEMI_ASSETS, share/ukemi beside the program's folder, or the
/// source tree (a build has a link to it beside its programs).
Result<std::filesystem::path> find_asset(const std::filesystem::path& relative);

}  // namespace ukemi
