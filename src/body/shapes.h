// Collision shapes: fitted to the skin where there is one, to the table of proportions otherwise.
#pragma once

#include <optional>
#include <vector>

#include "body/body.h"

namespace ukemi {

/// Vertices of the skin in the frames of the segments that move them most, metres.
PerSegment<std::vector<Vec3>> skin_of_segments(const Character& character, const Humanoid& humanoid,
                                               const Pose& pose, const BodyPose& segments);

/// Shapes of one segment. `end`: where the next segment (or the finger, toe or crown) begins, segment frame.
std::vector<Shape> fit_shapes(Segment segment, const Vec3& end, double height_m,
                              const std::vector<Vec3>& skin);

}  // namespace ukemi
