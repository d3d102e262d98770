#include "humanoid/refine.h"

#include <algorithm>

#include "humanoid/figure.h"

namespace ukemi {
namespace {

constexpr std::size_t kMostFrames = 1500;
constexpr int kUprightForTrunk = 80;
constexpr int kUprightForClavicles = 15;

/// Mean of rotations: the rotation nearest to the mean matrix.
struct MeanRotation {
  Mat3 sum = Mat3::Zero();
  int count = 0;

  void add(const Quat& q) {
    sum += q.toRotationMatrix();
    ++count;
  }
  Quat mean() const { return count == 0 ? Quat::Identity() : rotation_part(sum); }
};

bool is_upright(const Figure& f, const Vec3& up) {
  if (angle(f[Segment::head] - f.hips(), up) > radians(20)) return false;
  for (int side = 0; side < 2; ++side) {
    const Vec3 thigh = f.link(kThigh[side], kShank[side]), shank = f.link(kShank[side], kFoot[side]);
    if (angle(thigh, -up) > radians(35) || angle(thigh, shank) > radians(60)) return false;
    if (angle(f.link(kUpperArm[side], kForearm[side]), -up) > radians(45)) return false;
  }
  return true;
}

/// Relative rotations parent -> segment of one frame, by the frames as they stand.
PerSegment<Quat> relative_rotations(const Humanoid& humanoid, const Figure& figure) {
  PerSegment<Quat> world, relative;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Quat node = rotation_part(figure.world[humanoid.carrier_node(segment_at(s))].linear());
    world[s] = node * humanoid.node_from_segment[s];
    relative[s] = world[index(parent_of(segment_at(s)))].conjugate() * world[s];
  }
  return relative;
}

Quat without_turn(const Quat& q) {
  const double half = 0.5 * twist_angle(q, Vec3::UnitY());
  return q * Quat(std::cos(half), 0.0, -std::sin(half), 0.0);
}

struct Means {
  PerSegment<MeanRotation> upright, all;
};

Means measure(const Character& character, const Reference& reference, const Humanoid& humanoid) {
  Means means;
  for (const double t : sample_times(character.animations[0], kMostFrames)) {
    const Figure figure(character, humanoid, sample(character.skeleton, character.animations[0], t));
    const bool upright = is_upright(figure, reference.up);
    const PerSegment<Quat> relative = relative_rotations(humanoid, figure);
    for (int s = 1; s < kSegmentCount; ++s) {
      means.all[s].add(relative[s]);
      if (upright) means.upright[s].add(relative[s]);
    }
  }
  return means;
}

/// With C the correction (new frame = old frame * C), a mean relative rotation M becomes neutral when C =
/// M^-1 C_parent.
void centre(const Means& means, Humanoid& humanoid) {
  PerSegment<Quat> correction;
  correction.fill(Quat::Identity());
  const auto apply = [&](Segment s, const Quat& mean) {
    if (humanoid.segments[index(s)].fused()) return;
    correction[index(s)] = mean.conjugate() * correction[index(parent_of(s))];
    humanoid.node_from_segment[index(s)] =
        (humanoid.node_from_segment[index(s)] * correction[index(s)]).normalized();
  };
  const int upright = means.upright[index(Segment::chest)].count;
  if (upright >= kUprightForTrunk)
    for (const Segment s : {Segment::abdomen, Segment::chest, Segment::head})
      apply(s, without_turn(means.upright[index(s)].mean()));
  if (upright >= kUprightForClavicles)
    for (const Segment s : {Segment::clavicle_l, Segment::clavicle_r})
      apply(s, means.upright[index(s)].mean());
  for (const Segment s : {Segment::hand_l, Segment::hand_r}) apply(s, means.all[index(s)].mean());
}

/// Frame of a foot that lies flat: y up, x towards the toes.
void read_feet_where_flat(const Character& character, const Reference& reference, Humanoid& humanoid) {
  for (int side = 0; side < 2; ++side) {
    const int foot = humanoid.segments[index(kFoot[side])].node();
    const int toe = humanoid.toes[side];
    if (foot < 0 || toe < 0) continue;
    double lowest = 1e300;
    for (const double t : sample_times(character.animations[0], kMostFrames)) {
      const auto world =
          world_transforms(character.skeleton, sample(character.skeleton, character.animations[0], t));
      const Vec3 ankle = world[foot].translation(), tip = world[toe].translation();
      const double height = ankle.dot(reference.up) + tip.dot(reference.up);
      const Vec3 forward = (tip - ankle) - (tip - ankle).dot(reference.up) * reference.up;
      if (height >= lowest || forward.norm() < 0.3 * (tip - ankle).norm()) continue;
      lowest = height;
      Mat3 frame;
      frame << forward.normalized(), reference.up, forward.normalized().cross(reference.up);
      humanoid.node_from_segment[index(kFoot[side])] =
          (rotation_part(world[foot].linear()).conjugate() * Quat(frame)).normalized();
    }
  }
}

}  // namespace

void refine_from_motion(const Character& character, const Reference& reference, Humanoid& humanoid) {
  if (!only_motion(character)) return;
  if (reference.is_frame) read_feet_where_flat(character, reference, humanoid);
  centre(measure(character, reference, humanoid), humanoid);
}

}  // namespace ukemi
