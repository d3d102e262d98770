// Bone maps as TOML and JSON.
#include "base/segments.h"
#include "bones/map_file.h"
#include "fuzz/checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  const auto map = parse_map(fuzz::text_of(data, size), "map.toml");
  if (!map) {
    fuzz::require_clear(map.error());
    return 0;
  }
  for (const auto& [segment, node] : *map)
    fuzz::require(segment_named(segment).has_value(), "a map names segments");
  return 0;
}
