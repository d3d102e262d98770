// When everything has come to rest.
#pragma once

#include <optional>

namespace ukemi {

class RestWatch {
 public:
  /// After an accepted step of length h that ended at `time_s`, with the largest speeds of the body.
  void observe(double time_s, double h, double speed_m_s, double turning_rad_s);
  /// Time from which everything has been at rest; known once that has lasted for a while.
  const std::optional<double>& since_s() const { return since_s_; }

 private:
  double still_s_ = 0.0;
  std::optional<double> since_s_;
};

}  // namespace ukemi
