// A joint's rotation as (a_y, a_z, alpha) and the range it may take: a polygon in (a_y, a_z), an interval in
// alpha (Era et al., section 2.2 and 4.1; the chart is the swing rotation vector, see swing_twist).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "base/segments.h"

namespace ukemi {

/// Q = exp([0, a_y, a_z]) * Rx(alpha): swing rotation vector, then twist about the link. Radians.
struct SwingTwist {
  Vec2 swing = Vec2::Zero();  // (a_y, a_z)
  double twist = 0.0;         // alpha, (-pi, pi]
};

/// Chart of a joint rotation. Undefined only at a swing of pi, where the last direction (a_y, 0) is used.
SwingTwist swing_twist(const Quat& joint_rotation);
Quat joint_rotation(const SwingTwist& chart);

/// Rows of the chart's rates in the joint frame: d(u . a)/dt = swing_row(u) . omega and d(alpha)/dt =
/// twist_row . omega, with omega the child's angular velocity relative to the parent. swing_row is
/// perpendicular to the link.
Vec3 swing_row(const SwingTwist& chart, const Vec2& u);
Vec3 twist_row(const SwingTwist& chart);

/// Where a joint's angles are measured from.
struct JointFrame {
  Quat parent_from_joint =
      Quat::Identity();               // x: reference link direction; +a_z moves the link to y, +a_y to -z
  Quat reference = Quat::Identity();  // rotation parent -> child that has a = 0, alpha = 0

  /// Joint rotation Q of a parent -> child rotation (identity in the neutral pose).
  Quat joint_from_relative(const Quat& parent_from_child) const;
  Quat relative_from_joint(const Quat& joint) const;
};

/// What an angle means: "flexion" above 0, "extension" below. Empty where the range does not say.
struct AxisMeaning {
  std::string positive, negative;
};

/// Contract:
/// 1. polygon: at least 3 corners (a_y, a_z), radians, counter-clockwise, star-shaped about the origin, the
/// origin inside.
/// 2. twist_min <= 0 <= twist_max.
/// 3. no corner has |a| >= 170 degrees (the chart is singular at 180).
struct JointRange {
  JointFrame frame;
  std::vector<Vec2> polygon;
  double twist_min = 0.0;
  double twist_max = 0.0;
  std::array<AxisMeaning, 3> meanings{};  // of a_y, a_z, alpha
};

struct RangeOfMotion {
  std::string name;  // "human", "diamond", "box" or the file it came from
  PerJoint<JointRange> joints;
};

/// Signed distance to the polygon's boundary, radians: positive outside. Exact for concave polygons too.
double polygon_distance(const std::vector<Vec2>& polygon, const Vec2& point);
/// Enclosed area, square radians of the chart.
double polygon_area(const std::vector<Vec2>& polygon);
/// Boundary point nearest to `point`.
Vec2 nearest_boundary_point(const std::vector<Vec2>& polygon, const Vec2& point);

/// How far outside, radians, 0 inside: the larger of the distance to the polygon and the twist's distance to
/// its interval.
double excess(const JointRange& range, const SwingTwist& chart);
/// The chart inside the range that is nearest (polygon and twist each on their own).
SwingTwist clamp_to_range(const JointRange& range, const SwingTwist& chart);
/// Enlarges the range so that `chart` lies inside with `margin` (radians); returns by how much, radians. An
/// enlarged polygon is the convex hull of the old one and a circle about the chart.
double widen_to_hold(JointRange& range, const SwingTwist& chart, double margin);

/// The other side's range: reflection in the sagittal plane.
JointRange mirrored(const JointRange& range);

/// A region by name (human, diamond, box: assets/limits/NAME.toml) or a TOML file, which may override single
/// joints of a base region. Left joints are the mirror of right ones unless given. Errors: input, with file,
/// line and joint (unknown joint, not star-shaped, reference outside, inverted interval, corner too far).
Result<RangeOfMotion> load_range_of_motion(const std::string& name_or_file);
Result<RangeOfMotion> parse_range_of_motion(std::string_view toml, const std::string& file);

/// Chart of every joint of a set of segments.
PerJoint<SwingTwist> charts_of(const RangeOfMotion& range, const PerSegment<Quat>& world_from_segment);

}  // namespace ukemi
