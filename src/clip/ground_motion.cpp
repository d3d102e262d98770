#include "clip/ground_motion.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

Vec3 mean_place(const std::vector<Rigid>& segments) {
  Vec3 sum = Vec3::Zero();
  for (const Rigid& segment : segments) sum += level(segment.translation);
  return sum / static_cast<double>(segments.size());
}

}  // namespace

Vec3 level(const Vec3& v) { return {v.x(), 0.0, v.z()}; }

double facing(const Quat& world_from_segment) {
  const Vec3 up = world_from_segment * Vec3::UnitY();
  const Vec3 ahead = shortest_rotation(up, Vec3::UnitY()) * (world_from_segment * Vec3::UnitX());
  return std::atan2(-ahead.z(), ahead.x());
}

Rigid GroundMove::operator*(const Rigid& segment) const {
  const Quat turn(Eigen::AngleAxisd(yaw, Vec3::UnitY()));
  return {(turn * segment.rotation).normalized(), turn * (segment.translation - from) + to};
}

Pose GroundMove::moved(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose) const {
  const BodyPose before = segments_of(skeleton, humanoid, pose);
  BodyPose after = before;
  for (Rigid& segment : after) segment = *this * segment;
  return pose_skeleton(skeleton, humanoid, pose, before, after);
}

GroundMove ground_move(const std::vector<Rigid>& from, const std::vector<Rigid>& to) {
  Vec2 turn = Vec2::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double yaw = facing(to[i].rotation) - facing(from[i].rotation);
    turn += Vec2(std::cos(yaw), std::sin(yaw));
  }
  return {std::atan2(turn.y(), turn.x()), mean_place(from), mean_place(to)};
}

std::vector<int> movers(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::vector<int> nodes{humanoid.root};
  for (const SegmentNodes& segment : humanoid.segments)
    if (segment.detached && !segment.fused() && !skeleton.is_ancestor(humanoid.root, segment.chain.front()))
      nodes.push_back(segment.chain.front());
  return nodes;
}

void displace(const Skeleton& skeleton, const Humanoid& humanoid, const std::vector<int>& nodes,
              const Vec3& offset, Pose& pose) {
  const std::vector<Affine> world = world_transforms(skeleton, pose);
  const Similarity file_from_world = humanoid.world_from_file.inverse();
  const Vec3 file_offset = file_from_world.scale * (file_from_world.rotation * offset);
  for (const int node : nodes) {
    const int parent = skeleton.nodes[node].parent;
    pose[node].translation += parent < 0 ? file_offset : Vec3(world[parent].linear().inverse() * file_offset);
  }
}

}  // namespace ukemi
