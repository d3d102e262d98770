#include "base/math.h"

#include <Eigen/SVD>
#include <cmath>

namespace ukemi {

Affine Similarity::affine() const {
  Affine result = Affine::Identity();
  result.linear() = scale * rotation.toRotationMatrix();
  result.translation() = translation;
  return result;
}

Quat exp_rotation(const Vec3& v) {
  const double angle = v.norm();
  // sin(angle/2)/angle; its series below 1e-4 rad is exact to 1e-18.
  const double k = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return Quat(std::cos(0.5 * angle), k * v.x(), k * v.y(), k * v.z());
}

Vec3 log_rotation(const Quat& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Vec3 v = sign * q.vec();
  const double length = v.norm();
  if (length < 1e-12) return 2.0 * v;
  return v * (2.0 * std::atan2(length, sign * q.w()) / length);
}

double angle_between(const Quat& a, const Quat& b) {
  const Quat delta = a.conjugate() * b;
  return 2.0 * std::atan2(delta.vec().norm(), std::abs(delta.w()));
}

Quat shortest_rotation(const Vec3& from, const Vec3& to) {
  if (from.squaredNorm() == 0.0 || to.squaredNorm() == 0.0) return Quat::Identity();
  return Quat::FromTwoVectors(from, to);
}

Quat rotation_part(const Mat3& linear) {
  const double sign = linear.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::JacobiSVD<Mat3> svd(sign * linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 r = svd.matrixU() * svd.matrixV().transpose();
  if (r.determinant() < 0.0) {
    Mat3 u = svd.matrixU();
    u.col(2) = -u.col(2);
    r = u * svd.matrixV().transpose();
  }
  return Quat(r).normalized();
}

double twist_angle(const Quat& q, const Vec3& axis) {
  double angle = 2.0 * std::atan2(q.vec().dot(axis), q.w());
  if (angle > kPi) angle -= 2.0 * kPi;
  if (angle <= -kPi) angle += 2.0 * kPi;
  return angle;
}

Quat nearest_sign(const Quat& q, const Quat& reference) {
  return q.dot(reference) < 0.0 ? Quat(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

}  // namespace ukemi
