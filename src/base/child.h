// Work that may crash, hang or grow without end, in a process of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "base/result.h"

namespace ukemi {

struct ChildLimits {
  std::size_t memory_bytes = std::size_t{4} << 30;  // beyond what this process has; none under a sanitizer
  std::size_t result_bytes = std::size_t{2} << 30;
  double processor_s = 60.0;
  double wall_s = 120.0;
};

/// What `work` returns, computed in a forked child. It is forked, not executed anew, so that it needs no
/// program of its own and works for users of the library; in a process with other threads `work` must not
/// need what they may hold locked (malloc is safe). The child writes no files, dies with its parent, and
/// nothing that it does to memory comes back but the bytes. `path` names the file in errors. Errors: input
/// (the child crashed, took too long, too much memory or sent too much), internal (no process could be made).
Result<std::vector<std::uint8_t>> run_in_child(const std::function<std::vector<std::uint8_t>()>& work,
                                               const ChildLimits& limits, const std::filesystem::path& path);

}  // namespace ukemi
