// One perspective camera that sees a whole motion.
#pragma once

#include <limits>

#include "base/math.h"

namespace ukemi {

struct Camera {
  Quat world_from_camera = Quat::Identity();  // looks along its -z, y up
  Vec3 eye = Vec3::Zero();                    // metres
  double vertical_fov = radians(32.0);
  double aspect = 1.0;  // width / height

  Eigen::Matrix4f clip_from_world() const;
  /// x, y in [-1, 1] inside the picture, y up; z: metres in front of the eye.
  Vec3 project(const Vec3& world) const;
};

/// Turned about the vertical by `azimuth` (0: looks along -z, from +z), then looking down by `elevation`.
Quat look(double azimuth, double elevation);

/// Places a camera of given orientation, field of view and aspect as near as possible so that every added
/// point is seen with `margin` (share of the half picture, [0, 1)) left free.
/// A point p (camera axes) is seen from e when |p_x - e_x| <= t_x (e_z - p_z), and the same for y; so the
/// four maxima of t p_z +- p decide, and points need not be kept. A sphere adds r sqrt(1 + t^2).
class Framing {
 public:
  Framing(const Camera& camera, double margin);
  /// A sphere; radius 0: a point.
  void add(const Vec3& world_point, double radius = 0.0);
  Camera fit() const;

 private:
  Camera camera_;
  Vec2 slope_;       // t_x, t_y
  Vec2 high_, low_;  // maxima of t z + p and of t z - p
};

}  // namespace ukemi
