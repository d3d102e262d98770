// Bytes as text (RFC 4648).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ukemi {

/// With the standard alphabet, padded.
std::string base64(std::span<const std::uint8_t> bytes);

struct Base64Bytes {
  std::vector<std::uint8_t> bytes;
  std::size_t bad_at = std::string_view::npos;  // index of the first character that is no digit
  bool cut_off = false;                         // a last digit that makes no byte

  bool whole() const { return bad_at == std::string_view::npos && !cut_off; }
};

/// Also of the URL-safe alphabet and without padding. `bytes` end where the text stops being base64.
Base64Bytes base64_decoded(std::string_view text);

}  // namespace ukemi
