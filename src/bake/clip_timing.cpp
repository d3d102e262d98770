#include "bake/clip_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body/ground.h"
#include "clip/frames.h"
#include "clip/ground_motion.h"
#include "clip/start.h"

namespace ukemi {
namespace {

constexpr double kUpright = 0.7;    // of the pelvis's height: who is lower does not stand
constexpr double kCarryOn_s = 0.3;  // in which the velocities at the end of the simulation fade
constexpr double kFloorSmoothing_s = 0.06;

using SegmentVertices = PerSegment<std::vector<Vec3>>;

/// Segments of a pose in the frames of the simulation, above a floor at y = 0.
BodyPose segments_above_floor(const Character& character, const BakeOutcome& outcome,
                              const SegmentFrames& frames, const Pose& pose) {
  BodyPose segments = segments_of(character.skeleton, outcome.humanoid, pose);
  const PerSegment<Quat> rotations = rotations_of(character.skeleton, frames, pose);
  for (int s = 0; s < kSegmentCount; ++s) {
    segments[s].rotation = (outcome.humanoid.world_from_file.rotation * rotations[s]).normalized();
    segments[s].translation.y() -= outcome.start.floor_m;
  }
  return segments;
}

SegmentFrames frames_of(const Character& character, const BakeOutcome& outcome) {
  return segment_frames(character.skeleton, outcome.humanoid, outcome.start.pose, outcome.start.segments);
}

/// Where a prop was `time_s` before it touched, above the floor.
Rigid before_contact(const Prop& prop, const Scene& scene, double gravity, double time_s) {
  Vec3 velocity = scene.ball_speed_m_s * scene.direction;
  double fall = gravity;
  if (scene.kind == SceneKind::slope) {
    const Vec3 level = Vec3(scene.direction.x(), 0.0, scene.direction.z()).normalized();
    velocity = scene.ball_speed_m_s *
               (std::cos(scene.slope_rad) * level - std::sin(scene.slope_rad) * Vec3::UnitY());
  }
  if (scene.kind != SceneKind::ball) fall = 0.0;
  Rigid pose = prop.poses.front();
  pose.translation -= velocity * time_s + 0.5 * fall * time_s * time_s * Vec3::UnitY();
  const double lowest = prop.kind == Prop::Kind::ball ? prop.radius : 0.5 * prop.size.y();
  pose.translation.y() = std::max(pose.translation.y(), std::min(lowest, prop.poses.front().translation.y()));
  return pose;
}

void lead_prop(Prop& prop, const BakeOutcome& outcome, double gravity, int frames, double fps) {
  if (prop.poses.size() < 2) return;
  std::vector<Rigid> before;
  for (int i = frames; i > 0; --i)
    before.push_back(prop.moves ? before_contact(prop, outcome.scene, gravity, i / fps) : prop.poses.front());
  prop.poses.insert(prop.poses.begin(), before.begin(), before.end());
}

/// A prop flies on from its last two poses until it lies.
void let_go(Prop& prop, double gravity, std::size_t frames, double fps) {
  if (prop.poses.size() < 2) return;
  const double resting_m = prop.kind == Prop::Kind::ball ? prop.radius : 0.5 * prop.size.y();
  const Rigid last = prop.poses.back();
  const Vec3 velocity = fps * (last.translation - prop.poses[prop.poses.size() - 2].translation);
  for (std::size_t i = 1; i <= frames; ++i) {
    const double time_s = static_cast<double>(i) / fps;
    Rigid pose = last;
    pose.translation += velocity * time_s - 0.5 * gravity * time_s * time_s * Vec3::UnitY();
    if (pose.translation.y() < resting_m) {
      pose.translation = prop.poses.back().translation;
      pose.translation.y() = std::min(resting_m, last.translation.y());
    }
    prop.poses.push_back(pose);
  }
}

double lowest(const BodyPose& frame, const SegmentVertices& skin) {
  double low = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kSegmentCount; ++s)
    for (const Vec3& point : skin[s]) low = std::min(low, (frame[s] * point).y());
  return low;
}

/// 0 to 1 with still ends: no velocity, no acceleration.
double smooth_step(double x) { return x * x * x * (10.0 + x * (6.0 * x - 15.0)); }

/// Time of a motion that stands still at 0 and runs as it should from `duration_s` on, which it reaches in
/// time.
double gathered(double time_s, double duration_s) {
  const double x = std::clamp(time_s / duration_s, 0.0, 1.0);
  return duration_s * (0.5 + x * x * x * x * (2.5 + x * (x - 3.0)));  // 0.5 + integral of smooth_step
}

/// Where an offset with a velocity is, on its way to nothing (after Bollo, "Inertialization", GDC 2018).
struct Fading {
  Vec3 offset = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();

  Vec3 at(double time_s, double duration_s) const {
    const double carry_s = std::min(duration_s, kCarryOn_s);
    const double left = std::max(0.0, 1.0 - time_s / carry_s);
    return (1.0 - smooth_step(time_s / duration_s)) * offset + time_s * left * left * left * velocity;
  }
};

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
GroundMove place_for(const BodyPose& target, const BodyPose& figure, bool down) {
  if (down) return ground_move({target[index(Segment::pelvis)]}, {figure[index(Segment::pelvis)]});
  const int l = index(Segment::foot_l), r = index(Segment::foot_r);
  return ground_move({target[l], target[r]}, {figure[l], figure[r]});
}

/// Shifts poses up or down so that the lowest skin goes evenly from the height in the first to that in the
/// last.
void keep_on_floor(const Character& character, BakeOutcome& outcome, const SegmentFrames& frames,
                   std::vector<Pose>& poses) {
  const SegmentVertices skin =
      outermost_skin(character, outcome.humanoid, outcome.start.pose, outcome.start.segments, outcome.body);
  std::vector<double> low;
  for (const Pose& pose : poses)
    low.push_back(lowest(segments_above_floor(character, outcome, frames, pose), skin));
  if (!std::isfinite(low.front())) return;  // no skin, no shapes
  const int last = static_cast<int>(poses.size()) - 1;
  std::vector<double> lift;
  for (int i = 0; i <= last; ++i) {
    const double share = smooth_step(static_cast<double>(i) / last);
    lift.push_back((1.0 - share) * low.front() + share * low.back() - low[i]);
  }
  const int widest = frames_in(kFloorSmoothing_s, outcome.clip.fps);
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
    displace(character.skeleton, outcome.humanoid, movers(character.skeleton, outcome.humanoid),
             up * Vec3::UnitY(), poses[i]);
  }
}

void append_frames(const Character& character, const BakeSettings& settings, BakeOutcome& outcome,
                   const SegmentFrames& frames, const std::vector<Pose>& poses) {
  for (const Pose& pose : poses) {
    Pose next = pose;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i].rotation = nearest_sign(next[i].rotation, outcome.clip.frames.back()[i].rotation);
    outcome.simulation.trajectory.frames.push_back(segments_above_floor(character, outcome, frames, next));
    outcome.clip.frames.push_back(std::move(next));
  }
  for (Prop& prop : outcome.simulation.trajectory.props)
    let_go(prop, settings.simulation.gravity, poses.size(), outcome.clip.fps);
}

}  // namespace

int frames_in(double seconds, double fps) { return static_cast<int>(std::ceil(seconds * fps - 1e-9)); }

void add_lead(const Character& character, const BakeSettings& settings, BakeOutcome& outcome) {
  Clip& clip = outcome.clip;
  const int frames = frames_in(settings.lead_s, clip.fps);
  if (frames <= 0) return;
  outcome.impact_s = frames / clip.fps;
  const SegmentFrames segments = frames_of(character, outcome);
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i)
    poses.push_back(unhit_pose(character.skeleton, outcome.humanoid, outcome.start, (i - frames) / clip.fps));
  for (int i = frames - 1; i >= 0; --i) {
    const Pose& next = i + 1 < frames ? poses[i + 1] : clip.frames.front();
    for (std::size_t n = 0; n < next.size(); ++n)
      poses[i][n].rotation = nearest_sign(poses[i][n].rotation, next[n].rotation);
  }
  Trajectory& trajectory = outcome.simulation.trajectory;
  std::vector<BodyPose> before;
  for (const Pose& pose : poses) before.push_back(segments_above_floor(character, outcome, segments, pose));
  trajectory.frames.insert(trajectory.frames.begin(), before.begin(), before.end());
  for (Prop& prop : trajectory.props) lead_prop(prop, outcome, settings.simulation.gravity, frames, clip.fps);
  clip.frames.insert(clip.frames.begin(), poses.begin(), poses.end());
  for (Mark& mark : clip.marks)
    if (mark.name != "start") mark.time_s += outcome.impact_s;
}

void add_recovery(const Character& character, const BakeSettings& settings, BakeOutcome& outcome) {
  const Skeleton& skeleton = character.skeleton;
  const Humanoid& humanoid = outcome.humanoid;
  Clip& clip = outcome.clip;
  const int frames = settings.recover_s ? frames_in(*settings.recover_s, clip.fps) : 0;
  if (frames <= 0 || clip.frames.empty()) return;
  const double duration_s = frames / clip.fps;
  const double cut_s = clip.duration_s() - outcome.impact_s;
  const Pose last = clip.frames.back();
  const Pose before = clip.frames.size() > 1 ? clip.frames[clip.frames.size() - 2] : last;
  const BodyPose figure = segments_of(skeleton, humanoid, last);
  const bool down =
      is_down(figure, segments_of(skeleton, humanoid, outcome.start.pose), outcome.start.floor_m);
  // Who lies does not walk on: the clip gathers way while he gets up.
  const auto unplaced = [&](double time_s) {
    if (settings.recover_to != RecoverTo::clip) return outcome.start.pose;
    return unhit_pose(skeleton, humanoid, outcome.start,
                      cut_s + (down ? gathered(time_s, duration_s) : time_s));
  };
  const GroundMove place = place_for(segments_of(skeleton, humanoid, unplaced(0.0)), figure, down);
  const auto target = [&](double time_s) { return place.moved(skeleton, humanoid, unplaced(time_s)); };
  const Blend blend(before, last, target(-1.0 / clip.fps), target(0.0), clip.fps);
  std::vector<Pose> poses{last};
  for (int i = 1; i <= frames; ++i) poses.push_back(blend.at(target(i / clip.fps), i / clip.fps, duration_s));
  const SegmentFrames segments = frames_of(character, outcome);
  keep_on_floor(character, outcome, segments, poses);
  poses.erase(poses.begin());
  clip.marks.push_back({"recover", clip.duration_s()});
  append_frames(character, settings, outcome, segments, poses);
}

void play_extra_bones(const Character& character, BakeOutcome& outcome) {
  const Skeleton& skeleton = character.skeleton;
  std::vector<bool> carries(skeleton.nodes.size(), false);
  const auto mark_with_ancestors = [&](int node) {
    for (; node >= 0; node = skeleton.nodes[node].parent) carries[node] = true;
  };
  mark_with_ancestors(outcome.humanoid.root);
  for (const SegmentNodes& segment : outcome.humanoid.segments)
    for (const int node : segment.chain) mark_with_ancestors(node);
  for (const TwistBone& bone : outcome.humanoid.twist_bones) carries[bone.node] = true;
  Clip& clip = outcome.clip;
  for (std::size_t f = 1; f < clip.frames.size(); ++f) {
    const Pose unhit =
        unhit_pose(skeleton, outcome.humanoid, outcome.start, static_cast<double>(f) / clip.fps);
    for (int i = 0; i < skeleton.size(); ++i) {
      if (carries[i]) continue;
      clip.frames[f][i] = unhit[i];
      clip.frames[f][i].rotation = nearest_sign(unhit[i].rotation, clip.frames[f - 1][i].rotation);
    }
  }
}

}  // namespace ukemi
