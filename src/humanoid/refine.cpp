#include "humanoid/refine.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "humanoid/landmarks.h"

namespace ukemi {
namespace {

constexpr int kMostFrames = 600;
constexpr int kUprightForTrunk = 80;
constexpr int kUprightForClavicles = 15;
constexpr double kBrokenBend = radians(80.0);  // of a wrist from its middle: the tracker lost the hand

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

/// Mean of the rotations that lie near their middle.
Quat mean_of_whole(const std::vector<Quat>& rotations) {
  constexpr int kRounds = 3;
  Quat middle = Quat::Identity();
  for (int round = 0; round < kRounds; ++round) {
    MeanRotation mean;
    for (const Quat& q : rotations)
      if (round == 0 || angle_between(middle, q) < kBrokenBend) mean.add(q);
    middle = mean.mean();
  }
  return middle;
}

bool is_upright(const Landmarks& f, const Vec3& up) {
  if (angle(f[Segment::head] - f.hips(), up) > radians(20)) return false;
  for (int side = 0; side < 2; ++side) {
    const Vec3 thigh = f.link(kThigh[side], kShank[side]), shank = f.link(kShank[side], kFoot[side]);
    if (angle(thigh, -up) > radians(35) || angle(thigh, shank) > radians(60)) return false;
    if (angle(f.link(kUpperArm[side], kForearm[side]), -up) > radians(45)) return false;
  }
  return true;
}

/// Relative rotations parent -> segment of one frame, by the frames as they stand.
PerSegment<Quat> relative_rotations(const Humanoid& humanoid, const Landmarks& figure) {
  PerSegment<Quat> world, relative;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Quat node = rotation_part(figure.world[humanoid.carrier_node(segment_at(s))].linear());
    world[s] = node * humanoid.node_from_segment[s];
    relative[s] = world[index(parent_of(segment_at(s)))].conjugate() * world[s];
  }
  return relative;
}

Quat turn(double angle) { return Quat(std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0); }
Quat without_turn(const Quat& q) { return q * turn(-twist_angle(q, Vec3::UnitY())); }

/// One hand over the motion, against a forearm that has taken its twist over.
struct HandMotion {
  std::vector<Quat> bends;
  Vec2 pronation = Vec2::Zero();  // sum of (cos, sin) of the forearm's turn against the upper arm
};

struct Means {
  PerSegment<MeanRotation> upright;
  std::array<HandMotion, 2> hands;  // left, right
};

void add_hand(const PerSegment<Quat>& relative, int side, HandMotion& motion) {
  const Quat& hand = relative[index(kHand[side])];
  const double twist = twist_angle(hand, Vec3::UnitY());
  const double turned = twist_angle(relative[index(kForearm[side])] * turn(twist), Vec3::UnitY());
  motion.bends.push_back(turn(-twist) * hand);
  motion.pronation += Vec2(std::cos(turned), std::sin(turned));
}

Means measure(const std::vector<Landmarks>& figures, const Vec3& up, const Humanoid& humanoid) {
  Means means;
  for (const Landmarks& figure : figures) {
    const PerSegment<Quat> relative = relative_rotations(humanoid, figure);
    for (int side = 0; side < 2; ++side) add_hand(relative, side, means.hands[side]);
    if (!is_upright(figure, up)) continue;
    for (int s = 1; s < kSegmentCount; ++s) means.upright[s].add(relative[s]);
  }
  return means;
}

/// The turn about y that takes the axis about which the wrist bends most to that of flexion (x, palms to the
/// thighs): the range in flexion is more than twice that in deviation. Of the two such turns the one that
/// leaves the forearm nearer the middle of pronation, none that takes it away from there. 0 where the wrist
/// hardly bends, or as far to every side.
double hand_roll(const HandMotion& motion, const Quat& mean) {
  constexpr double kLeastSpread = radians(8.0);
  constexpr double kLeastRatio = 1.5;
  constexpr double kMiddle = radians(25.0);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const Quat& q : motion.bends) {
    const Vec3 bend = log_rotation(q * mean.conjugate());
    if (bend.norm() > kBrokenBend) continue;
    spread += Vec2(bend.x(), bend.z()) * Vec2(bend.x(), bend.z()).transpose();
    ++count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread / std::max(count, 1));
  const double least = std::sqrt(std::max(axes.eigenvalues()[0], 0.0));
  const double most = std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
  if (most < kLeastSpread || most < kLeastRatio * least) return 0.0;
  const Vec2 flexion = axes.eigenvectors().col(1);
  const double roll = std::atan(-flexion.y() / flexion.x());
  const double pronation = std::atan2(motion.pronation.y(), motion.pronation.x());
  const double opposite = roll - std::copysign(kPi, roll);
  const double best = std::abs(pronation + opposite) < std::abs(pronation + roll) ? opposite : roll;
  return std::abs(pronation + best) <= std::max(std::abs(pronation), kMiddle) ? best : 0.0;
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
  for (int side = 0; side < 2; ++side) {
    const Segment hand = kHand[side];
    if (humanoid.segments[index(hand)].fused()) continue;
    const Quat mean = mean_of_whole(means.hands[side].bends);
    apply(hand, mean);
    Quat& frame = humanoid.node_from_segment[index(hand)];
    frame = (frame * turn(hand_roll(means.hands[side], mean))).normalized();
  }
}

/// Mean axis of a hinge in its two bones' nodes, from frames bent by more than 30 degrees.
struct HingeAxis {
  Vec3 upper = Vec3::Zero(), lower = Vec3::Zero();
  int count = 0;
};

HingeAxis measure_hinge(const std::vector<Landmarks>& figures, const Humanoid& humanoid, Segment upper,
                        Segment lower, Segment end) {
  HingeAxis axis;
  const int upper_node = humanoid.carrier_node(upper), lower_node = humanoid.carrier_node(lower);
  for (const Landmarks& f : figures) {
    const Vec3 n =
        f.link(upper, lower).normalized().cross(f.link(lower, end).normalized());  // length sin(bend)
    if (angle(f.link(upper, lower), f.link(lower, end)) < radians(30)) continue;
    axis.upper += rotation_part(f.world[upper_node].linear()).conjugate() * n;
    axis.lower += rotation_part(f.world[lower_node].linear()).conjugate() * n;
    ++axis.count;
  }
  return axis;
}

/// Rolls a segment's frame about its y axis until z points along `axis` (node coordinates).
void roll_to(Humanoid& humanoid, Segment s, const Vec3& axis) {
  Quat& frame = humanoid.node_from_segment[index(s)];
  const Vec3 y = frame * Vec3::UnitY();
  const Vec3 z = axis - axis.dot(y) * y;
  if (z.norm() < 0.3 * axis.norm()) return;
  Mat3 m;
  m << y.cross(z.normalized()), y, z.normalized();
  frame = Quat(m);
}

void read_hinges(const std::vector<Landmarks>& figures, Humanoid& humanoid) {
  constexpr int kFrames = 10;
  for (int side = 0; side < 2; ++side) {
    const HingeAxis elbow = measure_hinge(figures, humanoid, kUpperArm[side], kForearm[side], kHand[side]);
    if (elbow.count >= kFrames) roll_to(humanoid, kUpperArm[side], elbow.upper);
    const HingeAxis knee = measure_hinge(figures, humanoid, kThigh[side], kShank[side], kFoot[side]);
    if (knee.count < kFrames) continue;
    roll_to(humanoid, kThigh[side], -knee.upper);
    roll_to(humanoid, kShank[side], -knee.lower);
  }
}

struct FootReading {
  double height;
  Quat node_from_foot;  // as if the foot lay flat: y up, x towards the toes
};

/// The foot as if it lay flat: y up, x towards the toes. Nothing on tiptoe or below a shank that does not
/// stand.
std::optional<FootReading> read_foot(const Landmarks& figure, const Vec3& up, int side, int foot, int toe) {
  const Vec3 ankle = figure.world[foot].translation(), tip = figure.world[toe].translation();
  const Vec3 forward = (tip - ankle) - (tip - ankle).dot(up) * up;
  if (forward.norm() < 0.8 * (tip - ankle).norm()) return std::nullopt;
  if (angle(figure.link(kShank[side], kFoot[side]), -up) > radians(30)) return std::nullopt;
  Mat3 frame;
  frame << forward.normalized(), up, forward.normalized().cross(up);
  return FootReading{(ankle + tip).dot(up),
                     rotation_part(figure.world[foot].linear()).conjugate() * Quat(frame)};
}

/// Mean over the lowest tenth of the readings, where feet lie flat.
void read_feet_where_flat(const std::vector<Landmarks>& figures, const Vec3& up, Humanoid& humanoid) {
  for (int side = 0; side < 2; ++side) {
    const int foot = humanoid.segments[index(kFoot[side])].node();
    const int toe = humanoid.toes[side];
    if (foot < 0 || toe < 0) continue;
    std::vector<FootReading> readings;
    for (const Landmarks& figure : figures)
      if (const auto reading = read_foot(figure, up, side, foot, toe)) readings.push_back(*reading);
    std::stable_sort(readings.begin(), readings.end(),
                     [](const FootReading& a, const FootReading& b) { return a.height < b.height; });
    MeanRotation mean;
    for (std::size_t i = 0; i < (readings.size() + 9) / 10; ++i) mean.add(readings[i].node_from_foot);
    if (mean.count > 0) humanoid.node_from_segment[index(kFoot[side])] = mean.mean();
  }
}

}  // namespace

void refine_from_motion(const Character& character, const Reference& reference, Humanoid& humanoid) {
  if (!only_motion(character)) return;
  std::vector<Landmarks> figures;
  for (const double t : sample_times(character.animations[0], kMostFrames))
    figures.emplace_back(character, humanoid, sample(character.skeleton, character.animations[0], t));
  if (reference.is_frame) read_feet_where_flat(figures, reference.up, humanoid);
  read_hinges(figures, humanoid);
  centre(measure(figures, reference.up, humanoid), humanoid);
}

}  // namespace ukemi
