// Tables (RFC 4180).
#pragma once

#include <string>

namespace ukemi {

/// A text as a field: quoted where it has to be, with a ' before what a spreadsheet would run as a formula.
std::string csv_text(const std::string& text);

}  // namespace ukemi
