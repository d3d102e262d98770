#include "body/sole.h"

#include <vector>

#include "body/on_ground.h"

namespace ukemi {

std::array<Vec3, 4> sole_of(const BodySegment& foot, const Quat& world_from_foot) {
  std::vector<Vec3> points;
  for (const Shape& shape : foot.shapes) {
    const Vec3 half = shape.kind == ShapeKind::box
                          ? Vec3(0.5 * shape.size)
                          : Vec3(shape.radius, 0.5 * shape.length + shape.radius, shape.radius);
    for (int corner = 0; corner < 8; ++corner)
      points.push_back(shape.segment_from_shape * Vec3((corner & 1) != 0 ? half.x() : -half.x(),
                                                       (corner & 2) != 0 ? half.y() : -half.y(),
                                                       (corner & 4) != 0 ? half.z() : -half.z()));
  }
  if (points.empty()) points.push_back(Vec3::Zero());
  const double yaw = yaw_of(world_from_foot * Vec3::UnitX());
  const Quat heading(Eigen::AngleAxisd(yaw, Vec3::UnitY()));
  Vec3 least = Vec3::Constant(1e9);
  Vec3 most = Vec3::Constant(-1e9);
  for (const Vec3& point : points) {
    const Vec3 along = heading.conjugate() * (world_from_foot * point);
    least = least.cwiseMin(along);
    most = most.cwiseMax(along);
  }
  std::array<Vec3, 4> corners;
  const std::array<Vec2, 4> ground = {Vec2(least.x(), least.z()), Vec2(most.x(), least.z()),
                                      Vec2(most.x(), most.z()), Vec2(least.x(), most.z())};
  for (int i = 0; i < 4; ++i)
    corners[i] = world_from_foot.conjugate() * (heading * at_height(ground[i], least.y()));
  return corners;
}

}  // namespace ukemi
