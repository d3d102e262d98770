#include "clip/recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "body/fading.h"
#include "body/ground.h"
#include "clip/ground_motion.h"
#include "clip/lead.h"

namespace ukemi {
namespace {

constexpr double kUpright = 0.7;  // of the pelvis's height: a lower body does not stand
constexpr double kFloorSmoothing_s = 0.06;

using SegmentVertices = PerSegment<std::vector<Vec3>>;

/// Poses of a prop that flies on from its last two poses until it lies on the floor.
std::vector<Rigid> flying_on(const Prop& prop, double gravity, std::size_t frames, double fps) {
  std::vector<Rigid> poses;
  if (prop.poses.size() < 2) return poses;
  const double resting_m = prop.kind == Prop::Kind::ball ? prop.radius : 0.5 * prop.size.y();
  const Rigid last = prop.poses.back();
  const Vec3 velocity = fps * (last.translation - prop.poses[prop.poses.size() - 2].translation);
  for (std::size_t i = 1; i <= frames; ++i) {
    const double time_s = static_cast<double>(i) / fps;
    Rigid pose = last;
    pose.translation += velocity * time_s - 0.5 * gravity * time_s * time_s * Vec3::UnitY();
    if (pose.translation.y() < resting_m) {
      pose.translation = (poses.empty() ? last : poses.back()).translation;
      pose.translation.y() = std::min(resting_m, last.translation.y());
    }
    poses.push_back(pose);
  }
  return poses;
}

double lowest(const BodyPose& frame, const SegmentVertices& skin) {
  double low = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kSegmentCount; ++s)
    for (const Vec3& point : skin[s]) low = std::min(low, (frame[s] * point).y());
  return low;
}

/// From the end of the simulation to a target, node by node.
class Blend {
 public:
  Blend(const Pose& before, const Pose& last, const Pose& target_before, const Pose& target, double fps)
      : turn_(last.size()), shift_(last.size()) {
    for (std::size_t i = 0; i < last.size(); ++i) {
      turn_[i].offset = log_rotation(target[i].rotation.conjugate() * last[i].rotation);
      const Quat was = target_before[i].rotation.conjugate() * before[i].rotation;
      const Quat is = target[i].rotation.conjugate() * last[i].rotation;
      turn_[i].velocity = fps * log_rotation(was.conjugate() * is);
      shift_[i].offset = last[i].translation - target[i].translation;
      shift_[i].velocity = fps * (shift_[i].offset - (before[i].translation - target_before[i].translation));
    }
  }
  Pose at(const Pose& target, double time_s, double duration_s) const {
    Pose pose = target;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const Fading only_offset{turn_[i].offset, Vec3::Zero()};
      const Fading only_velocity{Vec3::Zero(), turn_[i].velocity};
      pose[i].rotation = (pose[i].rotation * exp_rotation(only_offset.at(time_s, duration_s)) *
                          exp_rotation(only_velocity.at(time_s, duration_s)))
                             .normalized();
      pose[i].translation += shift_[i].at(time_s, duration_s);
    }
    return pose;
  }

 private:
  std::vector<Fading> turn_, shift_;
};

bool is_down(const BodyPose& figure, const BodyPose& target, double floor_m) {
  const auto height = [&](const BodyPose& pose) {
    return pose[index(Segment::pelvis)].translation.y() - floor_m;
  };
  return height(figure) < kUpright * height(target);
}

/// The move that puts the target where the figure is.
GroundMove place_for(const BodyPose& target, const BodyPose& figure) {
  const int l = index(Segment::foot_l), r = index(Segment::foot_r);
  return ground_move({target[l], target[r]}, {figure[l], figure[r]});
}

/// Shifts poses up or down so that the lowest skin goes evenly from the height in the first to that in the
/// last.
void keep_on_floor(const Actor& actor, double fps, const SegmentFrames& frames, std::vector<Pose>& poses) {
  const SegmentVertices skin =
      outermost_skin(actor.character, actor.humanoid, actor.start.pose, actor.start.segments, actor.body);
  std::vector<double> low;
  for (const Pose& pose : poses) low.push_back(lowest(segments_above_floor(actor, frames, pose), skin));
  if (!std::isfinite(low.front())) return;  // no skin, no shapes
  const int last = static_cast<int>(poses.size()) - 1;
  std::vector<double> lift;
  for (int i = 0; i <= last; ++i) {
    const double share = min_jerk(static_cast<double>(i) / last);
    lift.push_back((1.0 - share) * low.front() + share * low.back() - low[i]);
  }
  const int widest = frames_in(kFloorSmoothing_s, fps);
  const auto around = [&](const std::vector<double>& values, int i, auto combine) {
    const int reach = std::min({widest, i, last - i});
    return combine(values.begin() + i - reach, values.begin() + i + reach + 1);
  };
  std::vector<double> largest;
  for (int i = 0; i <= last; ++i)
    largest.push_back(around(lift, i, [](auto from, auto to) { return *std::max_element(from, to); }));
  for (int i = 0; i <= last; ++i) {
    const double up = around(largest, i, [](auto from, auto to) {
      double sum = 0.0;
      for (auto it = from; it != to; ++it) sum += *it;
      return sum / static_cast<double>(to - from);
    });
    displace(actor.character.skeleton, actor.humanoid, movers(actor.character.skeleton, actor.humanoid),
             up * Vec3::UnitY(), poses[i]);
  }
}

TimelinePart part_of(const Actor& actor, const SegmentFrames& frames, std::vector<Pose> poses,
                     const Timeline& timeline, double gravity) {
  TimelinePart part;
  for (const Pose& pose : poses) part.segments.push_back(segments_above_floor(actor, frames, pose));
  for (const Prop& prop : timeline.trajectory.props)
    part.props.push_back(flying_on(prop, gravity, poses.size(), timeline.clip.fps));
  part.poses = std::move(poses);
  return part;
}

}  // namespace

Status add_recovery(const Actor& actor, double seconds, const Return& to, double gravity,
                    Timeline& timeline) {
  const Skeleton& skeleton = actor.character.skeleton;
  const Humanoid& humanoid = actor.humanoid;
  Clip& clip = timeline.clip;
  const int frames = frames_in(seconds, clip.fps);
  if (frames <= 0 || clip.frames.empty()) return Done{};
  const double duration_s = frames / clip.fps;
  const double cut_s = to.moment_s.value_or(clip.duration_s() - timeline.impact_s);
  const Pose last = clip.frames.back();
  const Pose before = clip.frames.size() > 1 ? clip.frames[clip.frames.size() - 2] : last;
  const BodyPose figure = segments_of(skeleton, humanoid, last);
  if (is_down(figure, segments_of(skeleton, humanoid, actor.start.pose), actor.start.floor_m))
    return usage_error("--return blends a standing body back, but this one ends on the floor",
                       "add --get-up in its place");
  const auto unplaced = [&](double time_s) {
    if (to.where != RecoverTo::clip) return actor.start.pose;
    return unhit_pose(skeleton, humanoid, actor.start, cut_s + time_s);
  };
  const BodyPose first = segments_of(skeleton, humanoid, unplaced(0.0));
  const GroundMove place = to.moment_s
                               ? ground_move({first.begin(), first.end()}, {figure.begin(), figure.end()})
                               : place_for(first, figure);
  const auto target = [&](double time_s) { return place.moved(skeleton, humanoid, unplaced(time_s)); };
  const Blend blend(before, last, target(-1.0 / clip.fps), target(0.0), clip.fps);
  std::vector<Pose> poses{last};
  for (int i = 1; i <= frames; ++i) poses.push_back(blend.at(target(i / clip.fps), i / clip.fps, duration_s));
  const SegmentFrames segment_frames = frames_of(actor);
  keep_on_floor(actor, clip.fps, segment_frames, poses);
  poses.erase(poses.begin());
  clip.marks.push_back({"recover", clip.duration_s()});
  timeline.append(part_of(actor, segment_frames, std::move(poses), timeline, gravity));
  return Done{};
}

}  // namespace ukemi
