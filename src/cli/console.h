// What the program says, and where: results to stdout, everything else to stderr.
#pragma once

#include <string>

#include "base/result.h"

namespace ukemi {

/// "ukemi: error: ..." and "  fix: ..." to stderr. Returns the exit status of the error.
int print_error(const Error& error);
void print_warnings(const Diagnostics& diagnostics);
/// A result, to stdout; control characters in it (names of a file may hold what terminals obey) are shown as
/// '?'. Returns `status`, or that of a failed write; a reader that went away is not a failure.
int print_result(const std::string& text, int status);
/// The same for JSON, byte by byte.
int print_json(const std::string& json, int status);

}  // namespace ukemi
