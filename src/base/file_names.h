// Names that any file system takes, made from what people write.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace ukemi {

/// The text as a file name without extension, legal on Linux, macOS and Windows: letters, digits, . _ - and
/// UTF-8 beyond ASCII stay (but not what turns the direction of writing); anything else, a run of
/// underscores, and dots and hyphens in front become one underscore; names that Windows reserves get one
/// behind them; at most 100 bytes. Never empty.
std::string file_name_from(std::string_view text);

/// Relative, and inside the folder that it is relative to (links are not looked at).
bool is_inside(const std::filesystem::path& path);

/// Gives every name once: where the name is taken (letter case ignored), NAME_2, NAME_3, ...
class UniqueNames {
 public:
  std::string take(const std::string& name);

 private:
  std::set<std::string> taken_;  // lower case
};

}  // namespace ukemi
