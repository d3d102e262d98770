// Where a share of some numbers lies.
#pragma once

#include <cstddef>
#include <vector>

namespace ukemi {

/// The value below which a share of the values lies, interpolated linearly; 0 for none.
double quantile(std::vector<double> values, double share);

/// The value of a rank, 0 the least; the rank lies within.
double ranked(std::vector<double> values, std::size_t rank);

/// The value that `share` of `count` numbers lie above, where only those above 0 are given; 0 where they are
/// fewer than that.
double exceeded_by(std::vector<double> above_zero, long count, double share);

/// A value that held for a time.
struct TimedValue {
  double value = 0.0;
  double seconds = 0.0;
};

/// The least value that is not exceeded for `share` of the time; 0 for none.
double quantile_of_time(std::vector<TimedValue> values, double share);

}  // namespace ukemi
