// How abruptly a clip turns.
#pragma once

#include "base/animation.h"

namespace ukemi {

/// Second difference of a node's local angular velocity between frames.
struct JerkPeak {
  double deg_s3 = 0.0;
  int node = -1;
  double time_s = 0.0;  // the middle of the four frames it is computed from
};

/// The largest jerk of any node; none for clips of fewer than four frames.
JerkPeak largest_jerk(const Clip& clip);

}  // namespace ukemi
