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

/// Keeps the joints of a clip inside their ranges while its keys are reduced: a joint may lie kKeyExcess
/// outside, or farther than in the whole clip by so much where that is outside itself.
class RangeKeeper {
 public:
  static constexpr double kKeyExcess = radians(0.05);

  RangeKeeper(const Skeleton& skeleton, const SegmentFrames& frames, const RangeOfMotion& range,
              const std::vector<Pose>& whole);

  /// Nodes between the segments of joints that lie too far outside at a frame, see ExactRotations.
  std::vector<int> too_far(std::size_t frame, const Pose& reduced) const;

 private:
  PerJoint<double> excesses(const Pose& pose) const;

  const Skeleton& skeleton_;
  SegmentFrames frames_;
  RangeOfMotion range_;
  PerJoint<std::vector<int>> nodes_;       // that turn a joint; none where it is fused
  std::vector<PerJoint<double>> allowed_;  // radians, per frame
};

}  // namespace ukemi
