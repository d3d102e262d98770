// A humanoid map kept in a file: which node moves which segment.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/result.h"

namespace ukemi {

/// Segment name to node, as HumanoidOptions::map takes it. `text` is TOML or JSON: a table of segments, or a
/// document with such a table under `map`, like that of inspect --json, whose other keys do not matter.
/// Segments that are null or left out are for the program to find. Errors: input, with line and column for
/// TOML (syntax, unknown segment, a node that is not a text).
Result<std::map<std::string, std::string>> parse_map(std::string_view text, const std::string& file);

/// The same from a file of at most 1 MiB.
Result<std::map<std::string, std::string>> read_map(const std::string& file);

}  // namespace ukemi
