#include "load/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace ukemi::load {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Length of the UTF-8 sequence at the start of `bytes`; 0 when it is not valid.
std::size_t sequence_length(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  const std::uint8_t first = at(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || bytes.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((at(i) & 0xC0) != 0x80) return 0;
  if (first == 0xE0 && at(1) < 0xA0) return 0;  // overlong
  if (first == 0xED && at(1) > 0x9F) return 0;  // surrogates
  if (first == 0xF0 && at(1) < 0x90) return 0;  // overlong
  if (first == 0xF4 && at(1) > 0x8F) return 0;  // beyond U+10FFFF
  return length;
}

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = sequence_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<LeadingNumber> leading_number(std::string_view text) {
  const std::size_t plus = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
  LeadingNumber number;
  const char* end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data() + plus, end, number.value);
  if (error != std::errc() || !std::isfinite(number.value)) return std::nullopt;
  number.length = static_cast<std::size_t>(after - text.data());
  return number;
}

std::optional<double> whole_number(std::string_view text) {
  const auto number = leading_number(text);
  if (!number || number->length != text.size()) return std::nullopt;
  return number->value;
}

std::string utf8_name(std::string_view bytes) {
  if (is_utf8(bytes)) return std::string(bytes);
  std::string name;
  for (const char c : bytes) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (byte < 0x80) {
      name += c;
    } else {
      name += static_cast<char>(0xC0 | (byte >> 6));
      name += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return name;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string short_text = utf8_name(text.substr(0, kLongest));
  for (char& c : short_text)
    if (static_cast<std::uint8_t>(c) < 0x20 || c == 0x7F) c = '?';
  return "'" + short_text + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace ukemi::load
