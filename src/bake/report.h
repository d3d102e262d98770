// What a bake did, as JSON (format 1).
#pragma once

#include <cstddef>
#include <string>

#include "bake/baked.h"

namespace ukemi {

/// The report of a bake. Keys that do not apply are null. Beyond the obvious:
/// 1. humanoid.frames.SEGMENT.segment_from_node is a unit quaternion [x, y, z, w] that takes the node's
///    axes to the segment's anatomical axes: R_world_segment(t) = R_world_node(t) *
///    conjugate(segment_from_node), where R_world_node is the rotation of the node's world transform in a
///    y-up world. Evaluated at the start pose with canonical rolls; it holds for the whole clip.
/// 2. impact.position_jump_m: largest distance of a joint in the clip's first frame from where the clip it
///    starts from has it. velocity_jump_m_s: difference of the pelvis's velocity over the first frame from
///    that clip's, the blow's share included. Both null for a still start.
/// 3. clip.jerk_max_deg_s3 is that of largest_jerk, at clip.jerk_max_time_s in clip.jerk_max_node;
///    clip.jerk_below_12hz_max_deg_s3 the same of the clip low-passed as the captured motion was that
///    clip.jerk_real_motion_p999_deg_s3 comes from (null at 24 frames per second and fewer).
/// 4. Times of impact and clip.marks are in the clip (the lead counts), those of simulation after the impact.
/// 5. clip.root_curve_m: [x, z] of the pelvis since the first frame, one per frame, world metres; null with
///    the motion on the hips.
/// 6. timings_s.realtime_factor is the clip's length over the total.
std::string report_json(const std::string& character, const Character& loaded, const BakeSettings& settings,
                        const BakedFile& baked, const Diagnostics& diagnostics);

std::string_view name(Limits limits);
std::string_view name(Active active);
/// "adaptive" or "fixed:480".
std::string rate_name(double fixed_hz);

}  // namespace ukemi
