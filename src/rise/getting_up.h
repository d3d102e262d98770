// A body that a fall has left on the floor gets up at the end of its trajectory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/result.h"
#include "body/trajectory.h"
#include "rise/get_up.h"
#include "rise/rising_clip.h"

namespace ukemi {

/// The clip of a library that was nearest to how the body lay.
struct NearestClip {
  std::string name;
  double from_s = 0.0;                                     // in the clip, where it is taken up
  double apart_m = 0.0, turned_deg = 0.0, needed_s = 0.0;  // see ClipEntry
  bool leads = false;                                      // else out of reach: the get-up is planned
  double excess_deg = 0.0;                                 // of the clip itself outside the ranges
  std::optional<Joint> excess_joint;
};

/// Seconds of the timeline.
struct GetUpTimes {
  std::string route;
  double begins_s = 0.0;
  double stands_s = 0.0;
  std::vector<GetUpPhase> phases;    // the last is "stands"
  std::vector<PlantedPart> planted;  // frames counted from that of begins_s
  std::optional<NearestClip> clip;   // of the library, where there is one
};

/// Keeps the last frame until `until_s`; props stay where they are.
void hold_last_frame(double until_s, Trajectory& trajectory);

/// Who gets up, and what from.
struct Riser {
  const ArticulatedBody& body;
  const RangeOfMotion& range;
  const BodyPose& standing;                   // in which a planned get-up ends
  const PerSegment<std::vector<Vec3>>& skin;  // outermost_skin, body/ground.h
  const std::vector<RisingClip>* library;     // null: none
};

/// Adds the frames in which the body gets up, after the last one: along the nearest clip of the library where
/// one is in reach, into its last pose; else as planned, into the standing pose. Nothing where it is on its
/// feet.
std::optional<GetUpTimes> add_get_up(const Riser& riser, const GetUpSettings& settings,
                                     Trajectory& trajectory);

/// "get_up", then every phase.
void add_get_up_marks(const GetUpTimes& times, Clip& clip);

}  // namespace ukemi
