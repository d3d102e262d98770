#include "clip/smooth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ukemi {
namespace {

using Value = Eigen::Matrix<double, 7, 1>;  // rotation x y z w, translation

constexpr double kReach = 4.0;  // periods of the cut-off beyond the ends, after which nothing is left of them

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
  template <typename Iterator>
  void run(Iterator first, Iterator last) const {
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

std::vector<Value> values_of(const Clip& clip, std::size_t node) {
  std::vector<Value> values;
  for (const Pose& pose : clip.frames) {
    Value value;
    value << pose[node].rotation.coeffs(), pose[node].translation;
    if (!values.empty() && value.head<4>().dot(values.back().head<4>()) < 0.0) value.head<4>() *= -1.0;
    values.push_back(value);
  }
  return values;
}

std::vector<Value> continued(const std::vector<Value>& values, std::size_t reach) {
  const std::size_t last = values.size() - 1;
  std::vector<Value> result;
  for (std::size_t i = reach; i > 0; --i) result.push_back(2.0 * values.front() - values[std::min(i, last)]);
  result.insert(result.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= reach; ++i)
    result.push_back(2.0 * values.back() - values[last - std::min(i, last)]);
  return result;
}

}  // namespace

void smooth(Clip& clip, double cutoff_hz) {
  if (clip.frames.size() < 3) return;
  const Butterworth filter(cutoff_hz, clip.fps);
  const auto reach = static_cast<std::size_t>(std::ceil(kReach * clip.fps / cutoff_hz));
  for (std::size_t node = 0; node < clip.frames.front().size(); ++node) {
    std::vector<Value> values = continued(values_of(clip, node), reach);
    filter.run(values.begin(), values.end());
    filter.run(values.rbegin(), values.rend());
    for (std::size_t f = 1; f + 1 < clip.frames.size(); ++f) {
      const Value& value = values[reach + f];
      clip.frames[f][node].rotation = Quat(Eigen::Vector4d(value.head<4>())).normalized();
      clip.frames[f][node].translation = value.tail<3>();
    }
  }
}

}  // namespace ukemi
