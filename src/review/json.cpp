#include "review/json.h"

#include <fmt/format.h>

#include <bit>

#include "base/base64.h"
#include "base/fnv.h"

namespace ukemi {
namespace {

static_assert(std::endian::native == std::endian::little, "packed() writes the memory as it is");

template <typename Number>
std::string packed_bytes(std::span<const Number> values) {
  return base64({reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()});
}

}  // namespace

std::string script_safe(std::string json) {
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string packed(std::span<const float> values) { return packed_bytes(values); }
std::string packed(std::span<const std::int16_t> values) { return packed_bytes(values); }
std::string packed(std::span<const std::uint16_t> values) { return packed_bytes(values); }
std::string packed(std::span<const std::uint32_t> values) { return packed_bytes(values); }

std::string content_hash(std::string_view bytes) {
  Fnv hash;
  hash.add(bytes);
  return fmt::format("{:016x}", hash.value());
}

}  // namespace ukemi
