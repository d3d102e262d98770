// Vectors, rotations and transforms. Double precision, SI units and radians unless a name says otherwise.
//
// Conventions: right-handed, y up. Transforms read right to left and are named by their frames:
// world_from_joint = world_from_parent * parent_from_joint.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ukemi {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Affine = Eigen::Affine3d;

inline constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// Rigid motion: a rotation, then a translation (metres).
struct Rigid {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator*(const Vec3& point) const { return rotation * point + translation; }
  Rigid operator*(const Rigid& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  Rigid inverse() const {
    const Quat r = rotation.conjugate();
    return {r, -(r * translation)};
  }
};

/// Similarity: uniform scale, then rotation, then translation. `world_from_file` is one: the file's
/// units and up axis to metres and y up.
struct Similarity {
  double scale = 1.0;
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator*(const Vec3& point) const { return scale * (rotation * point) + translation; }
  Similarity inverse() const {
    const Quat r = rotation.conjugate();
    return {1.0 / scale, r, -(r * translation) / scale};
  }
  Affine affine() const;
};

/// Rotation by |v| radians about v.
Quat exp_rotation(const Vec3& v);
/// Rotation vector of q, of length at most pi.
Vec3 log_rotation(const Quat& q);
/// Angle of the rotation that takes a to b, radians in [0, pi]; exact to 1e-15 near 0.
double angle_between(const Quat& a, const Quat& b);
/// Shortest rotation that takes direction `from` to direction `to`; lengths do not matter.
/// Opposite directions turn about an arbitrary perpendicular axis; a zero vector gives the identity.
Quat shortest_rotation(const Vec3& from, const Vec3& to);
/// Rotation factor of a linear map (polar decomposition); a mirrored map gives the rotation of -map.
Quat rotation_part(const Mat3& linear);
/// Twist of q about `axis` (unit): q = swing * twist, swing perpendicular to the axis. Radians in (-pi, pi].
double twist_angle(const Quat& q, const Vec3& axis);
/// The one of q, -q that is nearer to `reference`.
Quat nearest_sign(const Quat& q, const Quat& reference);

}  // namespace ukemi
