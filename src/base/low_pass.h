// A low-pass filter without delay, for numbers and vectors over time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/math.h"

namespace ukemi {

/// Second-order Butterworth, -3 dB at the cut-off: y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y'', the bilinear
/// transform of 1 / (s^2 + sqrt(2) s + 1) (Oppenheim & Schafer, Discrete-Time Signal Processing, 7.1.2).
struct Butterworth {
  double b0, b1, b2, a1, a2;

  Butterworth(double cutoff_hz, double rate_hz) {
    const double k = std::tan(kPi * cutoff_hz / rate_hz);
    const double scale = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
    b0 = k * k * scale;
    b1 = 2.0 * b0;
    b2 = b0;
    a1 = 2.0 * (k * k - 1.0) * scale;
    a2 = (1.0 - std::sqrt(2.0) * k + k * k) * scale;
  }

  /// In place; starts as if the first value had always been there.
  template <typename Iterator>
  void run(Iterator first, Iterator last) const {
    using Value = typename std::iterator_traits<Iterator>::value_type;
    Value x1 = *first, x2 = *first, y1 = *first, y2 = *first;
    for (; first != last; ++first) {
      const Value x = *first;
      const Value y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = x;
      y2 = y1;
      y1 = y;
      *first = y;
    }
  }
};

/// How a sequence goes on beyond its ends.
enum class Beyond {
  mirrored,  // backwards: a level stays a level
  turned,    // turned about the end point: a steady motion stays as it is
};

/// The filter run forwards and backwards: no delay, half the amplitude at `cutoff_hz`. Before the first and
/// after the last of `values` (at least one) it reads `reach` more, made by `beyond`; where they run out the
/// farthest stays.
template <typename Value>
std::vector<Value> zero_phase(const std::vector<Value>& values, const Butterworth& filter, std::size_t reach,
                              Beyond beyond) {
  const std::size_t last = values.size() - 1;
  const auto further = [&](const Value& end, const Value& mirror) -> Value {
    if (beyond == Beyond::mirrored) return mirror;
    return 2.0 * end - mirror;
  };
  std::vector<Value> padded;
  padded.reserve(values.size() + 2 * reach);
  for (std::size_t i = reach; i > 0; --i)
    padded.push_back(further(values.front(), values[std::min(i, last)]));
  padded.insert(padded.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= reach; ++i)
    padded.push_back(further(values.back(), values[last - std::min(i, last)]));
  filter.run(padded.begin(), padded.end());
  filter.run(padded.rbegin(), padded.rend());
  const auto first = padded.begin() + static_cast<std::ptrdiff_t>(reach);
  return {first, first + static_cast<std::ptrdiff_t>(values.size())};
}

}  // namespace ukemi
