// Which program this is.
#pragma once

#include <string>

namespace ukemi {

/// "ukemi 0.1.0"
std::string generator();

}  // namespace ukemi
