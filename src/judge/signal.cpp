#include "judge/signal.h"

#include <algorithm>
#include <cmath>

#include "base/low_pass.h"

namespace ukemi {
namespace {

constexpr double kPeriods = 3.0;        // of the cut-off that a course is continued by
constexpr double kHighestShare = 0.45;  // of the frame rate that a cut-off may be

}  // namespace

Course low_passed(const Course& values, double fps, double cutoff_hz) {
  if (values.size() < 3 || cutoff_hz >= kHighestShare * fps) return values;
  const Butterworth filter(cutoff_hz, fps);
  const auto wanted = static_cast<std::size_t>(std::ceil(kPeriods * fps / cutoff_hz));
  const std::size_t reach = std::min(wanted, values.size() - 1);
  return zero_phase(values, filter, reach, Beyond::turned);
}

Course rate_of(const Course& values, double fps) {
  Course rates(values.size(), Vec3::Zero());
  if (values.size() < 2) return rates;
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 1; i < last; ++i) rates[i] = 0.5 * fps * (values[i + 1] - values[i - 1]);
  rates.front() = fps * (values[1] - values[0]);
  rates.back() = fps * (values[last] - values[last - 1]);
  return rates;
}

double horizontal_norm(const Vec3& v) { return std::hypot(v.x(), v.z()); }

std::vector<double> norms(const Course& values) {
  std::vector<double> result;
  for (const Vec3& value : values) result.push_back(value.norm());
  return result;
}

std::vector<double> horizontal_norms(const Course& values) {
  std::vector<double> result;
  for (const Vec3& value : values) result.push_back(horizontal_norm(value));
  return result;
}

}  // namespace ukemi
