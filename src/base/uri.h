// Names in URIs.
#pragma once

#include <string>
#include <string_view>

namespace ukemi {

/// "a%20b" as "a b". Escapes that are malformed stand for themselves: some exporters write names as they are.
std::string percent_decoded(std::string_view text);

}  // namespace ukemi
