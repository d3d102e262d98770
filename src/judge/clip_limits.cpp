#include "judge/clip_limits.h"

#include <algorithm>
#include <cmath>

#include "humanoid/rotations.h"

namespace ukemi {
namespace {

/// Node that carries a segment, a fused one that of the segment above; -1 where there is none.
int carrier(const SegmentFrames& frames, Segment segment) {
  while (segment != Segment::pelvis && frames.node[index(segment)] < 0) segment = parent_of(segment);
  return frames.node[index(segment)];
}

/// The nodes whose rotations turn one node against another: the ways to the nearest node above both.
std::vector<int> nodes_between(const Skeleton& skeleton, int a, int b) {
  std::vector<int> nodes;
  for (const auto& [from, other] : {std::pair(a, b), std::pair(b, a)})
    for (int i = from; i >= 0 && i != other && !skeleton.is_ancestor(i, other); i = skeleton.nodes[i].parent)
      nodes.push_back(i);
  return nodes;
}

void count(const RangeOfMotion& range, const PerSegment<Quat>& rotations, const PerSegment<bool>& fused,
           ClipLimits& limits) {
  const PerJoint<SwingTwist> charts = charts_of(range, rotations);
  for (int j = 0; j < kJointCount; ++j) {
    if (fused[index(child_of(joint_at(j)))]) continue;
    const double outside = degrees(excess(range.joints[j], charts[j]));
    ++limits.samples;
    if (outside > 1.0) ++limits.over_1deg;
    if (outside <= limits.excess_max_deg) continue;
    limits.excess_max_deg = outside;
    limits.worst_joint = joint_at(j);
  }
}

/// Of two excesses in radians, see RangeKeeper.
bool judged_alike(double a, double b) {
  const auto on_one_side = [&](double threshold_deg) {
    return (degrees(a) > threshold_deg) == (degrees(b) > threshold_deg);
  };
  return std::abs(a - b) <= RangeKeeper::kKeyExcess && on_one_side(1.0) && on_one_side(5.0);
}

}  // namespace

ClipLimits clip_limits(const Skeleton& skeleton, const SegmentFrames& frames, const RangeOfMotion& range,
                       const std::vector<Pose>& poses) {
  PerSegment<bool> fused{};
  for (int s = 0; s < kSegmentCount; ++s) fused[s] = frames.node[s] < 0;
  ClipLimits limits;
  for (const Pose& pose : poses) count(range, rotations_of(skeleton, frames, pose), fused, limits);
  return limits;
}

ClipLimits clip_limits(const Humanoid& humanoid, const RangeOfMotion& range,
                       const std::vector<BodyPose>& poses) {
  PerSegment<bool> fused{};
  for (int s = 0; s < kSegmentCount; ++s) fused[s] = humanoid.segments[s].fused();
  ClipLimits limits;
  for (const BodyPose& pose : poses) count(range, rotations_of(pose), fused, limits);
  return limits;
}

RangeKeeper::RangeKeeper(const Skeleton& skeleton, const SegmentFrames& frames, const RangeOfMotion& range,
                         const std::vector<Pose>& whole)
    : skeleton_(skeleton), frames_(frames), range_(range) {
  for (int j = 0; j < kJointCount; ++j) {
    const Segment child = child_of(joint_at(j));
    if (frames.node[index(child)] >= 0)
      nodes_[j] = nodes_between(skeleton, frames.node[index(child)], carrier(frames, parent_of(child)));
  }
  for (const Pose& pose : whole) outside_.push_back(excesses(pose));
}

PerJoint<double> RangeKeeper::excesses(const Pose& pose) const {
  const PerJoint<SwingTwist> charts = charts_of(range_, rotations_of(skeleton_, frames_, pose));
  PerJoint<double> result{};
  for (int j = 0; j < kJointCount; ++j)
    if (!nodes_[j].empty()) result[j] = excess(range_.joints[j], charts[j]);
  return result;
}

std::vector<int> RangeKeeper::to_mend(std::size_t frame, const Pose& reduced) const {
  const PerJoint<double> outside = excesses(reduced);
  std::vector<int> nodes;
  for (int j = 0; j < kJointCount; ++j)
    if (!judged_alike(outside[j], outside_[frame][j])) nodes.insert(nodes.end(), nodes_[j].begin(), nodes_[j].end());
  return nodes;
}

}  // namespace ukemi
