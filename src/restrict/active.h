// Active restriction: when it acts (Era et al., section 4.2). The torque itself, T_f = -k I omega, is applied
// by simulate.
#pragma once

#include <string>

#include "base/math.h"
#include "base/result.h"
#include "base/segments.h"

namespace ukemi {

/// Least speed, rad/s, at which the restriction acts on (a_y, a_z, alpha) of each joint.
using ActiveThresholds = PerJoint<Vec3>;

/// "" reads assets/limits/active.toml. Errors: input, with file, line and joint.
Result<ActiveThresholds> load_active_thresholds(const std::string& file);

}  // namespace ukemi
