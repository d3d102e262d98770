#include <cmath>

#include "humanoid/humanoid.h"
#include "humanoid/twist.h"

namespace ukemi {
namespace {

/// What a node of the skeleton does when the body moves.
struct NodeMotion {
  bool turns = false;
  bool moves = false;
  int holder = -1;               // moves with this node; -1: with its segment
  Quat turn = Quat::Identity();  // world, y up
  Segment segment = Segment::pelvis;
};

bool is_hand(Segment s) { return s == Segment::hand_l || s == Segment::hand_r; }

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
      // Bones of a hand lie in one place, and thumbs hang on the first of them.
      const bool whole = k + 1 == nodes.chain.size() || is_hand(segment);
      motion.turn = whole ? turn : parent_turn.slerp((static_cast<double>(k) + 1.0) / n, turn);
      motion.moves = nodes.detached && k == 0;
      if (motion.moves) motion.holder = humanoid.holder_of(segment);
    }
  }
  for (const TwistBone& bone : humanoid.twist_bones) {
    const Quat above = turn_of(from, to, humanoid.carrier(parent_of(bone.segment)));
    const Quat relative = (above.conjugate() * turn_of(from, to, bone.segment)).normalized();
    const Vec3 limb = from[index(limb_end(bone.segment))].translation - from[index(bone.segment)].translation;
    if (limb.norm() < 1e-9) continue;
    motions[bone.node] = {true, false, -1,
                          above * with_less_twist(relative, limb.normalized(), 1.0 - bone.share),
                          bone.segment};
  }
  if (humanoid.root >= 0)
    motions[humanoid.root] = {true, true, -1, turn_of(from, to, Segment::pelvis), Segment::pelvis};
  return motions;
}

/// Poses the nodes one by one, each after its parent and the node that it moves with.
class Poser {
 public:
  Poser(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& base, const BodyPose& from,
        const BodyPose& to)
      : skeleton_(skeleton),
        humanoid_(humanoid),
        base_(base),
        from_(from),
        to_(to),
        motions_(motions_of(skeleton, humanoid, from, to)),
        start_(world_transforms(skeleton, base)),
        now_(start_.size()),
        done_(start_.size(), 0),
        pose_(base) {}

  Pose posed() {
    // Hardly ever more than one round: a holder may come after what it holds.
    for (std::size_t left = skeleton_.order.size(), before = left + 1; left > 0 && left < before;) {
      before = left;
      left = 0;
      for (const int i : skeleton_.order)
        if (!done_[i] && !place(i)) ++left;
    }
    return std::move(pose_);
  }

 private:
  bool place(int i) {
    const int parent = skeleton_.nodes[i].parent;
    const NodeMotion& motion = motions_[i];
    if ((parent >= 0 && !done_[parent]) || (motion.holder >= 0 && !done_[motion.holder])) return false;
    const Affine parent_start = parent < 0 ? Affine::Identity() : start_[parent];
    const Affine parent_now = parent < 0 ? Affine::Identity() : now_[parent];
    if (motion.turns) turn(i, parent_start, parent_now);
    if (motion.moves) pose_[i].translation = parent_now.inverse() * moved(i);
    now_[i] = parent_now * pose_[i].affine();
    done_[i] = 1;
    return true;
  }

  /// The new world linear part is D * start; with the scale kept, the local rotation is what remains.
  void turn(int i, const Affine& parent_start, const Affine& parent_now) {
    const Quat& upright = humanoid_.world_from_file.rotation;
    const Mat3 turn = (upright.conjugate() * motions_[i].turn * upright).toRotationMatrix();
    const Mat3 local =
        parent_now.linear().inverse() * turn * parent_start.linear() * base_[i].rotation.toRotationMatrix();
    pose_[i].rotation = nearest_sign(rotation_part(local), base_[i].rotation);
  }

  /// New place of a node, file units.
  Vec3 moved(int i) const {
    const NodeMotion& motion = motions_[i];
    if (motion.holder >= 0)
      return now_[motion.holder] * (start_[motion.holder].inverse() * start_[i].translation());
    const Rigid& before = from_[index(motion.segment)];
    const Rigid& after = to_[index(motion.segment)];
    const Vec3 place = humanoid_.world_from_file * start_[i].translation();
    const Vec3 there = after.translation + turn_of(from_, to_, motion.segment) * (place - before.translation);
    return humanoid_.world_from_file.inverse() * there;
  }

  const Skeleton& skeleton_;
  const Humanoid& humanoid_;
  const Pose& base_;
  const BodyPose &from_, &to_;
  std::vector<NodeMotion> motions_;
  std::vector<Affine> start_, now_;
  std::vector<char> done_;
  Pose pose_;
};

}  // namespace

Pose pose_skeleton(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& base, const BodyPose& from,
                   const BodyPose& to) {
  return Poser(skeleton, humanoid, base, from, to).posed();
}

}  // namespace ukemi
