#include "clip/start.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "humanoid/soles.h"

namespace ukemi {

namespace {

constexpr double kVelocityStep = 1.0 / 240.0;  // s, to either side
constexpr double kFloorQuantile = 0.05;        // a calibration pose or a slipped frame may lie deeper

}  // namespace

double height_above_floor(const Character& character, const Humanoid& humanoid, const Pose& pose) {
  return Soles(character, humanoid).lowest(character.skeleton, pose);
}

double floor_of(const Character& character, const Humanoid& humanoid, const std::vector<Pose>& poses) {
  const Soles soles(character, humanoid);
  std::vector<double> heights;
  for (const Pose& pose : poses) heights.push_back(soles.lowest(character.skeleton, pose));
  const double rank = kFloorQuantile * static_cast<double>(heights.size() - 1);
  return ranked(std::move(heights), static_cast<std::size_t>(rank));
}

Pose unhit_pose(const Skeleton& skeleton, const Humanoid& humanoid, const Start& start, double time_s) {
  if (!start.motion || time_s == 0.0) return start.pose;
  const double at_s = start.at_s + time_s;
  const double duration_s = start.motion->duration_s();
  if (!start.round || (at_s >= 0.0 && at_s <= duration_s))
    return sample(skeleton, *start.motion, start.motion->start_s + at_s);
  const double rounds = std::floor(at_s / duration_s);
  const Pose pose = sample(skeleton, *start.motion, start.motion->start_s + at_s - rounds * duration_s);
  const Rigid step = rounds < 0.0 ? start.round->inverse() : *start.round;
  Rigid way;
  for (int i = 0; i < static_cast<int>(std::abs(rounds)); ++i) way = step * way;
  const BodyPose before = segments_of(skeleton, humanoid, pose);
  BodyPose after = before;
  for (Rigid& segment : after) segment = way * segment;
  return pose_skeleton(skeleton, humanoid, pose, before, after);
}

double velocity_jump(const Skeleton& skeleton, const Humanoid& humanoid, const Start& start) {
  if (!start.motion || !(start.motion->duration_s() > 0.0)) return 0.0;
  const double now = start.motion->start_s + start.at_s;
  const double before = std::max(start.motion->start_s, now - kVelocityStep);
  const double after = std::min(start.motion->end_s, now + kVelocityStep);
  const BodyPose a = segments_of(skeleton, humanoid, sample(skeleton, *start.motion, before));
  const BodyPose b = segments_of(skeleton, humanoid, sample(skeleton, *start.motion, after));
  double largest = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const int parent = index(parent_of(segment_at(s)));
    const Vec3& velocity = start.state.linear_velocity[s];
    const Vec3 clip_velocity = (b[s].translation - a[s].translation) / (after - before);
    const Vec3 from_parent = start.segments[s].translation - start.segments[parent].translation;
    const Vec3 of_parent =
        start.state.linear_velocity[parent] + start.state.angular_velocity[parent].cross(from_parent);
    largest = std::max({largest, (velocity - clip_velocity).norm(), (velocity - of_parent).norm()});
  }
  return largest;
}

Pose moved(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose, const Vec3& offset) {
  const Similarity file_from_world = humanoid.world_from_file.inverse();
  const Vec3 file_offset = file_from_world.scale * (file_from_world.rotation * offset);
  Pose result = pose;
  for (int i = 0; i < skeleton.size(); ++i)
    if (skeleton.nodes[i].parent < 0) result[i].translation += file_offset;
  return result;
}

}  // namespace ukemi
