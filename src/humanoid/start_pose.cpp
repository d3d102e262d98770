// Standing poses, built as segment rotations on the figure of the reference pose.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/random.h"
#include "humanoid/humanoid.h"
#include "humanoid/landmarks.h"
#include "humanoid/skin.h"
#include "humanoid/soles.h"

namespace ukemi {
namespace {

Quat about(const Vec3& axis, double degrees_) { return exp_rotation(axis * radians(degrees_)); }

/// An arm, degrees, as for the right side; the left is its mirror.
struct ArmAngles {
  double abduction, flexion, internal_rotation, elbow_flexion, pronation;
  double clavicle_elevation, clavicle_protraction;
  double wrist_extension;
};
/// A leg: where the ankle stands from below its hip, in leg lengths, and how far the foot turns out.
struct LegStance {
  double outwards, forwards;
  double toe_out_deg;
};
struct Stance {
  double pelvis_turn_deg;  // to the left
  double pelvis_list_deg;  // the left hip lower
  double pelvis_drop;      // hips above the ankles, in leg lengths (at most 1)
  double trunk_flexion_deg, trunk_turn_deg, neck_flexion_deg, neck_turn_deg;
  ArmAngles arm_l, arm_r;
  LegStance leg_l, leg_r;
};

// Relaxed standing: hip-wide feet, knees not locked.
constexpr Stance kStand = {0.0,
                           0.0,
                           0.9988,
                           0.0,
                           0.0,
                           0.0,
                           0.0,
                           {9.0, 3.0, 4.0, 14.0, 8.0, 0.0, 0.0, 0.0},
                           {9.0, 3.0, 4.0, 14.0, 8.0, 0.0, 0.0, 0.0},
                           {0.015, 0.0, 7.0},
                           {0.015, 0.0, 7.0}};
// A boxer's guard, left foot forward.
constexpr Stance kGuard = {-20.0,
                           0.0,
                           0.93,
                           10.0,
                           -6.0,
                           2.0,
                           25.0,
                           {14.0, 38.0, 10.0, 116.0, 20.0, 4.0, 6.0, 0.0},
                           {14.0, 30.0, 14.0, 120.0, 20.0, 4.0, 4.0, 0.0},
                           {0.08, 0.22, -2.0},
                           {0.10, -0.22, 18.0}};

/// A number about `mean`, within `spread` either way; the mean itself without a seed.
struct Variety {
  explicit Variety(std::uint64_t seed) : seeded(seed != 0), random(seed) {}
  double about(double mean, double spread) {
    return seeded ? mean + spread * 0.5 * (random.uniform(-1.0, 1.0) + random.uniform(-1.0, 1.0)) : mean;
  }
  bool seeded;
  Random random;
};

/// Standing at ease. The feet are behind the hips by the 3 cm (0.035 leg lengths) that people stand ahead of
/// their ankles; a foot is 4 cm ahead, the pelvis 1 cm over one leg and lower over the other, whose knee is
/// more bent, as is one elbow. A seed may exchange left and right.
Stance living_stance(const Vec2& blow_from, std::uint64_t seed) {
  Variety vary(seed);
  Stance s = kStand;
  const bool braced = !blow_from.isZero();
  const double ahead = vary.about(0.023, 0.012);
  const double back = vary.about(0.035, 0.008) + 0.06 * blow_from.x();
  const double aside = vary.about(0.010, 0.006) + 0.03 * blow_from.y();
  const double apart = braced ? 0.06 : 0.018;
  s.pelvis_drop = vary.about(braced ? 0.975 : 0.994, 0.0015);
  s.leg_l = {apart + aside, -back + ahead, vary.about(8.0, 4.0)};
  s.leg_r = {apart - aside, -back - ahead, vary.about(11.0, 4.0)};
  s.pelvis_turn_deg = vary.about(-2.0, 2.5);
  s.pelvis_list_deg = braced ? 0.0 : vary.about(1.2, 0.5);
  s.trunk_turn_deg = vary.about(2.0, 3.0);
  s.neck_turn_deg = vary.about(-3.0, 5.0);
  s.neck_flexion_deg = vary.about(2.0, 3.0);
  s.arm_l = {vary.about(8.0, 2.0),
             vary.about(6.0, 4.0),
             4.0,
             vary.about(21.0, 5.0),
             vary.about(10.0, 6.0),
             0.0,
             0.0,
             0.0};
  s.arm_r = {vary.about(10.0, 2.0),
             vary.about(1.0, 4.0),
             4.0,
             vary.about(12.0, 3.0),
             vary.about(6.0, 6.0),
             0.0,
             0.0,
             0.0};
  if (!vary.seeded || braced || vary.random.uniform(0.0, 1.0) < 0.5) return s;
  std::swap(s.leg_l, s.leg_r);
  std::swap(s.arm_l, s.arm_r);
  for (double* turn : {&s.pelvis_turn_deg, &s.pelvis_list_deg, &s.trunk_turn_deg, &s.neck_turn_deg})
    *turn = -*turn;
  return s;
}

struct Mover {
  const BodyPose& from;
  BodyPose to;

  const Rigid& at(Segment s) const { return to[index(s)]; }
  /// Gives the segment its rotation and hangs it on its parent where it was in `from`.
  void place(Segment s, const Quat& rotation) {
    const int p = index(parent_of(s));
    to[index(s)].rotation = rotation;
    to[index(s)].translation = to[p] * (from[p].inverse() * from[index(s)].translation);
  }
  void place_relative(Segment s, const Quat& parent_from_segment) {
    place(s, at(parent_of(s)).rotation * parent_from_segment);
  }
};

Segment on_side(Segment left, bool is_left) { return is_left ? left : mirror_of(left); }

/// Right-hand formulas; `m` mirrors rotations about x and y for the left.
void place_arm(Mover& figure, const ArmAngles& arm, bool left) {
  const double m = left ? -1.0 : 1.0;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  figure.place_relative(on_side(Segment::clavicle_l, left),
                        about(y, m * arm.clavicle_protraction) * about(x, -m * arm.clavicle_elevation));
  // The clavicle carries the arm; its own rotation is taken out so that the angles are those of the trunk.
  const Quat trunk = figure.at(Segment::chest).rotation;
  figure.place(
      on_side(Segment::upperarm_l, left),
      trunk * about(x, -m * arm.abduction) * about(z, arm.flexion) * about(y, m * arm.internal_rotation));
  figure.place_relative(on_side(Segment::forearm_l, left),
                        about(z, arm.elbow_flexion) * about(y, m * arm.pronation));
  figure.place_relative(on_side(Segment::hand_l, left), about(x, m * arm.wrist_extension));
}

/// Thigh and shank from the ankle's place (two-bone solution, knee over the foot), the foot flat on the
/// floor. `heading`: x forward, y up, z right.
void place_leg(Mover& figure, const LegStance& leg, double ankle_height, const Quat& heading, bool left) {
  const Segment thigh = on_side(Segment::thigh_l, left), shank = on_side(Segment::shank_l, left),
                foot = on_side(Segment::foot_l, left);
  const double outwards = left ? -1.0 : 1.0;
  figure.place(thigh, figure.at(Segment::pelvis).rotation);
  const double upper = (figure.from[index(shank)].translation - figure.from[index(thigh)].translation).norm();
  const double lower = (figure.from[index(foot)].translation - figure.from[index(shank)].translation).norm();
  const double length = upper + lower;
  const Quat facing = heading * about(Vec3::UnitY(), -outwards * leg.toe_out_deg);
  Vec3 reach = heading * Vec3(length * leg.forwards, 0.0, length * outwards * leg.outwards);
  reach.y() = ankle_height - figure.at(thigh).translation.y();
  if (reach.norm() > 0.9995 * length) reach *= 0.9995 * length / reach.norm();
  const double d = reach.norm();
  const Vec3 down = reach / d;
  Vec3 forward = facing * Vec3::UnitX();
  forward = (forward - forward.dot(down) * down).normalized();
  const double bend =
      std::acos(std::clamp((upper * upper + d * d - lower * lower) / (2.0 * upper * d), -1.0, 1.0));
  const Vec3 to_knee = std::cos(bend) * down + std::sin(bend) * forward;
  const Vec3 to_ankle = (reach - upper * to_knee).normalized();
  const Vec3 right = forward.cross(-down);
  const auto hanging = [&](const Vec3& link) {
    Mat3 m;
    m << (-link).cross(right), -link, right;
    return Quat(m).normalized();
  };
  figure.place(thigh, hanging(to_knee));
  figure.place(shank, hanging(to_ankle));
  figure.place(foot, facing);
}

double leg_length(const BodyPose& from, bool left) {
  const auto place = [&](Segment s) { return from[index(on_side(s, left))].translation; };
  return (place(Segment::shank_l) - place(Segment::thigh_l)).norm() +
         (place(Segment::foot_l) - place(Segment::shank_l)).norm();
}

Quat heading_of(const Quat& pelvis) {
  const Vec3 forward = pelvis * Vec3::UnitX();
  return exp_rotation(Vec3(0.0, std::atan2(-forward.z(), forward.x()), 0.0));
}

BodyPose body_in(const Stance& stance, const BodyPose& from) {
  Mover figure{from, from};
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Quat heading = heading_of(from[index(Segment::pelvis)].rotation);
  figure.to[index(Segment::pelvis)].rotation =
      heading * about(y, stance.pelvis_turn_deg) * about(x, -stance.pelvis_list_deg);
  // Flexion bends the trunk forwards: about -z.
  figure.place_relative(Segment::abdomen, about(x, 0.7 * stance.pelvis_list_deg) *
                                              about(z, -0.54 * stance.trunk_flexion_deg) *
                                              about(y, 0.3 * stance.trunk_turn_deg));
  figure.place_relative(Segment::chest,
                        about(z, -0.46 * stance.trunk_flexion_deg) * about(y, 0.7 * stance.trunk_turn_deg));
  figure.place_relative(Segment::head, about(z, -stance.neck_flexion_deg) * about(y, stance.neck_turn_deg));
  place_arm(figure, stance.arm_l, true);
  place_arm(figure, stance.arm_r, false);
  const double drop_m = stance.pelvis_drop * std::min(leg_length(from, true), leg_length(from, false));
  const double ankle_height = figure.at(Segment::pelvis).translation.y() - drop_m;
  place_leg(figure, stance.leg_l, ankle_height, heading, true);
  place_leg(figure, stance.leg_r, ankle_height, heading, false);
  return figure.to;
}

/// How much shorter than a man's the heels are behind the ankles, metres. People stand with their weight over
/// the middle of the foot: short heels go back by as much.
double short_heels(const Character& character, const Humanoid& humanoid, const BodyPose& from) {
  constexpr double kHeel = 0.036;  // of the height, behind the ankle
  const Vec3 forward = heading_of(from[index(Segment::pelvis)].rotation) * Vec3::UnitX();
  double missing = 0.0;
  for (const Segment foot : {Segment::foot_l, Segment::foot_r}) {
    const SkinExtent extent = extent_of_feet(character, humanoid, humanoid.reference, {foot}, forward);
    if (!extent.found) return 0.0;
    const double heel = from[index(foot)].translation.dot(forward) -
                        humanoid.world_from_file.scale * extent.min -
                        humanoid.world_from_file.translation.dot(forward);
    if (std::abs(heel) > kFarSole * humanoid.height_m) return 0.0;
    missing += 0.5 * std::clamp(kHeel * humanoid.height_m - heel, 0.0, kHeel * humanoid.height_m);
  }
  return missing;
}

/// Lowest point of the feet in the world, metres: of the skin around the foot bones, else a guess from the
/// bones.
double lowest_sole(const Character& character, const Humanoid& humanoid, const Pose& pose) {
  const std::vector<Affine> world = world_transforms(character.skeleton, pose);
  const SkinExtent extent =
      extent_of_feet(character, humanoid, pose, {Segment::foot_l, Segment::foot_r}, Vec3::UnitY());
  const BodyPose body = segments_of(character.skeleton, humanoid, pose);
  const double ankle =
      std::min(body[index(Segment::foot_l)].translation.y(), body[index(Segment::foot_r)].translation.y());
  const double sole = humanoid.world_from_file.scale * extent.min;
  const bool near_feet = std::abs(sole - ankle) < kFarSole * humanoid.height_m;  // else a wrong bind pose
  if (extent.found && near_feet) return sole;
  double lowest = 1e300;
  for (int side = 0; side < 2; ++side) {
    const Segment foot = side == 0 ? Segment::foot_l : Segment::foot_r;
    lowest = std::min(lowest, body[index(foot)].translation.y() - kAnkleUp * humanoid.height_m);
    if (humanoid.toes[side] >= 0)
      lowest = std::min(lowest, (humanoid.world_from_file * world[humanoid.toes[side]].translation()).y() -
                                    kToeJointUp * humanoid.height_m);
  }
  return lowest;
}

}  // namespace

Pose stand_on_floor(const Character& character, const Humanoid& humanoid, const Pose& pose) {
  const BodyPose from = segments_of(character.skeleton, humanoid, pose);
  BodyPose to = from;
  const double lift = -lowest_sole(character, humanoid, pose);
  for (Rigid& segment : to) segment.translation.y() += lift;
  return pose_skeleton(character.skeleton, humanoid, pose, from, to);
}

namespace {

/// The rest pose, unless it is not a pose or does not stand upright: then the reference pose.
Pose rest_on_feet(const Character& character, const Humanoid& humanoid) {
  const Pose rest = rest_pose(character.skeleton);
  const Landmarks figure(character, humanoid, rest);
  const Vec3 up = humanoid.world_from_file.rotation.conjugate() * Vec3::UnitY();
  return usable(figure) && angle(figure.rise(), up) < radians(25) ? rest : humanoid.reference;
}

}  // namespace

namespace {

/// Skin of a standing body that its arms shall not reach into.
class SkinSurface {
 public:
  SkinSurface(const Character& character, const Humanoid& humanoid, const BodyPose& from,
              const BodyPose& body, bool (*counts)(Segment))
      : band_m_(kBand * humanoid.height_m) {
    const Pose pose = pose_skeleton(character.skeleton, humanoid, humanoid.reference, from, body);
    const auto segments = segments_of_nodes(character.skeleton, humanoid);
    const Similarity& world = humanoid.world_from_file;
    const double spacing = kSpacing * humanoid.height_m / world.scale;
    for (const Vec3& point :
         surface_points(character, world_transforms(character.skeleton, pose), spacing,
                        [&](int node) { return segments[node] && counts(*segments[node]); }))
      points_.push_back(world * point);
  }

  /// How far the least of the places lies outside the skin beside it, in a direction (unit), metres. Large
  /// where there is no skin.
  double clearance(std::initializer_list<Vec3> places, const Vec3& outwards) const {
    double least = 1e300;
    for (const Vec3& at : places) {
      const double reach = farthest(at, outwards);
      if (reach > -1e299) least = std::min(least, at.dot(outwards) - reach);
    }
    return least;
  }

 private:
  static constexpr double kSpacing = 0.02;  // of the height
  static constexpr double kBand = 0.03;     // of the height, to all sides of the direction

  double farthest(const Vec3& at, const Vec3& outwards) const {
    double reach = -1e300;
    for (const Vec3& point : points_) {
      const Vec3 apart = point - at;
      const double beside = (apart - apart.dot(outwards) * outwards).cwiseAbs().maxCoeff();
      if (beside < band_m_) reach = std::max(reach, point.dot(outwards));
    }
    return reach;
  }

  double band_m_;
  std::vector<Vec3> points_;
};

bool is_trunk(Segment s) { return s == Segment::pelvis || s == Segment::abdomen || s == Segment::chest; }

/// The stance with its arms changed in at most `steps` equal steps until their clearance (metres) is ample;
/// as it is where it is clear. Nothing where no step helps.
template <typename Clearance, typename Change>
std::optional<BodyPose> held_away(Stance stance, const BodyPose& from, double height_m, int steps,
                                  const Clearance& clearance, const Change& change) {
  constexpr double kAmple = 0.015;  // of the height
  BodyPose body = body_in(stance, from);
  if (clearance(body) > 0.0) return body;
  for (int step = 0; step < steps; ++step) {
    change(stance.arm_l);
    change(stance.arm_r);
    body = body_in(stance, from);
    if (clearance(body) > kAmple * height_m) return body;
  }
  return std::nullopt;
}

/// Standing with hanging arms; they are held away from a trunk that they would hang into, if that helps.
BodyPose stand(const Character& character, const Humanoid& humanoid, const BodyPose& from,
               const Stance& stance) {
  const SkinSurface trunk(character, humanoid, from, body_in(stance, from), [](Segment s) {
    return is_trunk(s) || s == Segment::thigh_l || s == Segment::thigh_r;
  });
  const auto clearance = [&](const BodyPose& body) {
    double least = 1e300;
    for (const bool left : {true, false}) {
      const auto place = [&](Segment s) { return body[index(on_side(s, left))].translation; };
      const Vec3 elbow = place(Segment::forearm_l), wrist = place(Segment::hand_l);
      const Vec3 outwards = body[index(Segment::pelvis)].rotation * Vec3(0, 0, left ? -1 : 1);
      least = std::min(least, trunk.clearance({elbow, Vec3(0.5 * (elbow + wrist)), wrist}, outwards));
    }
    return least;
  };
  const auto apart = [](ArmAngles& arm) { arm.abduction += 4.0; };
  return held_away(stance, from, humanoid.height_m, 11, clearance, apart).value_or(body_in(stance, from));
}

/// A guard; fists that would be in a large head are held before it or, where arms are too short for that,
/// below it.
BodyPose guard(const Character& character, const Humanoid& humanoid, const BodyPose& from) {
  constexpr double kFist = 0.05;  // from wrist to fist, of the height
  const SkinSurface front(character, humanoid, from, body_in(kGuard, from),
                          [](Segment s) { return is_trunk(s) || s == Segment::head; });
  const auto clearance = [&](const BodyPose& body) {
    const Vec3 ahead = heading_of(from[index(Segment::pelvis)].rotation) * Vec3::UnitX();
    double least = 1e300;
    for (const Segment s : {Segment::hand_l, Segment::hand_r}) {
      const Rigid& hand = body[index(s)];
      least = std::min(
          least, front.clearance({hand.translation, hand * Vec3(0, -kFist * humanoid.height_m, 0)}, ahead));
    }
    return least;
  };
  const auto forwards = [](ArmAngles& arm) { arm.elbow_flexion -= 5.0, arm.flexion += 3.0; };
  if (const auto body = held_away(kGuard, from, humanoid.height_m, 14, clearance, forwards)) return *body;
  const auto lower = [](ArmAngles& arm) { arm.elbow_flexion -= 4.0, arm.flexion -= 4.0; };
  return held_away(kGuard, from, humanoid.height_m, 12, clearance, lower).value_or(body_in(kGuard, from));
}

}  // namespace

Pose start_pose(const Character& character, const Humanoid& humanoid, StartPose kind,
                const StanceOptions& stance) {
  if (kind == StartPose::rest) return stand_on_floor(character, humanoid, rest_on_feet(character, humanoid));
  const BodyPose from = segments_of(character.skeleton, humanoid, humanoid.reference);
  Stance standing = kStand;
  if (stance.living) {
    standing = living_stance(stance.braced_against, stance.seed);
    const double back = short_heels(character, humanoid, from) / leg_length(from, true);
    standing.leg_l.forwards -= back;
    standing.leg_r.forwards -= back;
  }
  const BodyPose to = kind == StartPose::guard ? guard(character, humanoid, from)
                                               : stand(character, humanoid, from, standing);
  return stand_on_floor(character, humanoid,
                        pose_skeleton(character.skeleton, humanoid, humanoid.reference, from, to));
}

}  // namespace ukemi
