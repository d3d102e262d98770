#include "export/euler.h"

#include <cmath>

namespace ukemi {
namespace {

// Below this cosine of the middle angle the outer two angles cannot be told apart, and the first one may be
// chosen: what it leaves is off by the cosine, in radians.
constexpr double kGimbalCosine = 1e-11;

/// The equal of `angle` nearest to `near`.
double unwrapped(double angle, double near) {
  return angle + 2 * kPi * std::round((near - angle) / (2 * kPi));
}

Vec3 unwrapped(const Vec3& angles, const Vec3& near) {
  return {unwrapped(angles[0], near[0]), unwrapped(angles[1], near[1]), unwrapped(angles[2], near[2])};
}

}  // namespace

Quat from_euler(const Vec3& angles, const AxisOrder& order) {
  Quat result = Quat::Identity();
  for (int i = 0; i < 3; ++i) result = result * Quat(Eigen::AngleAxisd(angles[i], Vec3::Unit(order[i])));
  return result;
}

Vec3 to_euler(const Quat& rotation, const AxisOrder& order, const std::optional<Vec3>& previous) {
  const Mat3 m = rotation.normalized().toRotationMatrix();
  const auto [i, j, k] = order;
  const double sign = (i + 1) % 3 == j ? 1.0 : -1.0;
  // m(j, k) = -sign sin(a) cos(b), m(k, k) = cos(a) cos(b).
  const double cosine = std::hypot(m(j, k), m(k, k));
  double a =
      cosine > kGimbalCosine ? std::atan2(-sign * m(j, k), m(k, k)) : (previous ? (*previous)[0] : 0.0);
  // With a undone R_b R_c is left, of which every element used is well conditioned.
  const Mat3 rest = Eigen::AngleAxisd(-a, Vec3::Unit(i)).toRotationMatrix() * m;
  const Vec3 angles(a, std::atan2(sign * rest(i, k), rest(k, k)), std::atan2(sign * rest(j, i), rest(j, j)));
  if (!previous) return angles;
  const Vec3 first = unwrapped(angles, *previous);
  const Vec3 second = unwrapped(Vec3(angles[0] + kPi, kPi - angles[1], angles[2] + kPi), *previous);
  return (first - *previous).squaredNorm() <= (second - *previous).squaredNorm() ? first : second;
}

}  // namespace ukemi
