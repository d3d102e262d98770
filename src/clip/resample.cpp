#include "clip/resample.h"

#include <algorithm>

namespace ukemi {
namespace {

// Rounding of a body that has not moved.
constexpr double kSameM = 1e-9;
constexpr double kSameRad = 1e-9;

bool same(const BodyPose& a, const BodyPose& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](const Rigid& x, const Rigid& y) {
    return (x.translation - y.translation).norm() <= kSameM &&
           angle_between(x.rotation, y.rotation) <= kSameRad;
  });
}

void continue_signs(Pose& pose, const Pose& previous) {
  for (std::size_t i = 0; i < pose.size(); ++i)
    pose[i].rotation = nearest_sign(pose[i].rotation, previous[i].rotation);
}

/// Segments that are, or hang on, a chain of several bones.
PerSegment<bool> shares_bend(const Humanoid& humanoid) {
  PerSegment<bool> result{};
  for (int s = 0; s < kSegmentCount; ++s)
    result[s] = humanoid.segments[s].chain.size() > 1 || result[index(parent_of(segment_at(s)))];
  return result;
}

/// The simulated segments have canonical rolls, the rig's have their own; both turn by the same rotation from
/// the start, and the rig's joint centres move with the simulated segments.
void measure(const BodyPose& rig_start, const BodyPose& rig, const BodyPose& start, const BodyPose& simulated,
             const Humanoid& humanoid, ResampleError& error) {
  const PerSegment<bool> shared = shares_bend(humanoid);
  for (int s = 0; s < kSegmentCount; ++s) {
    if (humanoid.segments[s].fused()) continue;
    const Rigid motion = simulated[s] * start[s].inverse();
    const Rigid wanted = motion * rig_start[s];
    const double turned = degrees(angle_between(wanted.rotation, rig[s].rotation));
    const double apart = (wanted.translation - rig[s].translation).norm();
    error.rotation_max_deg = std::max(error.rotation_max_deg, turned);
    if (humanoid.segments[s].chain.size() > 1) continue;
    error.position_max_m = std::max(error.position_max_m, apart);
    if (!shared[s]) error.position_single_bones_max_m = std::max(error.position_single_bones_max_m, apart);
  }
}

}  // namespace

Clip resample(const Character& character, const Humanoid& humanoid, const Pose& start,
              const BodyPose& start_segments, const Trajectory& trajectory, ResampleError& error) {
  const Skeleton& skeleton = character.skeleton;
  const BodyPose rig_start = segments_of(skeleton, humanoid, start);
  Clip clip;
  clip.fps = trajectory.fps;
  clip.frames.reserve(trajectory.frames.size());
  error = {};
  for (const BodyPose& segments : trajectory.frames) {
    Pose pose = clip.frames.empty() && same(segments, start_segments)
                    ? start
                    : pose_skeleton(skeleton, humanoid, start, start_segments, segments);
    continue_signs(pose, clip.frames.empty() ? start : clip.frames.back());
    measure(rig_start, segments_of(skeleton, humanoid, pose), start_segments, segments, humanoid, error);
    clip.frames.push_back(std::move(pose));
  }
  return clip;
}

}  // namespace ukemi
