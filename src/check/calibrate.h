// Thresholds of the active restriction from motion: above what standing and walking people do.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "judge/joint_speeds.h"
#include "restrict/active.h"

namespace ukemi {

struct CalibrationSettings {
  std::vector<std::string> files;           // beside the mannequin's own clips
  std::vector<std::string> standing_files;  // of which only calm standing is measured
  double factor = 3.0;                      // over the 99th percentile of standing
  bool walking = true;                      // no threshold below the 99th percentile of any walk
};

/// Speeds of joints in degrees per second, left and right together: index of the right or only joint.
struct Calibration {
  CalibrationSettings settings;
  std::vector<std::string> sources;  // names of the files whose clips were measured
  PerJoint<Vec3> standing_p99{};     // of all clips together
  PerJoint<Vec3> walking_p99{};      // the highest of the clips, each on its own
  PerJoint<double> standing_s{}, walking_s{};
  PerJoint<Vec3> thresholds{};
};

/// Speed at which a joint that hardly moves in the clips is held, degrees per second.
inline constexpr double kThresholdFloor = 120.0;

/// Errors: those of loading; a file that is not a humanoid.
Result<Calibration> calibrate(const CalibrationSettings& settings, Diagnostics& diagnostics);

/// As load_active_thresholds reads it, with what it was measured from.
std::string calibration_toml(const Calibration& calibration);
/// For people: both percentiles and the thresholds.
std::string calibration_text(const Calibration& calibration);

}  // namespace ukemi
