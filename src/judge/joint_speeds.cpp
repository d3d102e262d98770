#include "judge/joint_speeds.h"

#include <algorithm>
#include <cmath>

#include "base/low_pass.h"
#include "clip/frames.h"

namespace ukemi {
namespace {

constexpr double kGlitch = radians(2500.0);                 // rad/s
constexpr std::size_t kAroundGlitch = 3;                    // frames
constexpr double kAround_s = 0.25;                          // before and after a frame, for its activity
constexpr double kStandingSpeed = 0.1;                      // m/s, of the pelvis
constexpr double kCalmSpeed = 0.4;                          // m/s, of every other segment
constexpr double kWalkingSpeed = 0.5, kRunningSpeed = 2.2;  // m/s, of the pelvis, horizontally
constexpr double kUpright = radians(30.0);                  // of the pelvis

/// Largest mean speed of the segments (but the pelvis) over a span of poses.
double fastest_segment(const BodyPose& before, const BodyPose& after, double span_s) {
  double fastest = 0.0;
  for (int i = 1; i < kSegmentCount; ++i)
    fastest = std::max(fastest, (after[i].translation - before[i].translation).norm() / span_s);
  return fastest;
}

Activity activity_of(const std::vector<BodyPose>& poses, std::size_t frame, std::size_t around, double fps) {
  const std::size_t first = frame > around ? frame - around : 0;
  const std::size_t last = std::min(frame + around, poses.size() - 1);
  const double span_s = static_cast<double>(last - first) / fps;
  const Rigid& now = poses[frame][index(Segment::pelvis)];
  const Vec3 up = now.rotation * Vec3::UnitY();
  if (up.y() < std::cos(kUpright) || span_s < kAround_s) return Activity::other;
  const Vec3 moved =
      (poses[last][index(Segment::pelvis)].translation - poses[first][index(Segment::pelvis)].translation) /
      span_s;
  const double speed = std::hypot(moved.x(), moved.z());
  if (speed > kWalkingSpeed) return speed < kRunningSpeed ? Activity::walking : Activity::other;
  if (moved.norm() > kStandingSpeed) return Activity::other;
  const std::size_t step = std::max<std::size_t>(1, around / 5);
  for (std::size_t f = first; f + step <= last; f += step)
    if (fastest_segment(poses[f], poses[f + step], static_cast<double>(step) / fps) > kCalmSpeed)
      return Activity::other;
  return Activity::standing;
}

std::vector<bool> glitches(const std::vector<Vec3>& speeds) {
  std::vector<bool> result(speeds.size(), false);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (speeds[i].norm() < kGlitch) continue;
    const std::size_t last = std::min(i + kAroundGlitch, speeds.size() - 1);
    for (std::size_t j = i > kAroundGlitch ? i - kAroundGlitch : 0; j <= last; ++j) result[j] = true;
  }
  return result;
}

/// Levels beyond the ends; a cut-off beyond 0.3 of the rate is lowered to that.
std::vector<Vec3> steady_low_pass(const std::vector<Vec3>& speeds, double fps, double cutoff_hz) {
  if (speeds.size() < 2) return speeds;
  const Butterworth filter(std::min(cutoff_hz, 0.3 * fps), fps);
  const auto reach = std::min(speeds.size() - 1, static_cast<std::size_t>(std::ceil(fps / cutoff_hz)) * 3);
  return zero_phase(speeds, filter, reach, Beyond::mirrored);
}

/// In the axes that the swing carries along: (a_y, a_z, alpha).
Vec3 speed_between(const Quat& before, const Quat& after, double fps) {
  const Vec3 omega = log_rotation(after * before.conjugate()) * fps;
  const Vec2 swing = swing_twist(before).swing;
  const Vec3 local = exp_rotation(Vec3(0.0, swing.x(), swing.y())).conjugate() * omega;
  return {local.y(), local.z(), local.x()};
}

/// Rigs let the hand turn about the forearm; in a person the forearm takes that turn and the wrist has none.
void give_twist_to_forearms(const SegmentFrames& frames, PerSegment<Quat>& rotations) {
  for (const Segment hand : {Segment::hand_l, Segment::hand_r}) {
    if (frames.node[index(hand)] < 0) continue;
    Quat& forearm = rotations[index(parent_of(hand))];
    const double twist = twist_angle(forearm.conjugate() * rotations[index(hand)], Vec3::UnitY());
    forearm = forearm * exp_rotation(twist * Vec3::UnitY());
  }
}

Quat rotation_of(const RangeOfMotion& range, Joint joint, const PerSegment<Quat>& segments) {
  const Quat relative = segments[index(parent_of(joint))].conjugate() * segments[index(child_of(joint))];
  return range.joints[index(joint)].frame.joint_from_relative(relative);
}

}  // namespace

JointSpeeds joint_speeds(const Skeleton& skeleton, const Humanoid& humanoid, const RangeOfMotion& range,
                         const Clip& clip, double cutoff_hz) {
  JointSpeeds result;
  result.fps = clip.fps;
  if (clip.frames.size() < 2) return result;
  std::vector<BodyPose> poses;
  for (const Pose& pose : clip.frames) poses.push_back(segments_of(skeleton, humanoid, pose));
  const std::size_t frames = poses.size() - 1;
  const auto around = static_cast<std::size_t>(std::ceil(kAround_s * clip.fps));
  for (std::size_t f = 0; f < frames; ++f) result.activity.push_back(activity_of(poses, f, around, clip.fps));

  const SegmentFrames fixed = segment_frames(skeleton, humanoid, clip.frames.front(),
                                             canonical_segments_of(skeleton, humanoid, clip.frames.front()));
  std::vector<PerSegment<Quat>> rotations;
  for (const Pose& pose : clip.frames) {
    rotations.push_back(rotations_of(skeleton, fixed, pose));
    give_twist_to_forearms(fixed, rotations.back());
  }
  for (int j = 0; j < kJointCount; ++j) {
    const Joint joint = joint_at(j);
    if (fixed.node[index(child_of(joint))] < 0) continue;
    std::vector<Vec3>& speeds = result.speeds[j];
    for (std::size_t f = 0; f < frames; ++f)
      speeds.push_back(speed_between(rotation_of(range, joint, rotations[f]),
                                     rotation_of(range, joint, rotations[f + 1]), clip.fps));
    result.glitch[j] = glitches(speeds);
    if (cutoff_hz > 0.0) speeds = steady_low_pass(speeds, clip.fps, cutoff_hz);
  }
  return result;
}

}  // namespace ukemi
