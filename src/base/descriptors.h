// Open files by their descriptors.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace ukemi {

/// Writes all of it, also where a signal comes between. False: errno says why, and part may be written.
bool write_all(int descriptor, std::span<const std::uint8_t> bytes);
bool write_all(int descriptor, std::string_view text);

}  // namespace ukemi
