// Skin on the floor: shapes are rounder than the skin they stand for, so a body at rest on its shapes may dip
// into the floor by a centimetre or three.
#pragma once

#include <vector>

#include "body/body.h"

namespace ukemi {

/// Points of the skin that can touch the floor first, in the frames of their segments, metres: the outermost
/// ones of each segment. What stands far out of the segment's shapes (a sword, a skirt) is left out.
PerSegment<std::vector<Vec3>> outermost_skin(const Character& character, const Humanoid& humanoid,
                                             const Pose& pose, const BodyPose& segments,
                                             const ArticulatedBody& body);

/// How far to raise frames whose skin lies `depth_m` below the floor, so that it lies no deeper than
/// `allowed_m`: smoothly over a tenth of a second and by `most_m` at most; the first frame not at all, and
/// those after it as far as a lift of 0.1 m/s gets, or one that keeps skin that sinks faster within 10 mm
/// more.
std::vector<double> lifts(const std::vector<double>& depth_m, double allowed_m, double most_m, double fps);

/// Raises frames whose skin lies below the floor (y = 0) by more than 5 mm, by 40 mm at most, see lifts.
/// Returns the largest lift, metres.
double lift_skin_above_floor(std::vector<BodyPose>& frames, double fps,
                             const PerSegment<std::vector<Vec3>>& skin);

}  // namespace ukemi
