// Which frames of a clip a contact sheet shows.
#pragma once

#include <string>
#include <vector>

#include "base/animation.h"

namespace ukemi {

struct Moment {
  int frame = 0;
  std::string phase;  // names of the marks at this frame, else empty
};

/// At most `count` frames in order: the first, the marked ones and the last, then what divides the motion
/// between them most evenly by the way that the points travel, so that fast parts get more frames, above all
/// just after the impact. The fastest frame is a marked one too ("peak speed"). A rest that lasts to the end
/// is named at the last frame. `points[frame]` are places in metres, as many in every frame. Contract: the
/// clip has a frame, count > 0.
std::vector<Moment> choose_moments(const Clip& clip, const std::vector<std::vector<Vec3>>& points, int count);

/// Mean speed of the points at each frame, m/s, averaged over three frames.
std::vector<double> mean_speeds(const Clip& clip, const std::vector<std::vector<Vec3>>& points);

/// The frame at which half the points' way is done, from the impact (or the start) on.
int halfway_frame(const Clip& clip, const std::vector<std::vector<Vec3>>& points);

}  // namespace ukemi
