#include "base/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>

namespace ukemi {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

double ranked(std::vector<double> values, std::size_t rank) {
  assert(rank < values.size());
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double exceeded_by(std::vector<double> above_zero, long count, double share) {
  const auto above = static_cast<std::size_t>(std::floor(share * static_cast<double>(count)));
  if (above >= above_zero.size()) return 0.0;
  const auto nth = above_zero.begin() + static_cast<std::ptrdiff_t>(above);
  std::nth_element(above_zero.begin(), nth, above_zero.end(), std::greater<>());
  return *nth;
}

double quantile_of_time(std::vector<TimedValue> values, double share) {
  std::sort(values.begin(), values.end(),
            [](const TimedValue& a, const TimedValue& b) { return a.value < b.value; });
  double total_s = 0.0, passed_s = 0.0;
  for (const TimedValue& value : values) total_s += value.seconds;
  for (const TimedValue& value : values) {
    passed_s += value.seconds;
    if (passed_s >= share * total_s * (1.0 - 1e-12)) return value.value;
  }
  return 0.0;
}

}  // namespace ukemi
