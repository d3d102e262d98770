// Where blows come from.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace ukemi {

/// Where a blow comes from, seen from the character, radians.
struct Direction {
  double azimuth = 0.0;        // 0: from the front, pi/2: from the character's left
  double elevation = 0.0;      // positive: from above
  std::string text = "front";  // as the user wrote it
};

/// front, back, left, right, above, or AZIMUTH[,ELEVATION] in degrees (-360 to 360, -90 to 90). Errors:
/// usage.
Result<Direction> parse_direction(std::string_view text);

}  // namespace ukemi
