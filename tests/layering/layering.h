// Who may include what: the rules of src/README.md, checked over a source tree.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ukemi {

struct LayeringReport {
  int files = 0;                        // .h and .cpp files read
  int includes = 0;                     // #include lines looked at
  int types = 0;                        // struct, class, enum, union and alias definitions of a namespace
  std::vector<std::string> violations;  // "room/file:line: what"
};

/// Checks every .h and .cpp file below `source` (the folder that holds the rooms' folders).
/// 1. A room includes itself and earlier rooms only; export and render never include each other, nor do
/// check, study, batch and review.
/// 2. A third party's header appears only in the .cpp files of the rooms that may use it; Eigen and fmt
/// anywhere.
/// 3. Project headers are named by their folder and exist; every other header is the standard's or the
/// system's.
/// 4. Every folder is a known room and every source file is a .h or a .cpp.
/// 5. A type that is defined outside an unnamed namespace has a name that no other type has (the one
/// definition rule; a compiler sees one file at a time and says nothing).
/// 6. No include cycle between modules, inside a room neither. A module is a .h and a .cpp of the same name.
/// 7. No room but render is longer than 3,600 lines.
LayeringReport check_layering(const std::filesystem::path& source);

/// Where a .h or .cpp file below `folder` takes random numbers that differ between standard libraries or from
/// run to run: the header <random>, rand, Eigen's Random(). Folders named node_modules or build are left out.
/// "file:line: what".
std::vector<std::string> foreign_random_numbers(const std::filesystem::path& folder);

}  // namespace ukemi
