// Motion of one skeleton on another.
#pragma once

#include <vector>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Poses of a skeleton (`from`) as poses of a character (`to`).
/// 1. Where both are the same skeleton (every node of a segment has a namesake whose rest transform is the
///    same up to the unit), nodes with namesakes take the local motion, fingers and twist bones included.
/// 2. Else every segment takes the world rotation of its counterpart's anatomical frame, with the free rolls
///    of canonical_segments_of; nodes of no segment stay as in the character's reference pose.
/// 3. The pelvis moves like the other, scaled by the ratio of the lengths of the legs.
/// The four arguments must outlive the transfer.
class Transfer {
 public:
  Transfer(const Character& to, const Humanoid& to_humanoid, const Character& from,
           const Humanoid& from_humanoid);

  bool same_skeleton() const { return !namesakes_.empty(); }
  /// World, metres; the floor is that of the other figure, scaled.
  Pose operator()(const Pose& pose) const;

 private:
  /// A node of the character, the other's node of the same name, and the ratio of their local units.
  struct Namesake {
    int mine, theirs;
    double length_ratio;
  };

  std::vector<Namesake> find_namesakes() const;
  Pose with_local_motion(const Pose& pose) const;
  Pose with_segment_rotations(const BodyPose& body) const;
  Pose moved_as_a_whole(const Pose& pose, const Quat& turn, const Vec3& pelvis) const;

  const Character& to_;
  const Humanoid& to_humanoid_;
  const Character& from_;
  const Humanoid& from_humanoid_;
  double size_ratio_;  // leg of the character over leg of the other
  std::vector<Namesake> namesakes_;
};

}  // namespace ukemi
