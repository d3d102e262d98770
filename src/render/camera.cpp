#include "render/camera.h"

#include <algorithm>
#include <cmath>

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

Framing::Framing(const Camera& camera, double margin) : camera_(camera) {
  const double t = std::tan(0.5 * camera.vertical_fov) * (1.0 - margin);
  slope_ = {t * camera.aspect, t};
  high_ = low_ = Vec2::Constant(-std::numeric_limits<double>::infinity());
}

void Framing::add(const Vec3& world_point, double radius) {
  const Vec3 p = camera_.world_from_camera.conjugate() * world_point;
  for (int axis = 0; axis < 2; ++axis) {
    const double swell = radius * std::hypot(1.0, slope_[axis]);
    high_[axis] = std::max(high_[axis], slope_[axis] * p.z() + p[axis] + swell);
    low_[axis] = std::max(low_[axis], slope_[axis] * p.z() - p[axis] + swell);
  }
}

Camera Framing::fit() const {
  Vec3 eye = Vec3::Zero();
  double back = -std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    eye[axis] = 0.5 * (high_[axis] - low_[axis]);
    back = std::max(back, 0.5 * (high_[axis] + low_[axis]) / slope_[axis]);
  }
  eye.z() = back;
  Camera camera = camera_;
  camera.eye = camera.world_from_camera * eye;
  return camera;
}

}  // namespace ukemi
