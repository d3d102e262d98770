#include "render/staging.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kElevation = radians(14.0);
constexpr double kMargin = 0.07;         // of half the picture
constexpr double kFollow = 1.7;          // the camera follows if it would else stand this much farther off
constexpr double kFlesh_m = 0.07;        // about a joint, for frames whose skin is not looked at
constexpr double kFloorSearch_m = 0.25;  // a lowest point this near to y = 0 stands on y = 0
constexpr int kViewsAround = 12;
constexpr double kArrow_m = 0.42;
constexpr double kArrowTime_s = 0.06;
constexpr float kHiddenArrowAlpha = 0.45f;
const Rgba kArrowColor = srgb(0xC23B22);

Vec3 flat(const Vec3& v) { return {v.x(), 0.0, v.z()}; }

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

/// Horizontal direction of what happens: of the blow, else of the longest way from the start; may be zero.
Vec3 main_direction(const Shot& shot, const JointPaths& joints) {
  const Vec3 blow = flat(shot.impact_direction);
  if (blow.norm() > 0.3 * shot.impact_direction.norm() && blow.norm() > 0.0) return blow.normalized();
  Vec3 longest = Vec3::Zero();
  for (const std::vector<Vec3>& frame : joints) {
    const Vec3 way = flat(mean(frame) - mean(joints.front()));
    if (way.norm() > longest.norm()) longest = way;
  }
  return longest.norm() > 0.4 ? Vec3(longest.normalized()) : Vec3(Vec3::Zero());
}

/// Horizontal direction from the figure to the camera.
Vec3 side_to_look_from(const Vec3& direction, const Vec3& facing) {
  if (direction.isZero()) {
    const Vec3 front = facing.isZero() ? Vec3(Vec3::UnitZ()) : facing;
    return Eigen::AngleAxisd(radians(32.0), Vec3::UnitY()) * front;
  }
  // Seen from `across`, the direction runs from left to right.
  Vec3 across = direction.cross(Vec3::UnitY());
  if (facing.dot(across) < -0.2) across = -across;
  // A front view is turned a little too, to the side that the blow goes to: what strikes stays behind.
  const double frontal = std::max(0.0, facing.dot(across));
  return (across + 0.55 * facing + 0.45 * frontal * direction).normalized();
}

double floor_height(double lowest) { return std::abs(lowest) <= kFloorSearch_m ? 0.0 : lowest; }

double impact_time(const Clip& clip) {
  for (const Mark& mark : clip.marks)
    if (mark.name == "impact") return mark.time_s;
  return 0.0;
}

/// How far behind the impact point the arrow ends, metres.
double arrow_gap(const Shot& shot, int frame) {
  double gap = 0.02;
  if (shot.props == nullptr) return gap;
  for (const Prop& prop : *shot.props) {
    if (prop.poses.empty() || prop.kind != Prop::Kind::ball) continue;
    const Rigid& pose = prop.poses[std::min<std::size_t>(frame, prop.poses.size() - 1)];
    const Vec3 away = pose.translation - shot.impact_point;
    if (away.norm() < 2.5 * prop.radius)
      gap = std::max(gap, prop.radius - away.dot(shot.impact_direction) + 0.03);
  }
  return gap;
}

}  // namespace

bool shows_arrow(const Shot& shot, int frame) {
  const double time = frame / shot.clip->fps;
  return !shot.impact_direction.isZero() && std::abs(time - impact_time(*shot.clip)) <= kArrowTime_s;
}

void add_blow_arrow(Geometry& geometry, const Shot& shot, int frame, float alpha) {
  Surface surface;
  surface.casts_shadow = false;
  surface.gloss = 0.0f;
  if (alpha < 1.0f) surface.alpha = Material::Alpha::blend;
  surface.takes_shadow = alpha >= 1.0f;
  geometry.begin(surface);
  const Vec3 direction = shot.impact_direction.normalized();
  Rgba color = kArrowColor;
  color[3] = alpha;
  add_arrow(geometry, shot.impact_point - arrow_gap(shot, frame) * direction, direction, kArrow_m, color);
}

void add_blow_arrow(FrameGeometry& geometry, const Shot& shot, int frame) {
  add_blow_arrow(geometry.solid, shot, frame);
  add_blow_arrow(geometry.overlay, shot, frame, kHiddenArrowAlpha);
}

StageView Staging::at(int frame) const {
  StageView moved = stage;
  if (!follows()) return moved;
  moved.camera.eye += shifts[frame];
  moved.focus += shifts[frame];
  return moved;
}

namespace {

/// Everything that the camera must hold, seen from a stage that moves by `shifts` (or not, when empty).
template <typename Visit>
void each_point(const DrawnCharacter& figure, const Shot& shot, const JointPaths& joints,
                const std::vector<Moment>& moments, const std::vector<Vec3>& shifts, Visit&& visit) {
  const auto shift = [&](std::size_t frame) { return shifts.empty() ? Vec3(Vec3::Zero()) : shifts[frame]; };
  for (std::size_t frame = 0; frame < joints.size(); ++frame)
    for (const Vec3& joint : joints[frame]) visit(Vec3(joint - shift(frame)), kFlesh_m);
  for (const Moment& moment : moments) {
    Geometry seen = figure.body(moment.frame);
    if (shows_arrow(shot, moment.frame)) add_blow_arrow(seen, shot, moment.frame);
    for (const Vertex& vertex : seen.vertices)
      visit(Vec3(vertex.position.cast<double>() - shift(moment.frame)), 0.0);
  }
}

/// Way of the figure's middle on the floor since the first frame.
std::vector<Vec3> floor_ways(const JointPaths& joints) {
  std::vector<Vec3> ways;
  for (const std::vector<Vec3>& frame : joints) ways.push_back(flat(mean(frame) - mean(joints.front())));
  return ways;
}

}  // namespace

Quat telling_side(const DrawnCharacter& figure, const Shot& shot, const JointPaths& joints,
                  const std::optional<ViewAngles>& view) {
  if (view) {
    const Vec3 facing = figure.facing(0);
    const double front = facing.isZero() ? 0.0 : std::atan2(facing.x(), facing.z());
    return look(front + view->azimuth, view->elevation);
  }
  const Vec3 back = side_to_look_from(main_direction(shot, joints), figure.facing(0));
  return look(std::atan2(back.x(), back.z()), kElevation);
}

StageView stage_about(const Camera& camera, const Eigen::AlignedBox3d& seen) {
  StageView stage;
  stage.camera = camera;
  stage.floor_y = floor_height(seen.min().y());
  stage.focus = {seen.center().x(), stage.floor_y, seen.center().z()};
  stage.reach = 0.5 * flat(seen.sizes()).norm() + 1.0;
  return stage;
}

Staging set_stage(const DrawnCharacter& figure, const Shot& shot, const JointPaths& joints,
                  const std::vector<Moment>& moments, double aspect, double top, const Viewpoint& viewpoint) {
  Camera camera;
  camera.aspect = aspect;
  camera.world_from_camera = telling_side(figure, shot, joints, viewpoint.view);

  const auto frame_for = [&](const std::vector<Vec3>& shifts, Eigen::AlignedBox3d& all) {
    Framing framing(camera, {kMargin, kMargin, kMargin, std::max(kMargin, 2.0 * top)});
    each_point(figure, shot, joints, moments, shifts, [&](const Vec3& point, double radius) {
      all.extend(point);
      if (!viewpoint.all_around) framing.add(point, radius);
    });
    if (!viewpoint.all_around) return framing.fit();
    each_point(figure, shot, joints, moments, shifts, [&](const Vec3& point, double radius) {
      for (int i = 0; i < kViewsAround; ++i) {
        const Eigen::AngleAxisd turn(2.0 * kPi * i / kViewsAround, Vec3::UnitY());
        framing.add(all.center() + turn * (point - all.center()), radius);
      }
    });
    return framing.fit();
  };
  const std::vector<Vec3> ways = floor_ways(joints);
  Eigen::AlignedBox3d all;
  Eigen::AlignedBox3d following;
  const Camera still = frame_for({}, all);
  const Camera moving = frame_for(ways, following);
  const auto distance = [&](const Camera& from, const Eigen::AlignedBox3d& box) {
    return (from.eye - box.center()).dot(from.world_from_camera * Vec3::UnitZ());
  };
  Staging staging;
  const bool follow = distance(still, all) > kFollow * distance(moving, following);
  if (follow) staging.shifts = ways;
  staging.stage = follow ? stage_about(moving, following) : stage_about(still, all);
  staging.stage.theme = theme(viewpoint.theme);
  return staging;
}

}  // namespace ukemi
