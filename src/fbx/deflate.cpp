#include "fbx/deflate.h"

#include <zlib.h>

namespace ukemi {
namespace {

// zlib compresses 1032 to 1 at best: a file that claims more is malformed, and gets no memory for it.
constexpr std::size_t kMostRatio = 1032;

}  // namespace

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> stream(size);
  const int result = compress2(stream.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 6);
  stream.resize(result == Z_OK ? size : 0);
  return stream;
}

std::optional<std::vector<std::uint8_t>> inflated(std::span<const std::uint8_t> stream, std::size_t size) {
  if (size / kMostRatio > stream.size()) return std::nullopt;
  std::vector<std::uint8_t> bytes(size + 1);  // one more, to notice what is longer
  uLongf length = static_cast<uLongf>(bytes.size());
  const int result = uncompress(bytes.data(), &length, stream.data(), static_cast<uLong>(stream.size()));
  if (result != Z_OK || length != size) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

}  // namespace ukemi
