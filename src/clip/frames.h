// Which way the anatomical segments sit in their nodes: written beside a baked clip, read back from it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/animation.h"
#include "base/math.h"
#include "base/segments.h"
#include "base/skeleton.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// R_world_segment(t) = R_world_node(t) * conjugate(segment_from_node), for a whole clip.
struct SegmentFrames {
  PerSegment<int> node{};  // -1: the segment is fused
  PerSegment<Quat> segment_from_node{};
};

/// The frames that `segments` have in the nodes of `pose`.
SegmentFrames segment_frames(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose,
                             const BodyPose& segments);

/// The segments' rotations in a pose, up to a rotation common to all of them. A fused one has that of its
/// parent.
PerSegment<Quat> rotations_of(const Skeleton& skeleton, const SegmentFrames& frames, const Pose& pose);

/// The same frames in a skeleton that stands in the same pose with other axes. `nodes`: node of the first
/// skeleton for each node of the second; `second_from_first`: rotation between the worlds of the poses. A
/// segment whose node the second lacks is fused there.
SegmentFrames moved_frames(const Skeleton& skeleton, const SegmentFrames& frames, const Pose& pose,
                           const Quat& second_from_first, const std::vector<int>& nodes,
                           const Skeleton& second, const Pose& second_pose);

/// What the extras of a baked animation hold beside its frames and marks.
struct ClipFacts {
  std::string root_motion = "hips";
  std::optional<Pose> additive_from;                 // an additive clip: the pose it is the difference from
  std::vector<std::pair<Joint, JointRange>> ranges;  // in force, where they are not the human ones
  bool on_rest = false;                              // an additive clip that stands on the rest pose
};

/// The extras of a baked animation: {"ukemi": {"format": 1, "generator": ..., "segments": {SEGMENT: {"node",
/// "segment_from_node": [x, y, z, w]}}, "marks": [{"name", "time_s"}], "root_motion", "additive", "from":
/// {NODE:
/// {"translation", "rotation", "scale"}}, "ranges": {JOINT: {"polygon", "twist" (radians),
/// "parent_from_joint", "reference"}}}}; null for a fused segment. "from", of an additive clip, lists the
/// nodes that do not rest in the pose it is added to; "ranges" the joints whose range in force is not the
/// human one. "on_rest", true: values stand on the rest pose.
std::string animation_extras(const Skeleton& skeleton, const SegmentFrames& frames,
                             const std::vector<Mark>& marks = {}, const ClipFacts& facts = {});

/// The frames in an animation's extras; nothing where there are none or they do not fit the skeleton.
std::optional<SegmentFrames> frames_in_extras(const Skeleton& skeleton, std::string_view extras_json);

/// The range that the bake of an animation was judged by: `human` with the joints that its extras change.
RangeOfMotion range_in_extras(RangeOfMotion human, std::string_view extras_json);

/// The marks in an animation's extras; empty where there are none or they are malformed.
std::vector<Mark> marks_in_extras(std::string_view extras_json);

}  // namespace ukemi
