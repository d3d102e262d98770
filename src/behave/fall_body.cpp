#include "behave/fall_body.h"

#include <algorithm>

namespace ukemi {
namespace {

constexpr double kLeg_m = 0.857;                // leg of the man that the constants are given for
constexpr double kFullEffortAt = 0.35;          // rad: error at which a joint gives all that it is asked for
constexpr double kStandardSize = 73.0 * 1.741;  // kg m

/// Torque that the springs are scaled by, N m, of a man of 73 kg and 1.741 m: the weaker direction's
/// isometric maximum; the wrist's is what a loaded hand carries.
double spring_torque(Joint joint) {
  if (is_left(joint)) joint = mirror_of(joint);
  switch (joint) {
    case Joint::spine:
      return 200.0;
    case Joint::chest:
    case Joint::hip_r:
    case Joint::knee_r:
      return 150.0;
    case Joint::neck:
      return 30.0;
    case Joint::elbow_r:
      return 45.0;
    case Joint::wrist_r:
      return 10.0;
    default:
      return 60.0;
  }
}

Vec3 anchor_of(const BodyJoint& joint) {
  return joint.fused ? joint.parent_from_child.translation : joint.anchor_in_parent;
}

/// The lower face of the foot's lowest box, or of its capsule's ends.
std::array<Vec3, 4> sole_of(const BodySegment& foot) {
  std::array<Vec3, 4> corners;
  corners.fill(Vec3::Zero());
  double lowest = 1e9;
  for (const Shape& shape : foot.shapes) {
    const Vec3 half = shape.kind == ShapeKind::box
                          ? Vec3(0.5 * shape.size)
                          : Vec3(shape.radius, shape.radius + 0.5 * shape.length, shape.radius);
    const double bottom = (shape.segment_from_shape * Vec3(0.0, -half.y(), 0.0)).y();
    if (bottom >= lowest) continue;
    lowest = bottom;
    int i = 0;
    for (const double x : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        corners[i++] = shape.segment_from_shape * Vec3(x * half.x(), -half.y(), z * half.z());
  }
  return corners;
}

/// The point inside by `margin` that is nearest to `point`: along the boundary's normal, towards the middle
/// where the polygon is too narrow for that.
Vec2 swing_inside(const std::vector<Vec2>& polygon, const Vec2& point, double margin) {
  const double distance = polygon_distance(polygon, point);
  if (distance <= -margin) return point;
  const Vec2 edge = nearest_boundary_point(polygon, point);
  const Vec2 inwards = distance > 0.0 ? Vec2(edge - point) : Vec2(point - edge);
  if (inwards.norm() > 1e-9) {
    const Vec2 moved = edge + margin * inwards.normalized();
    if (polygon_distance(polygon, moved) <= -0.7 * margin) return moved;
  }
  double least = 0.0;
  double most = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (least + most);
    (polygon_distance(polygon, middle * edge) <= -margin ? least : most) = middle;
  }
  return least * edge;
}

}  // namespace

FallBody::FallBody(const ArticulatedBody& body, const RangeOfMotion& joints, const MuscleStrength& muscles)
    : mass_kg(body.mass_kg), range(joints), strength(muscles) {
  for (int s = 0; s < kSegmentCount; ++s) mass[s] = body.segments[s].mass_kg;
  for (int j = 0; j < kJointCount; ++j) {
    anchor[j] = anchor_of(body.joints[j]);
    fused[j] = body.joints[j].fused;
    stiffness[j] = spring_torque(joint_at(j)) / kFullEffortAt * body.mass_kg * body.height_m / kStandardSize;
  }
  for (const BodySide side : kSides) {
    const auto length = [&](Joint right) { return anchor[index(on(side, right))].norm(); };
    arms[index(side)] = {length(Joint::elbow_r), length(Joint::wrist_r)};
    thigh_m[index(side)] = length(Joint::knee_r);
    shank_m[index(side)] = length(Joint::ankle_r);
    leg_m += 0.5 * (thigh_m[index(side)] + shank_m[index(side)]);
    sole[index(side)] = sole_of(body.segments[index(on(side, Segment::foot_r))]);
  }
  lambda = leg_m / kLeg_m;
  tau = std::sqrt(lambda);
}

Quat FallBody::inside(Joint joint, const Quat& parent_from_child, double margin) const {
  const JointRange& limits = range.joints[index(joint)];
  SwingTwist chart = swing_twist(limits.frame.joint_from_relative(parent_from_child));
  const double middle = 0.5 * (limits.twist_min + limits.twist_max);
  chart.twist = std::clamp(chart.twist, std::min(limits.twist_min + margin, middle),
                           std::max(limits.twist_max - margin, middle));
  chart.swing = swing_inside(limits.polygon, chart.swing, margin);
  return limits.frame.relative_from_joint(joint_rotation(chart));
}

std::array<Vec3, 4> sole_corners(const FallBody& body, const Senses& senses, BodySide side) {
  std::array<Vec3, 4> corners = body.sole[index(side)];
  for (Vec3& corner : corners) corner = senses.pose[index(on(side, Segment::foot_r))] * corner;
  return corners;
}

Quat joint_rotation_of(const BodyPose& pose, Joint joint) {
  return pose[index(parent_of(joint))].rotation.conjugate() * pose[index(child_of(joint))].rotation;
}

bool on_floor(const Senses& senses, Segment segment) {
  return std::any_of(senses.contacts.begin(), senses.contacts.end(), [segment](const SegmentContact& c) {
    return c.segment == segment && c.with == SegmentContact::With::floor;
  });
}

}  // namespace ukemi
