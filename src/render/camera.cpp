#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ukemi {
namespace {

constexpr double kNear = 0.05;
constexpr double kFar = 400.0;

}  // namespace

Eigen::Matrix4f Camera::clip_from_world() const {
  const double focal = 1.0 / std::tan(0.5 * vertical_fov);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = focal / aspect;
  projection(1, 1) = focal;
  projection(2, 2) = -(kFar + kNear) / (kFar - kNear);
  projection(2, 3) = -2.0 * kFar * kNear / (kFar - kNear);
  projection(3, 2) = -1.0;
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = world_from_camera.conjugate().toRotationMatrix();
  view.topRightCorner<3, 1>() = -(world_from_camera.conjugate() * eye);
  return (projection * view).cast<float>();
}

Vec3 Camera::project(const Vec3& world) const {
  const Vec3 p = world_from_camera.conjugate() * (world - eye);
  const double t = std::tan(0.5 * vertical_fov);
  return {p.x() / (-p.z() * t * aspect), p.y() / (-p.z() * t), -p.z()};
}

Quat look(double azimuth, double elevation) {
  return Quat(Eigen::AngleAxisd(azimuth, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(-elevation, Vec3::UnitX()));
}

Framing::Framing(const Camera& camera, const Margins& margins) : camera_(camera) {
  const double t = std::tan(0.5 * camera.vertical_fov);
  low_slope_ = t * Vec2(camera.aspect * (1.0 - margins.left), 1.0 - margins.bottom);
  high_slope_ = t * Vec2(camera.aspect * (1.0 - margins.right), 1.0 - margins.top);
  low_ = high_ = Vec2::Constant(-std::numeric_limits<double>::infinity());
}

void Framing::add(const Vec3& world_point, double radius) {
  const Vec3 p = camera_.world_from_camera.conjugate() * world_point;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = low_slope_[axis];
    const double high = high_slope_[axis];
    low_[axis] = std::max(low_[axis], low * p.z() - p[axis] + radius * std::hypot(1.0, low));
    high_[axis] = std::max(high_[axis], high * p.z() + p[axis] + radius * std::hypot(1.0, high));
  }
}

Camera Framing::fit() const {
  Vec3 eye = Vec3::Zero();
  eye.z() = (low_ + high_).cwiseQuotient(low_slope_ + high_slope_).maxCoeff();
  // Where there is room to spare, the middle of what is allowed.
  eye.head<2>() = 0.5 * (high_ - low_ + eye.z() * (low_slope_ - high_slope_));
  Camera camera = camera_;
  camera.eye = camera.world_from_camera * eye;
  return camera;
}

}  // namespace ukemi
