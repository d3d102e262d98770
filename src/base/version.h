// Which program this is.
#pragma once

#include <string>

namespace ukemi {

/// "ukemi 0.2.0"
std::string generator();

}  // namespace ukemi
