// Offsets that fade without a jump.
#pragma once

#include <algorithm>

#include "base/math.h"
#include "body/on_ground.h"

namespace ukemi {

/// Seconds for which a velocity goes on that fades: t left^3, with left going from 1 to 0 over `carry_s`. Its
/// slope is 1 at 0.
inline double carried_s(double time_s, double carry_s) {
  const double left = std::max(0.0, 1.0 - time_s / carry_s);
  return time_s * left * left * left;
}

/// Where an offset with a velocity is, on its way to nothing (after Bollo, "Inertialization", GDC 2018).
struct Fading {
  Vec3 offset = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();

  static constexpr double kCarryOn_s = 0.3;  // in which the velocity fades

  Vec3 at(double time_s, double duration_s) const {
    return (1.0 - min_jerk(time_s / duration_s)) * offset +
           carried_s(time_s, std::min(duration_s, kCarryOn_s)) * velocity;
  }
};

}  // namespace ukemi
