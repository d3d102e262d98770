// Numbers that people write: read without regard to the locale, checked against what is legal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace ukemi {

/// Legal values of a number; ends are legal unless `above_min`.
struct Range {
  double min = 0.0;
  double max = 0.0;
  bool above_min = false;

  bool contains(double value) const { return (above_min ? value > min : value >= min) && value <= max; }
  std::string text() const;  // "1 to 1000", "above 0, at most 60"
};

/// The finite number that the whole of `text` is.
std::optional<double> number_in(std::string_view text);

/// The same, within `range`. Errors: usage.
Result<double> parse_number(std::string_view text, const Range& range);

}  // namespace ukemi
