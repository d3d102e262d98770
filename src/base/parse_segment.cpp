#include "base/parse_segment.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/errors.h"
#include "base/nearest.h"

namespace ukemi {

Result<Segment> parse_segment(std::string_view text) {
  if (const auto segment = segment_named(text)) return *segment;
  if (const auto left = segment_named(std::string(text) + "_l"))
    return usage_error(fmt::format("'{}' does not say which side", text),
                       fmt::format("write '{}' or '{}'", name(*left), name(mirror_of(*left))));
  std::vector<std::string> names;
  for (int i = 0; i < kSegmentCount; ++i) names.emplace_back(name(segment_at(i)));
  return usage_error(fmt::format("unknown segment '{}'", text), suggestion(text, names));
}

}  // namespace ukemi
