#include "judge/signal.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kPeriods = 3.0;        // of the cut-off that a course is continued by
constexpr double kHighestShare = 0.45;  // of the frame rate that a cut-off may be

/// y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y'', the bilinear transform of 1 / (s^2 + sqrt(2) s + 1).
struct Butterworth {
  double b0, b1, b2, a1, a2;

  Butterworth(double cutoff_hz, double fps) {
    const double k = std::tan(kPi * cutoff_hz / fps);
    const double scale = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
    b0 = k * k * scale;
    b1 = 2.0 * b0;
    b2 = b0;
    a1 = 2.0 * (k * k - 1.0) * scale;
    a2 = (1.0 - std::sqrt(2.0) * k + k * k) * scale;
  }

  /// Starts as if the first value had always been there.
  template <typename Iterator>
  void run(Iterator first, Iterator last) const {
    Vec3 x1 = *first, x2 = *first, y1 = *first, y2 = *first;
    for (; first != last; ++first) {
      const Vec3 x = *first;
      const Vec3 y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = x;
      y2 = y1;
      y1 = y;
      *first = y;
    }
  }
};

Course continued(const Course& values, std::size_t reach) {
  const std::size_t last = values.size() - 1;
  Course result;
  result.reserve(values.size() + 2 * reach);
  for (std::size_t i = reach; i > 0; --i) result.push_back(2.0 * values.front() - values[i]);
  result.insert(result.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= reach; ++i) result.push_back(2.0 * values.back() - values[last - i]);
  return result;
}

}  // namespace

Course low_passed(const Course& values, double fps, double cutoff_hz) {
  if (values.size() < 3 || cutoff_hz >= kHighestShare * fps) return values;
  const Butterworth filter(cutoff_hz, fps);
  const auto wanted = static_cast<std::size_t>(std::ceil(kPeriods * fps / cutoff_hz));
  const std::size_t reach = std::min(wanted, values.size() - 1);
  Course padded = continued(values, reach);
  filter.run(padded.begin(), padded.end());
  filter.run(padded.rbegin(), padded.rend());
  const auto first = padded.begin() + static_cast<std::ptrdiff_t>(reach);
  return {first, first + static_cast<std::ptrdiff_t>(values.size())};
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

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
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
