#include <cmath>

#include "humanoid/humanoid.h"
#include "humanoid/twist.h"

namespace ukemi {
namespace {

/// What a node of the skeleton does when the body moves.
struct NodeMotion {
  bool turns = false;
  bool moves = false;
  Quat turn = Quat::Identity();  // world, y up
  Segment segment = Segment::pelvis;
};

Quat turn_of(const BodyPose& from, const BodyPose& to, Segment s) {
  return (to[index(s)].rotation * from[index(s)].rotation.conjugate()).normalized();
}

std::vector<NodeMotion> motions_of(const Skeleton& skeleton, const Humanoid& humanoid, const BodyPose& from,
                                   const BodyPose& to) {
  std::vector<NodeMotion> motions(skeleton.nodes.size());
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentNodes& nodes = humanoid.segments[s];
    if (nodes.fused()) continue;
    const Segment segment = segment_at(s);
    const Quat turn = turn_of(from, to, segment);
    const Quat parent_turn = turn_of(from, to, humanoid.carrier(parent_of(segment)));
    const auto n = static_cast<double>(nodes.chain.size());
    for (std::size_t k = 0; k < nodes.chain.size(); ++k) {
      NodeMotion& motion = motions[nodes.chain[k]];
      motion.turns = true;
      motion.segment = segment;
      motion.turn =
          k + 1 == nodes.chain.size() ? turn : parent_turn.slerp((static_cast<double>(k) + 1.0) / n, turn);
      motion.moves = nodes.detached && k == 0;
    }
  }
  for (const TwistBone& bone : humanoid.twist_bones) {
    const Quat above = turn_of(from, to, humanoid.carrier(parent_of(bone.segment)));
    const Quat relative = (above.conjugate() * turn_of(from, to, bone.segment)).normalized();
    const Vec3 limb = from[index(limb_end(bone.segment))].translation - from[index(bone.segment)].translation;
    if (limb.norm() < 1e-9) continue;
    motions[bone.node] = {true, false, above * with_less_twist(relative, limb.normalized(), 1.0 - bone.share),
                          bone.segment};
  }
  if (humanoid.root >= 0)
    motions[humanoid.root] = {true, true, turn_of(from, to, Segment::pelvis), Segment::pelvis};
  return motions;
}

}  // namespace

Pose pose_skeleton(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& base, const BodyPose& from,
                   const BodyPose& to) {
  const std::vector<NodeMotion> motions = motions_of(skeleton, humanoid, from, to);
  const std::vector<Affine> start = world_transforms(skeleton, base);
  const Similarity file_from_world = humanoid.world_from_file.inverse();
  const Quat& upright = humanoid.world_from_file.rotation;
  std::vector<Affine> now(start.size());
  Pose pose = base;
  for (const int i : skeleton.order) {
    const int parent = skeleton.nodes[i].parent;
    const Affine parent_start = parent < 0 ? Affine::Identity() : start[parent];
    const Affine parent_now = parent < 0 ? Affine::Identity() : now[parent];
    const NodeMotion& motion = motions[i];
    if (motion.turns) {
      // The new world linear part is D * start; with the scale kept, the local rotation is what remains.
      const Mat3 turn = (upright.conjugate() * motion.turn * upright).toRotationMatrix();
      const Mat3 local =
          parent_now.linear().inverse() * turn * parent_start.linear() * base[i].rotation.toRotationMatrix();
      pose[i].rotation = nearest_sign(rotation_part(local), base[i].rotation);
    }
    if (motion.moves) {
      const Rigid& before = from[index(motion.segment)];
      const Rigid& after = to[index(motion.segment)];
      const Vec3 place = humanoid.world_from_file * start[i].translation();
      const Vec3 moved = after.translation + turn_of(from, to, motion.segment) * (place - before.translation);
      pose[i].translation = parent_now.inverse() * (file_from_world * moved);
    }
    now[i] = parent_now * pose[i].affine();
  }
  return pose;
}

}  // namespace ukemi
