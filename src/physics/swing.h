// One link on a ball joint, without gravity: the passive restriction on its own.
#pragma once

#include <vector>

#include "base/result.h"
#include "physics/restriction.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// The link has the same inertia about every axis and is at rest at the start; what it hangs on stands still.
struct SwingSettings {
  Limits limits = Limits::edges;
  Vec2 start = Vec2::Zero();  // swing at the start
  /// Angular acceleration, rad/s^2, that pulls along this direction of the (a_y, a_z) plane: a torque of
  /// inertia times swing_row(chart, pull).
  Vec2 pull = Vec2::UnitX();
  double damping = 0.0;  // 1/s
  double duration_s = 1.0;
  double rate_hz = 480.0;
};

/// Charts at the start and after every step. Errors: simulation.
Result<std::vector<SwingTwist>> swing_joint(const JointRange& range, const SwingSettings& settings);

}  // namespace ukemi
