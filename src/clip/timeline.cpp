#include "clip/timeline.h"

#include <cassert>
#include <utility>

namespace ukemi {
namespace {

void take_signs(Pose& pose, const Pose& beside) {
  for (std::size_t i = 0; i < pose.size(); ++i)
    pose[i].rotation = nearest_sign(pose[i].rotation, beside[i].rotation);
}

template <typename T>
void insert(std::vector<T>& all, typename std::vector<T>::const_iterator at, std::vector<T>& more) {
  all.insert(at, std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

SegmentFrames frames_of(const Actor& actor) {
  return segment_frames(actor.character.skeleton, actor.humanoid, actor.start.pose, actor.start.segments);
}

BodyPose segments_above_floor(const Actor& actor, const SegmentFrames& frames, const Pose& pose) {
  BodyPose segments = segments_of(actor.character.skeleton, actor.humanoid, pose);
  const PerSegment<Quat> rotations = rotations_of(actor.character.skeleton, frames, pose);
  for (int s = 0; s < kSegmentCount; ++s) {
    segments[s].rotation = (actor.humanoid.world_from_file.rotation * rotations[s]).normalized();
    segments[s].translation.y() -= actor.start.floor_m;
  }
  return segments;
}

void Timeline::prepend(TimelinePart part) {
  assert(part.poses.size() == part.segments.size() && part.props.size() == trajectory.props.size());
  const double seconds = static_cast<double>(part.poses.size()) / clip.fps;
  for (std::size_t i = part.poses.size(); i-- > 0;)
    take_signs(part.poses[i], i + 1 < part.poses.size() ? part.poses[i + 1] : clip.frames.front());
  insert(clip.frames, clip.frames.begin(), part.poses);
  insert(trajectory.frames, trajectory.frames.begin(), part.segments);
  for (std::size_t i = 0; i < part.props.size(); ++i)
    insert(trajectory.props[i].poses, trajectory.props[i].poses.begin(), part.props[i]);
  impact_s += seconds;
  for (Mark& mark : clip.marks)
    if (mark.name != "start") mark.time_s += seconds;
}

void Timeline::append(TimelinePart part) {
  assert(part.poses.size() == part.segments.size() && part.props.size() == trajectory.props.size());
  for (std::size_t i = 0; i < part.poses.size(); ++i)
    take_signs(part.poses[i], i > 0 ? part.poses[i - 1] : clip.frames.back());
  insert(clip.frames, clip.frames.end(), part.poses);
  insert(trajectory.frames, trajectory.frames.end(), part.segments);
  for (std::size_t i = 0; i < part.props.size(); ++i)
    insert(trajectory.props[i].poses, trajectory.props[i].poses.end(), part.props[i]);
}

Timeline timeline_of(const Actor& actor, Trajectory trajectory, std::string name, ResampleError& error) {
  Timeline timeline;
  Trajectory in_file_place = trajectory;
  for (BodyPose& frame : in_file_place.frames)
    for (Rigid& segment : frame) segment.translation.y() += actor.start.floor_m;
  timeline.clip =
      resample(actor.character, actor.humanoid, actor.start.pose, actor.start.segments, in_file_place, error);
  timeline.clip.name = std::move(name);
  timeline.clip.marks = {{"start", 0.0}, {"impact", 0.0}};
  timeline.trajectory = std::move(trajectory);
  return timeline;
}

void play_extra_bones(const Actor& actor, Clip& clip) {
  const Skeleton& skeleton = actor.character.skeleton;
  std::vector<bool> carries(skeleton.nodes.size(), false);
  const auto mark_with_ancestors = [&](int node) {
    for (; node >= 0; node = skeleton.nodes[node].parent) carries[node] = true;
  };
  mark_with_ancestors(actor.humanoid.root);
  for (const SegmentNodes& segment : actor.humanoid.segments)
    for (const int node : segment.chain) mark_with_ancestors(node);
  for (const TwistBone& bone : actor.humanoid.twist_bones) carries[bone.node] = true;
  for (std::size_t f = 1; f < clip.frames.size(); ++f) {
    const Pose unhit = unhit_pose(skeleton, actor.humanoid, actor.start, static_cast<double>(f) / clip.fps);
    for (int i = 0; i < skeleton.size(); ++i) {
      if (carries[i]) continue;
      clip.frames[f][i] = unhit[i];
      clip.frames[f][i].rotation = nearest_sign(unhit[i].rotation, clip.frames[f - 1][i].rotation);
    }
  }
}

}  // namespace ukemi
