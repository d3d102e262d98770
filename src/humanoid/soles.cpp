#include "humanoid/soles.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr std::array<Segment, 2> kFeet = {Segment::foot_l, Segment::foot_r};
constexpr double kBall = 0.72;  // of the foot's length, from the heel (Hawes & Sovak 1994)

/// From the skin around the foot; none where there is no skin, or a wrong bind pose.
std::vector<Vec3> points_of_skin(const Character& character, const Humanoid& humanoid, Segment foot) {
  const Rigid frame = segments_of(character.skeleton, humanoid, humanoid.reference)[index(foot)];
  const auto extent = [&](const Vec3& axis) {
    const Vec3 direction = frame.rotation * axis;
    SkinExtent skin = extent_of_feet(character, humanoid, humanoid.reference, {foot}, direction);
    const double at = (humanoid.world_from_file.translation - frame.translation).dot(direction);
    skin.min = at + humanoid.world_from_file.scale * skin.min;
    skin.max = at + humanoid.world_from_file.scale * skin.max;
    return skin;
  };
  const SkinExtent along = extent(Vec3::UnitX());
  const SkinExtent up = extent(Vec3::UnitY());
  const double farthest = std::max({std::abs(along.min), std::abs(along.max), std::abs(up.min)});
  if (!along.found || farthest > kFarSole * humanoid.height_m) return {};
  return {Vec3(along.min, up.min, 0.0), Vec3(along.min + kBall * (along.max - along.min), up.min, 0.0)};
}

std::vector<Vec3> points_of_bones(const Character& character, const Humanoid& humanoid, int side) {
  std::vector<Vec3> points = {Vec3(0.0, -kAnkleUp * humanoid.height_m, 0.0)};
  if (humanoid.toes[side] < 0) return points;
  const Rigid frame = segments_of(character.skeleton, humanoid, humanoid.reference)[index(kFeet[side])];
  const std::vector<Affine> nodes = world_transforms(character.skeleton, humanoid.reference);
  const Vec3 toe = frame.inverse() * (humanoid.world_from_file * nodes[humanoid.toes[side]].translation());
  points.push_back(toe - kToeJointUp * humanoid.height_m * Vec3::UnitY());
  return points;
}

}  // namespace

SkinExtent extent_of_feet(const Character& character, const Humanoid& humanoid, const Pose& pose,
                          const std::vector<Segment>& feet, const Vec3& direction) {
  std::vector<char> in_foot(character.skeleton.nodes.size(), 0);
  for (const Segment foot : feet)
    if (humanoid.carrier_node(foot) >= 0) in_foot[humanoid.carrier_node(foot)] = 1;
  for (const int i : character.skeleton.order) {
    const int parent = character.skeleton.nodes[i].parent;
    if (parent >= 0 && in_foot[parent]) in_foot[i] = 1;
  }
  return skin_extent(character, world_transforms(character.skeleton, pose),
                     humanoid.world_from_file.rotation.conjugate() * direction,
                     [&](int node) { return in_foot[node] != 0; });
}

Soles::Soles(const Character& character, const Humanoid& humanoid) : humanoid_(humanoid) {
  for (int side = 0; side < 2; ++side) {
    points_[side] = points_of_skin(character, humanoid, kFeet[side]);
    if (points_[side].empty()) points_[side] = points_of_bones(character, humanoid, side);
  }
}

std::array<std::vector<Vec3>, 2> Soles::points(const Skeleton& skeleton, const Pose& pose) const {
  const BodyPose body = segments_of(skeleton, humanoid_, pose);
  std::array<std::vector<Vec3>, 2> points = points_;
  for (int side = 0; side < 2; ++side)
    for (Vec3& point : points[side]) point = body[index(kFeet[side])] * point;
  return points;
}

double Soles::lowest(const Skeleton& skeleton, const Pose& pose) const {
  double lowest = 1e300;
  for (const std::vector<Vec3>& foot : points(skeleton, pose))
    for (const Vec3& point : foot) lowest = std::min(lowest, point.y());
  return lowest;
}

}  // namespace ukemi
