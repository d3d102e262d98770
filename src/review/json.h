// JSON as the review page's scripts hold it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ukemi {

/// The same JSON with "<" escaped: it can end no script, whatever names it holds.
std::string script_safe(std::string json);

/// Base64 of the values' little-endian bytes.
std::string packed(std::span<const float> values);
std::string packed(std::span<const std::int16_t> values);
std::string packed(std::span<const std::uint16_t> values);
std::string packed(std::span<const std::uint32_t> values);

/// FNV-1a, 64 bits, as 16 hexadecimal digits.
std::string content_hash(std::string_view bytes);

}  // namespace ukemi
