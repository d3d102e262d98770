#include "base/numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "base/errors.h"

namespace ukemi {

std::string Range::text() const {
  return above_min ? fmt::format("above {}, at most {}", min, max) : fmt::format("{} to {}", min, max);
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || parsed != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<double> parse_number(std::string_view text, const Range& range) {
  const auto value = number_in(text);
  const std::string fix = "give a number, " + range.text();
  if (!value) return usage_error(fmt::format("'{}' is not a number", text), fix);
  if (!range.contains(*value)) return usage_error(fmt::format("{} is out of range", text), fix);
  return *value;
}

}  // namespace ukemi
