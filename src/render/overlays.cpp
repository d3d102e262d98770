#include "render/overlays.h"
#include "humanoid/rotations.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kAxis_m = 0.085;
constexpr double kAxisRadius_m = 0.0055;
constexpr double kTrailRadius_m = 0.006;
constexpr double kNearEdge = 0.92;
constexpr double kOutside_rad = radians(0.5);
constexpr int kStepsPerEdge = 5;
constexpr float kConeAlpha = 0.42f;
const Rgba kInside = srgb(0x2F8F83);
const Rgba kNear = srgb(0xE8A200);
const Rgba kOutside = srgb(0xD81E1E);
const Rgba kTrail = srgb(0x2E6FB7);

Surface drawn_over(bool see_through) {
  Surface surface;
  surface.alpha = see_through ? Material::Alpha::blend : Material::Alpha::opaque;
  surface.double_sided = true;
  surface.casts_shadow = false;
  surface.takes_shadow = false;
  surface.gloss = 0.0f;
  return surface;
}

bool has_joint(const Shot& shot, int joint) {
  return shot.body == nullptr || !shot.body->joints[joint].fused;
}

/// Length of a joint's cone, metres, on a man of 1.75 m.
double cone_length(Joint joint) {
  switch (joint) {
    case Joint::hip_l:
    case Joint::hip_r:
    case Joint::shoulder_l:
    case Joint::shoulder_r:
      return 0.17;
    case Joint::clavicle_l:
    case Joint::clavicle_r:
    case Joint::wrist_l:
    case Joint::wrist_r:
    case Joint::ankle_l:
    case Joint::ankle_r:
      return 0.09;
    default:
      return 0.13;
  }
}

/// How far along its way to the edge a swing is, seen from the polygon's origin: 1 on the edge.
double swing_share(const std::vector<Vec2>& polygon, const Vec2& swing) {
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  double share = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    if (cross(a, swing) < 0.0 || cross(swing, b) < 0.0) continue;
    share = std::max(share, cross(swing, b - a) / cross(a, b));
  }
  return share;
}

double twist_share(const JointRange& range, double twist) {
  const double edge = twist > 0.0 ? range.twist_max : range.twist_min;
  return edge != 0.0 ? twist / edge : (twist == 0.0 ? 0.0 : 2.0);
}

const Rgba& state_color(const JointRange& range, const SwingTwist& chart) {
  if (excess(range, chart) > kOutside_rad) return kOutside;
  const double share = std::max(swing_share(range.polygon, chart.swing), twist_share(range, chart.twist));
  return share > kNearEdge ? kNear : kInside;
}

/// Directions of the joint's link along the polygon's boundary, world.
std::vector<Vec3> boundary(const JointRange& range, const Quat& world_from_joint) {
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < range.polygon.size(); ++i) {
    const Vec2& a = range.polygon[i];
    const Vec2& b = range.polygon[(i + 1) % range.polygon.size()];
    for (int step = 0; step < kStepsPerEdge; ++step) {
      const Vec2 swing = a + (b - a) * step / kStepsPerEdge;
      directions.push_back(world_from_joint * (joint_rotation({swing, 0.0}) * Vec3::UnitX()));
    }
  }
  return directions;
}

void add_cone(Geometry& geometry, const Vec3& centre, const std::vector<Vec3>& directions, double length,
              Rgba color) {
  std::vector<Vec3> rim;
  for (const Vec3& direction : directions) rim.push_back(centre + length * direction);
  rim.push_back(rim.front());
  color[3] = kConeAlpha;
  geometry.begin(drawn_over(true));
  for (std::size_t i = 0; i + 1 < rim.size(); ++i)
    add_flat_triangle(geometry, {centre, rim[i], rim[i + 1]}, color);
  color[3] = 1.0f;
  geometry.begin(drawn_over(false));
  add_tube(geometry, rim, 0.018 * length, color);
}

}  // namespace

void add_joint_axes(Geometry& geometry, const Shot& shot, int frame) {
  const Rgba colors[] = {srgb(0xD0382B), srgb(0x2E9B4F), srgb(0x2F6FD0)};
  const BodyPose& pose = (*shot.segments)[frame];
  geometry.begin(drawn_over(false));
  for (int j = 0; j < kJointCount; ++j) {
    if (!has_joint(shot, j)) continue;
    const Rigid& segment = pose[index(child_of(joint_at(j)))];
    for (int axis = 0; axis < 3; ++axis)
      add_tube(geometry, {segment.translation, segment * Vec3(kAxis_m * Vec3::Unit(axis))}, kAxisRadius_m,
               colors[axis]);
  }
}

void add_range_cones(Geometry& geometry, const Shot& shot, int frame) {
  const BodyPose& pose = (*shot.segments)[frame];
  const PerSegment<Quat> rotations = rotations_of(pose);
  const PerJoint<SwingTwist> charts = charts_of(*shot.range, rotations);
  const double size = shot.humanoid != nullptr ? shot.humanoid->height_m / 1.75 : 1.0;
  for (int j = 0; j < kJointCount; ++j) {
    if (!has_joint(shot, j)) continue;
    const JointRange& range = shot.range->joints[j];
    const Quat world_from_joint = rotations[index(parent_of(joint_at(j)))] * range.frame.parent_from_joint;
    const Vec3& centre = pose[index(child_of(joint_at(j)))].translation;
    const double length = size * cone_length(joint_at(j));
    const Rgba& color = state_color(range, charts[j]);
    add_cone(geometry, centre, boundary(range, world_from_joint), length, color);
    const Vec3 link = world_from_joint * (joint_rotation(charts[j]) * Vec3::UnitX());
    add_tube(geometry, {centre, centre + 1.12 * length * link}, 0.045 * length, color);
    add_capsule(geometry, {Quat::Identity(), centre}, 0.1 * length, 0.0, color);
  }
}

void add_trail(Geometry& geometry, const std::vector<Vec3>& hips, int frame) {
  geometry.begin(drawn_over(false));
  const std::vector<Vec3> way(hips.begin(), hips.begin() + frame + 1);
  add_tube(geometry, way, kTrailRadius_m, kTrail);
}

}  // namespace ukemi
