// The common errors, each in one line where it is made.
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace ukemi {

/// A command line, setting or recipe that has to change.
Error usage_error(std::string what, std::string fix);
/// The same, about the file it names.
Error usage_error(const std::filesystem::path& file, std::string what, std::string fix);
/// A file that is missing, malformed or of no use.
Error input_error(const std::filesystem::path& file, std::string what, std::string fix);
/// A file or folder that cannot be written.
Error output_error(const std::filesystem::path& file, std::string what, std::string fix);

/// A simulation that failed.
Error simulation_error(std::string what, std::string fix);
/// A fault of the program's own, or of the libraries it was built with.
Error internal_error(std::string what, std::string fix);

/// The error with the place in its file: anything with a 1-based `line` and `column`.
template <typename Place>
Error error_at(const Place& place, Error error) {
  error.line = static_cast<int>(place.line);
  error.column = static_cast<int>(place.column);
  return error;
}

/// The error about a joint, segment or node.
Error error_about(std::string joint, Error error);

}  // namespace ukemi
