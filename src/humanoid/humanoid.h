// Which node is which segment, and the anatomical frames of the segments in any pose.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/math.h"
#include "base/result.h"
#include "base/segments.h"
#include "bones/options.h"

namespace ukemi {

/// The nodes that move a segment.
struct SegmentNodes {
  /// Nodes that share the joint above the segment, proximal first; the last one carries the segment's
  /// rotation in full, node k of n turns by (k + 1) / n of it. Empty: the segment is fused.
  std::vector<int> chain;
  /// True when the segment above does not carry chain.front() (IK-style feet, clavicles on a neck): the clip
  /// then moves its translation as well, with the segment above.
  bool detached = false;
  std::string by;  // "vrm", "name", "topology", "user"; "" when fused

  bool fused() const { return chain.empty(); }
  int node() const { return chain.empty() ? -1 : chain.back(); }
};

/// A bone along a limb that spreads its twist: at the joint above none of it, at the next joint all.
struct TwistBone {
  int node = -1;
  Segment segment = Segment::upperarm_l;
  double share = 0.5;  // of the segment's twist against the one above
};

/// The segment at the far end of an upper arm, forearm, thigh or shank.
Segment limb_end(Segment limb);

enum class RestPoseClass { t_pose, a_pose, neutral, other };
std::string_view name(RestPoseClass pose);  // "T", "A", "neutral", "other"

/// A motion without a character: its clip is the only source of the person's posture.
bool only_motion(const Character& character);

struct Humanoid {
  PerSegment<SegmentNodes> segments;
  /// Takes the pelvis's motion: the pelvis node, or the lowest node above pelvis, thighs and spine where
  /// those do not hang on the pelvis node.
  int root = -1;
  Similarity world_from_file;                      // metres, y up; no translation
  double height_m = 0.0;                           // sole to crown, standing
  char up_axis = 'y';                              // of the file
  RestPoseClass rest_pose = RestPoseClass::other;  // of the file's rest pose
  /// Pose the frames were read from and standing poses start from: the rest pose; the bind pose where the
  /// rest pose is a crouch; the best frame of a motion whose zero pose is not a pose.
  Pose reference;
  /// Anatomical frame of each segment in its node: world_from_segment = world_from_node * this (rotations).
  /// Axes in the neutral pose (upright, arms hanging, palms to the thighs, feet forward): x anterior, y up,
  /// z to the subject's right, the same for all segments.
  PerSegment<Quat> node_from_segment;
  /// Origin of a fused segment in the node of the segment it moves with (see carrier); zero for the others.
  PerSegment<Vec3> fused_origin{};
  std::vector<TwistBone> twist_bones;  // parents first
  /// Further nodes that shapes and poses need; -1 where there are none.
  int head_top = -1;
  std::array<int, 2> toes{-1, -1};           // left, right
  std::array<int, 2> middle_finger{-1, -1};  // base of the middle finger (or of the only one)

  /// The segment that moves `s`: itself, or where it is fused the nearest one above that is not.
  Segment carrier(Segment s) const;
  /// The node that a segment's first node moves with: of the segment above, or the root.
  int holder_of(Segment s) const;
  int carrier_node(Segment s) const { return segments[index(carrier(s))].node(); }
};

/// Finds the segments by the user's map, VRM human bones, names, then topology and geometry; then unit, up
/// axis and anatomical frames (from the rest pose; a file with only motion may need its first frame).
/// Errors: input, "not a humanoid: ..." with what was looked for and what was found; usage for a bad map.
Result<Humanoid> map_humanoid(const Character& character, const HumanoidOptions& options,
                              Diagnostics& diagnostics);

/// Segments of a pose. Origin: the joint above the segment (the mean of its chain's nodes; pelvis: midway
/// between the hip joints), metres, y-up world. Axes: anatomical, see Humanoid::node_from_segment.
/// A fused segment moves with its parent.
using BodyPose = PerSegment<Rigid>;

/// Segments of `pose` as the rig's nodes have them.
BodyPose segments_of(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose);

/// The same with the free rolls chosen like a human body, because rigs put them on whatever bone they like:
/// (a) the forearm takes the hand's twist, (b) the trunk's side bend, flexion and turn are split 0.46, 0.54,
/// 0.30 to the abdomen and the rest to the chest, (c) upper arm and thigh are rolled until elbow and knee
/// bend in their hinge plane (weight 0 below 4 degrees of bend, 1 above 14; not by more than 90, or 120 from
/// 30 degrees of bend on), (d) the shank takes 60 % of the toe-out, 18 in to 24 degrees out. Positions are
/// unchanged; fused segments follow the segment they move with.
BodyPose canonical_segments_of(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose);

/// Poses the skeleton: `base`, with every segment turned and the pelvis (and detached segments) moved by what
/// takes `from` (the segments of `base`) to `to`. Twist bones take their share of the twist; other nodes of
/// no segment keep their local transform. Inverse of segments_of for single-node chains and uniform scales,
/// negative and mirrored ones included.
Pose pose_skeleton(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& base, const BodyPose& from,
                   const BodyPose& to);

/// "rest": as the file has it. "stand": natural standing, arms hanging. "guard": fists up, feet apart.
enum class StartPose { rest, stand, guard };

/// How "stand" is stood in.
struct StanceOptions {
  /// As people do: the weight 3 cm ahead of the ankles (more where heels are short), a foot a little ahead,
  /// more weight on one leg, unequal arms. Otherwise even, the weight over the ankles.
  bool living = false;
  /// A living stance that leans into a blow from there (front, right; unit), feet apart and knees bent. Zero:
  /// at ease.
  Vec2 braced_against = Vec2::Zero();
  std::uint64_t seed = 0;  // varies a living stance; 0: the mean one
};

/// The start pose: facing and ground position of the reference pose, lowest sole point on the floor (y = 0).
Pose start_pose(const Character& character, const Humanoid& humanoid, StartPose kind,
                const StanceOptions& stance = {});

/// Moves the whole figure up or down so that its lowest foot stands on y = 0 (world).
Pose stand_on_floor(const Character& character, const Humanoid& humanoid, const Pose& pose);

}  // namespace ukemi
