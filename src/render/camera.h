// One perspective camera that sees a whole motion.
#pragma once

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

/// Shares of half the picture that stay free at its edges, [0, 1).
struct Margins {
  double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
};

/// Places a camera of given orientation, field of view and aspect as near as possible so that everything
/// added is seen inside the margins. A point p (camera axes) is seen from e when -l (e_z - p_z) <= p_x - e_x
/// <= r (e_z - p_z) for the slopes l and r of the left and right bounds, and the same for y; so the four
/// maxima of p_x + r p_z, -p_x + l p_z, ... decide, and points need not be kept. A sphere of radius s adds s
/// sqrt(1 + slope^2).
class Framing {
 public:
  Framing(const Camera& camera, const Margins& margins);
  /// A sphere, metres; radius 0: a point.
  void add(const Vec3& world_point, double radius = 0.0);
  Camera fit() const;

 private:
  Camera camera_;
  Vec2 low_slope_, high_slope_;  // left and bottom, right and top
  Vec2 low_, high_;              // the maxima
};

}  // namespace ukemi
