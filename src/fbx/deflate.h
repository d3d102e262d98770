// zlib's streams, as FBX holds its arrays.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ukemi {

/// Empty when zlib fails.
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes);
/// Exactly `size` bytes; nothing when the stream is malformed, shorter or longer.
std::optional<std::vector<std::uint8_t>> inflated(std::span<const std::uint8_t> stream, std::size_t size);

}  // namespace ukemi
