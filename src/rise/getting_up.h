// A body that a fall has left on the floor gets up at the end of its trajectory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/result.h"
#include "body/trajectory.h"
#include "rise/get_up.h"

namespace ukemi {

/// Seconds of the timeline.
struct GetUpTimes {
  std::string route;
  double begins_s = 0.0;
  double stands_s = 0.0;
  std::vector<GetUpPhase> phases;    // the last is "stands"
  std::vector<PlantedPart> planted;  // frames counted from that of begins_s
};

/// Keeps the last frame until `until_s`; props stay where they are.
void hold_last_frame(double until_s, Trajectory& trajectory);

/// Adds the frames in which the body gets up into its standing pose, after the last one; nothing where it is
/// on its feet. `outermost_skin`: body/ground.h.
std::optional<GetUpTimes> add_get_up(const ArticulatedBody& body, const RangeOfMotion& range,
                                     const BodyPose& standing,
                                     const PerSegment<std::vector<Vec3>>& outermost_skin,
                                     const GetUpSettings& settings, Trajectory& trajectory);

/// "get_up", then every phase.
void add_get_up_marks(const GetUpTimes& times, Clip& clip);

}  // namespace ukemi
