// Random numbers of tests: those of base/random.h, so that a test sees the same ones everywhere.
#pragma once

#include <cmath>
#include <cstddef>

#include "base/math.h"
#include "base/random.h"

namespace ukemi::test {

/// Each coordinate in [-size, size).
inline Vec3 random_vector(Random& random, double size = 1.0) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = random.uniform(-size, size);
  return v;
}

inline Vec2 random_vector2(Random& random, double size = 1.0) {
  Vec2 v;
  for (int i = 0; i < 2; ++i) v[i] = random.uniform(-size, size);
  return v;
}

/// Every rotation as likely as any other (Shoemake 1992).
inline Quat random_rotation(Random& random) {
  const double u = random.uniform(0.0, 1.0);
  const double a = random.uniform(-kPi, kPi), b = random.uniform(-kPi, kPi);
  const double near = std::sqrt(1.0 - u), far = std::sqrt(u);
  return {far * std::cos(b), near * std::sin(a), near * std::cos(a), far * std::sin(b)};
}

/// By at most `most` radians about any axis.
inline Quat random_rotation(Random& random, double most) {
  const Vec3 axis = random_vector(random).normalized();
  return exp_rotation(random.uniform(0.0, most) * axis);
}

/// One of 0, 1, ... count - 1.
inline std::size_t random_below(Random& random, std::size_t count) { return random.next() % count; }

}  // namespace ukemi::test
