// Segments as people write them.
#pragma once

#include <string_view>

#include "base/result.h"
#include "base/segments.h"

namespace ukemi {

/// Errors: usage, with the nearest name.
Result<Segment> parse_segment(std::string_view text);

}  // namespace ukemi
