#include "humanoid/transfer.h"

#include <cmath>

#include "humanoid/landmarks.h"

namespace ukemi {
namespace {

constexpr double kSameRotation = radians(1.0);
constexpr double kSamePlace = 0.02;  // of the length of a leg

double leg_length(const Character& character, const Humanoid& humanoid) {
  const Landmarks f(character, humanoid, humanoid.reference);
  double length = 0.0;
  for (int side = 0; side < 2; ++side)
    length += 0.5 * (f.link(kThigh[side], kShank[side]).norm() + f.link(kShank[side], kFoot[side]).norm());
  return humanoid.world_from_file.scale * length;
}

/// Rest rotations of all nodes in the y-up world, their places in their parents (metres), and the metres of
/// their local unit.
struct RestPlaces {
  std::vector<Quat> world_rotation;
  std::vector<Vec3> in_parent;
  std::vector<double> unit_m;

  RestPlaces(const Skeleton& skeleton, const Humanoid& humanoid) {
    const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
    for (int i = 0; i < skeleton.size(); ++i) {
      const int parent = skeleton.nodes[i].parent;
      const Affine above = parent < 0 ? Affine::Identity() : world[parent];
      const Vec3 link = world[i].translation() - above.translation();
      world_rotation.push_back(humanoid.world_from_file.rotation * rotation_part(world[i].linear()));
      in_parent.push_back(humanoid.world_from_file.scale *
                          (rotation_part(above.linear()).conjugate() * link));
      unit_m.push_back(humanoid.world_from_file.scale * std::cbrt(std::abs(above.linear().determinant())));
    }
  }
};

}  // namespace

Transfer::Transfer(const Character& to, const Humanoid& to_humanoid, const Character& from,
                   const Humanoid& from_humanoid)
    : to_(to),
      to_humanoid_(to_humanoid),
      from_(from),
      from_humanoid_(from_humanoid),
      size_ratio_(leg_length(to, to_humanoid) / leg_length(from, from_humanoid)),
      namesakes_(find_namesakes()) {}

/// Empty where the skeletons are not the same.
std::vector<Transfer::Namesake> Transfer::find_namesakes() const {
  const double leg = leg_length(to_, to_humanoid_);
  const RestPlaces mine(to_.skeleton, to_humanoid_), theirs(from_.skeleton, from_humanoid_);
  const std::map<std::string, int> my_names = nodes_by_plain_name(to_.skeleton);
  const std::map<std::string, int> their_names = nodes_by_plain_name(from_.skeleton);
  std::vector<Namesake> namesakes;
  std::vector<char> has_namesake(to_.skeleton.nodes.size(), 0);
  for (int i = 0; i < to_.skeleton.size(); ++i) {
    const std::string& name = to_.skeleton.nodes[i].name;
    const auto mine_named = my_names.find(plain_name(name)), their_named = their_names.find(plain_name(name));
    const bool is_unique = mine_named != my_names.end() && mine_named->second == i;
    const int other = is_unique && their_named != their_names.end() ? their_named->second : -1;
    if (other < 0 || angle_between(mine.world_rotation[i], theirs.world_rotation[other]) > kSameRotation)
      continue;
    const double distance = (mine.in_parent[i] - size_ratio_ * theirs.in_parent[other]).norm();
    if (i != to_humanoid_.root && distance > kSamePlace * leg) continue;
    namesakes.push_back({i, other, size_ratio_ * theirs.unit_m[other] / mine.unit_m[i]});
    has_namesake[i] = 1;
  }
  bool same = to_humanoid_.root >= 0 && has_namesake[to_humanoid_.root];
  for (const SegmentNodes& segment : to_humanoid_.segments)
    for (const int node : segment.chain) same = same && has_namesake[node];
  return same ? namesakes : std::vector<Namesake>{};
}

Pose Transfer::operator()(const Pose& pose) const {
  return same_skeleton()
             ? with_local_motion(pose)
             : with_segment_rotations(canonical_segments_of(from_.skeleton, from_humanoid_, pose));
}

/// The whole figure turned about its pelvis, which comes to stand at `pelvis`.
Pose Transfer::moved_as_a_whole(const Pose& pose, const Quat& turn, const Vec3& pelvis) const {
  const BodyPose from = segments_of(to_.skeleton, to_humanoid_, pose);
  const Vec3 centre = from[index(Segment::pelvis)].translation;
  BodyPose to = from;
  for (Rigid& segment : to) {
    segment.rotation = turn * segment.rotation;
    segment.translation = pelvis + turn * (segment.translation - centre);
  }
  return pose_skeleton(to_.skeleton, to_humanoid_, pose, from, to);
}

Pose Transfer::with_local_motion(const Pose& pose) const {
  Pose result = rest_pose(to_.skeleton);
  int their_root = -1;
  for (const auto& [mine, theirs, length_ratio] : namesakes_) {
    result[mine].rotation = pose[theirs].rotation;
    const Vec3 shift = pose[theirs].translation - from_.skeleton.nodes[theirs].rest.translation;
    if (mine == to_humanoid_.root)
      their_root = theirs;
    else
      result[mine].translation += length_ratio * shift;
  }
  const auto root_rotation = [](const Character& character, const Humanoid& humanoid, const Pose& p,
                                int node) {
    const Affine world = world_transforms(character.skeleton, p)[node];
    return Quat(humanoid.world_from_file.rotation * rotation_part(world.linear()));
  };
  const Quat now = root_rotation(to_, to_humanoid_, result, to_humanoid_.root);
  const Quat wanted = root_rotation(from_, from_humanoid_, pose, their_root);
  const Vec3 pelvis = segments_of(from_.skeleton, from_humanoid_, pose)[index(Segment::pelvis)].translation;
  return moved_as_a_whole(result, wanted * now.conjugate(), size_ratio_ * pelvis);
}

Pose Transfer::with_segment_rotations(const BodyPose& body) const {
  const BodyPose from = segments_of(to_.skeleton, to_humanoid_, to_humanoid_.reference);
  BodyPose to;
  to[index(Segment::pelvis)] = {body[index(Segment::pelvis)].rotation,
                                size_ratio_ * body[index(Segment::pelvis)].translation};
  for (int s = 1; s < kSegmentCount; ++s) {
    const int parent = index(parent_of(segment_at(s)));
    const bool fused = to_humanoid_.segments[s].fused();
    to[s].rotation =
        fused ? to[parent].rotation * from[parent].rotation.conjugate() * from[s].rotation : body[s].rotation;
    to[s].translation = to[parent] * (from[parent].inverse() * from[s].translation);
  }
  return pose_skeleton(to_.skeleton, to_humanoid_, to_humanoid_.reference, from, to);
}

}  // namespace ukemi
