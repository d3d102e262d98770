// What is drawn over a figure to explain it: joint axes, ranges of motion, the trail of the hips.
#pragma once

#include <vector>

#include "render/geometry.h"
#include "render/render.h"

namespace ukemi {

/// Axes of every joint's lower segment at the joint.
void add_joint_axes(Geometry& geometry, const Shot& shot, int frame);
/// A cone per joint: its polygon seen from the joint's centre, and where the joint points. Amber from 92 % of
/// the way to the edge on, red outside by more than half a degree.
void add_range_cones(Geometry& geometry, const Shot& shot, int frame);
/// The way up to the frame.
void add_trail(Geometry& geometry, const std::vector<Vec3>& hips, int frame);

}  // namespace ukemi
