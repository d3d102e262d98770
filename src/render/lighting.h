// The lights of a stage and the shadow on its floor, for every painter.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/geometry.h"

namespace ukemi {

inline constexpr double kPenumbra_m = 0.035;  // of the key light's shadow on the floor
inline constexpr double kContactBlur_m = 0.05;
inline constexpr double kContactReach_m = 0.10;        // height at which contact darkness has fallen to 1/e
inline constexpr double kKeyAzimuth = radians(-42.0);  // from the camera's side of the figure, to its left
inline constexpr double kKeyElevation = radians(52.0);
inline constexpr double kRimAzimuth = radians(150.0);
inline constexpr double kRimElevation = radians(25.0);

/// Towards a light that stands `azimuth` to the right of the camera as seen from the figure.
Vec3 towards(const Camera& camera, double azimuth, double elevation);

struct ShadowBounds {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30f);
  Eigen::Vector3f high = Eigen::Vector3f::Constant(-1e30f);
};

/// Bounds of everything that casts shadows; the focus where nothing does.
ShadowBounds shadow_bounds(const Geometry& geometry, const Vec3& focus);

/// Square of the floor that holds the shadow: centre x, centre z, half side.
Vec3 floor_area(const ShadowBounds& bounds, double floor_y, const Vec3& to_key);

/// Blurs a square map of `size` rows by three box filters: close to a Gaussian.
void blur(std::vector<float>& map, int size, double radius_px);

}  // namespace ukemi
