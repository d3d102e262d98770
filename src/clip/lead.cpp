#include "clip/lead.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ukemi {
namespace {

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

std::vector<Rigid> on_its_way(const Prop& prop, const Scene& scene, double gravity, int frames, double fps) {
  std::vector<Rigid> before;
  if (prop.poses.size() < 2) return before;
  for (int i = frames; i > 0; --i)
    before.push_back(prop.moves ? before_contact(prop, scene, gravity, i / fps) : prop.poses.front());
  return before;
}

}  // namespace

int frames_in(double seconds, double fps) { return static_cast<int>(std::ceil(seconds * fps - 1e-9)); }

void add_lead(const Actor& actor, const Scene& scene, double gravity, double lead_s, Timeline& timeline) {
  const double fps = timeline.clip.fps;
  const int frames = frames_in(lead_s, fps);
  if (frames <= 0) return;
  const SegmentFrames segment_frames = frames_of(actor);
  TimelinePart part;
  for (int i = 0; i < frames; ++i) {
    part.poses.push_back(
        unhit_pose(actor.character.skeleton, actor.humanoid, actor.start, (i - frames) / fps));
    part.segments.push_back(segments_above_floor(actor, segment_frames, part.poses.back()));
  }
  for (const Prop& prop : timeline.trajectory.props)
    part.props.push_back(on_its_way(prop, scene, gravity, frames, fps));
  timeline.prepend(std::move(part));
}

}  // namespace ukemi
