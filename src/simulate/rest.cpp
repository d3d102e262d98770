#include "simulate/rest.h"

namespace ukemi {
namespace {

constexpr double kRestSpeed = 0.02;   // m/s
constexpr double kRestTurning = 0.1;  // rad/s
constexpr double kRestSpan_s = 0.25;

}  // namespace

void RestWatch::observe(double time_s, double h, double speed_m_s, double turning_rad_s) {
  still_s_ = speed_m_s < kRestSpeed && turning_rad_s < kRestTurning ? still_s_ + h : 0.0;
  if (still_s_ >= kRestSpan_s && !since_s_) since_s_ = time_s - still_s_;
}

}  // namespace ukemi
