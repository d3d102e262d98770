// Pictures of a comparison: the figures as a chart, and one of the hits side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/compare.h"

namespace ukemi {

struct NamedPicture {
  std::string name;  // "compare.png"
  std::vector<std::uint8_t> png;
};

/// Number, from 0, of the hit in which method (a) bends a joint farthest out, among those that no method
/// exploded in (among all, where there is none).
int hit_to_show(const Comparison& comparison);

/// compare.png: excess 99.9th percentile, maximum, and share of samples over 1 degree, per method.
/// hit.png: the hit `shown` with a, b, c and ours, one row each. slope.png, fall.png: the same of a ball that
/// rolls down a slope into the body and of a body that tips over and drops. a.png b.png c.png ours.png: each
/// row alone. unnatural.png: the joint of (a) that is farthest outside, close up. Joints outside their range
/// by more than 1 degree are marked in red. Errors: output when nothing can be drawn.
Result<std::vector<NamedPicture>> comparison_pictures(const Character& character,
                                                      const Comparison& comparison, int shown);

}  // namespace ukemi
