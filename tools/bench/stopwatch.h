// What an engine's steps cost on this thread, and what was in them.
#pragma once

#include <ctime>

namespace ukemi {

/// CPU time of this thread.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Sums over calls of the engine's step, those included that are taken back.
struct EngineCost {
  double engine_s = 0.0;
  double counting_s = 0.0;  // spent on these figures
  long calls = 0;
  long rows = 0;      // of constraints
  long contacts = 0;  // points
};

/// Of this thread since the last reset_engine_cost.
EngineCost engine_cost();
void reset_engine_cost();

}  // namespace ukemi
