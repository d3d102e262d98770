// Figures on their way from one pose to another.
#pragma once

#include <vector>

#include "rise/whole_body.h"

namespace ukemi {

/// Share `u` of the way from `a` to `b`. Joints go straight in their charts, where ranges are nearly convex.
FigurePose between(const WholeBody& whole, const FigurePose& a, const FigurePose& b, double u);

/// What differs from the reference in one frame, on the reference of the next.
FigurePose carried_on(const FigurePose& reference, const FigurePose& figure, const FigurePose& next);

/// Means over neighbours, weighted by a bell of that width, which narrows towards both ends: these stay.
std::vector<FigurePose> smoothed(const WholeBody& whole, const std::vector<FigurePose>& figures,
                                 double sigma_frames);

/// 0 to 1, most of it at the end: a weight that is felt evenly, because it competes with ones 300 times less.
double growing(double x);

/// Skin of the trunk and the thighs: what bears while a body lies.
OuterSkin trunk_skin(const WholeBody& whole);
/// Height of the lowest point; 0 where there is none.
double lowest_of(const OuterSkin& skin, const BodyPose& pose);

}  // namespace ukemi
