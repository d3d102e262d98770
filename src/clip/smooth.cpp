#include "clip/smooth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/low_pass.h"

namespace ukemi {
namespace {

using Value = Eigen::Matrix<double, 7, 1>;  // rotation x y z w, translation

constexpr double kReach = 4.0;  // periods of the cut-off beyond the ends, after which nothing is left of them

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

}  // namespace

void smooth(Clip& clip, double cutoff_hz) {
  if (clip.frames.size() < 3) return;
  const Butterworth filter(cutoff_hz, clip.fps);
  const auto reach = static_cast<std::size_t>(std::ceil(kReach * clip.fps / cutoff_hz));
  for (std::size_t node = 0; node < clip.frames.front().size(); ++node) {
    const std::vector<Value> values = zero_phase(values_of(clip, node), filter, reach, Beyond::turned);
    for (std::size_t f = 1; f + 1 < clip.frames.size(); ++f) {
      const Value& value = values[f];
      clip.frames[f][node].rotation = Quat(Eigen::Vector4d(value.head<4>())).normalized();
      clip.frames[f][node].translation = value.tail<3>();
    }
  }
}

}  // namespace ukemi
