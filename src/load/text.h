// Text helpers of the readers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace ukemi::load {

/// Nodes or joints of a file.
inline constexpr std::size_t kMostNodes = std::size_t{1} << 18;

/// True when the two are the same but for ASCII case.
bool same_word(std::string_view a, std::string_view b);

/// The number at the start of `text` (no locale, an optional + is allowed) and how many characters it takes;
/// nothing when there is none or it is not finite.
struct LeadingNumber {
  double value = 0.0;
  std::size_t length = 0;
};
std::optional<LeadingNumber> leading_number(std::string_view text);
/// The number that `text` is, all of it.
std::optional<double> whole_number(std::string_view text);

/// A name for output: valid UTF-8 as it is, anything else read as Latin-1.
std::string utf8_name(std::string_view bytes);

/// `text` shortened to what fits into a message, control characters shown as '?'.
std::string quoted(std::string_view text);

}  // namespace ukemi::load
