// How far the frames of a clip lie outside ranges of motion, and how far its keys may lead it there.
#pragma once

#include <optional>
#include <vector>

#include "clip/frames.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// Over all frames and joints of segments that are not fused.
struct ClipLimits {
  long samples = 0;
  long over_1deg = 0;
  double excess_max_deg = 0.0;
  std::optional<Joint> worst_joint;
};
ClipLimits clip_limits(const Skeleton& skeleton, const SegmentFrames& frames, const RangeOfMotion& range,
                       const std::vector<Pose>& poses);
/// The same of simulated segments.
ClipLimits clip_limits(const Humanoid& humanoid, const RangeOfMotion& range,
                       const std::vector<BodyPose>& poses);

/// Keeps a clip's joints as far outside their ranges as they are while its keys are reduced:
///  1. how far a joint lies outside changes by kKeyExcess at most, up or down;
///  2. what lies over 1 or 5 degrees outside is the same, so that figures of the reduced and of the whole clip
///     count the same samples.
class RangeKeeper {
 public:
  static constexpr double kKeyExcess = radians(0.05);

  RangeKeeper(const Skeleton& skeleton, const SegmentFrames& frames, const RangeOfMotion& range,
              const std::vector<Pose>& whole);

  /// Nodes between the segments of joints that break 1 or 2 at a frame, see ExactRotations.
  std::vector<int> to_mend(std::size_t frame, const Pose& reduced) const;

 private:
  PerJoint<double> excesses(const Pose& pose) const;

  const Skeleton& skeleton_;
  SegmentFrames frames_;
  RangeOfMotion range_;
  PerJoint<std::vector<int>> nodes_;      // that turn a joint; none where it is fused
  std::vector<PerJoint<double>> outside_;  // radians, per frame of the whole clip
};

}  // namespace ukemi
