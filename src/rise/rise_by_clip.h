// Getting up as somebody did: the body moves from how it lies to the first pose of a clip, then the clip
// leads.
#pragma once

#include <optional>

#include "rise/get_up.h"
#include "rise/rising_clip.h"
#include "rise/whole_body.h"

namespace ukemi {

/// A get-up that a clip leads, and how far the clip itself bends a joint beyond its range (where it is held).
struct LedGetUp {
  GetUp get_up;  // route "clip"; phases "shifts", "follows", "rises", "stands"
  double clip_excess_deg = 0.0;
  std::optional<Joint> clip_excess_joint;
};

/// From the lying pose into the clip and along it to its end.
/// 1. The difference from the clip fades over the time that the way into reach takes (ClipEntry::needed_s, at
///    least kShortest_s), with the velocity of the lying body (inertialised: Bollo, "Inertialization", GDC
///    2018); the clip gathers speed meanwhile.
/// 2. A part that bears without sliding in the clip stays where it came down; nothing sinks into the
///    floor y = 0 (skin as the whole body knows it), and joints stay in their ranges.
/// 3. The first frame is `lying`; `before` is the pose one frame before.
LedGetUp rise_by_clip(const WholeBody& whole, const RangeOfMotion& range, const BodyPose& before,
                      const BodyPose& lying, const RisingClip& clip, const ClipEntry& entry, double fps);

}  // namespace ukemi
