#include "base/base64.h"

#include <algorithm>
#include <array>

namespace ukemi {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> digit_values() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::int8_t>(i);
  values['-'] = 62;  // the URL-safe alphabet
  values['_'] = 63;
  return values;
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  char* out = text.data();
  for (std::size_t i = 0; i < bytes.size(); i += 3, out += 4) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = std::uint32_t{bytes[i]} << 16;
    if (left > 1) word |= std::uint32_t{bytes[i + 1]} << 8;
    if (left > 2) word |= bytes[i + 2];
    for (std::size_t k = 0; k <= left; ++k) out[k] = kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

Base64Bytes base64_decoded(std::string_view text) {
  static constexpr std::array<std::int8_t, 256> kValues = digit_values();
  while (text.ends_with('=')) text.remove_suffix(1);
  Base64Bytes result;
  result.bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int value = kValues[static_cast<std::uint8_t>(text[i])];
    if (value < 0) {
      result.bad_at = i;
      return result;
    }
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    result.bytes.push_back(static_cast<std::uint8_t>(bits >> bit_count));
  }
  result.cut_off = text.size() % 4 == 1;
  return result;
}

}  // namespace ukemi
