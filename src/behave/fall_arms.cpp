#include "behave/fall_arms.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kLeastAhead =
    0.3;  // of an arm's reach: how far ahead a hand goes that is far from the ground
constexpr double kShortest = 0.35;  // of the arm's length: wrist from the shoulder
constexpr double kMostPronation = radians(82.0);
constexpr double kBentArm = 0.8;  // of the arm's length: how high the shoulder is when the hand touches
constexpr double kFreeFall = 0.7 * 9.81;  // m/s^2: a body that falls over falls slower than a stone
constexpr double kLookAhead_s = 0.5;
constexpr double kWristHeight_m = 0.05;
constexpr double kHandsStayUpFrom_m = 0.55, kHandsStayUp = 0.45;  // by shoulder height
constexpr double kFarHand_m = 0.25;  // sideways: how far in front of the near shoulder the far hand lands

Vec3 flat(const Vec3& v) { return {v.x(), 0.0, v.z()}; }

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  return v.norm() > 1e-6 ? Vec3(v.normalized()) : otherwise;
}

/// The chest's axes on the ground; of a lying chest whatever is left of them.
struct ChestAxes {
  Vec3 front, right;
};

ChestAxes chest_axes(const Senses& senses) {
  const Quat& chest = senses.pose[index(Segment::chest)].rotation;
  Vec3 right = flat(chest * Vec3::UnitZ());
  if (right.norm() < 0.3) right = flat(chest * Vec3::UnitY()).cross(Vec3::UnitY());
  right = unit_or(right, Vec3::UnitZ());
  return {Vec3::UnitY().cross(right), right};
}

Vec3 shoulder_of(const Senses& senses, BodySide side) {
  return senses.pose[index(on(side, Segment::upperarm_r))].translation;
}

/// Velocity of the shoulder joint.
Vec3 shoulder_velocity(const Senses& senses, BodySide side) {
  const int s = index(on(side, Segment::upperarm_r));
  return senses.velocity[s] + senses.angular_velocity[s].cross(senses.pose[s].translation - senses.centre[s]);
}

Vec3 elbow_way(const Senses& senses, const FallWay& way, BodySide side) {
  const bool near = sign(side) == way.side;
  const double out = sign(side);
  const Vec3 local = way.forward * Vec3(0.0, -0.5, 0.8 * out) + way.backward * Vec3(-1.0, 0.5, 0.3 * out) +
                     way.sideways * (near ? Vec3(-1.0, 0.3, 0.0) : Vec3(0.0, -0.8, 0.4 * out));
  return senses.pose[index(Segment::chest)].rotation * local;
}

}  // namespace

double time_to_brace(const FallBody& body, const Senses& senses, BodySide side) {
  const double drop =
      std::max(0.0, shoulder_of(senses, side).y() - kBentArm * body.arms[index(side)].reach_m());
  const double sink = std::max(0.0, -shoulder_velocity(senses, side).y());
  const double time_s = (std::sqrt(sink * sink + 2.0 * kFreeFall * drop) - sink) / kFreeFall;
  return std::min(time_s, kLookAhead_s * body.tau);
}

HandTarget landing_place(const FallBody& body, const Senses& senses, const FallWay& way,
                         const FallVariation& variation, BodySide side) {
  const double lambda = body.lambda;
  const ChestAxes heading = chest_axes(senses);
  const Vec3 shoulder = shoulder_of(senses, side);
  const Vec3 drift = time_to_brace(body, senses, side) * flat(shoulder_velocity(senses, side));
  const Vec2& own = variation.hand_m[index(side)];
  const double ahead = 0.22 * (way.forward + way.sideways) + 0.12 * way.backward + own.x();
  const double aside = 0.06 * way.forward + 0.16 * way.backward + 0.02 * way.sideways + own.y();
  HandTarget target;
  target.stretch = variation.stretch[index(side)];
  target.wrist = flat(shoulder) + drift + lambda * (ahead * way.along + aside * sign(side) * heading.right);
  if (sign(side) != way.side) {
    const BodySide near = other(side);
    const Vec3 before = flat(shoulder_of(senses, near)) +
                        time_to_brace(body, senses, near) * flat(shoulder_velocity(senses, near)) +
                        lambda * kFarHand_m * heading.front;
    target.wrist += way.sideways * (before - target.wrist);
  }
  target.wrist.y() =
      kWristHeight_m * lambda + kHandsStayUp * std::max(0.0, shoulder.y() - kHandsStayUpFrom_m * lambda);
  target.elbow_way = elbow_way(senses, way, side);
  target.fingers = way.forward * way.along +
                   way.backward * (0.9 * sign(side) * heading.right - 0.3 * way.along) +
                   way.sideways * (0.7 * way.along + 0.7 * heading.front);
  return target;
}

namespace {

/// World rotations of upper arm and forearm.
struct Links {
  Quat upper, fore;
};

Quat from_axes(const Vec3& y, const Vec3& z) {
  Mat3 axes;
  axes << y.cross(z), y, z;
  return Quat(axes).normalized();
}

/// A place that is out of reach is drawn in over the ground, so that the hand still comes down to it.
Vec3 within_reach(const Vec3& shoulder, const Vec3& wrist, double reach_m) {
  const Vec3 to = wrist - shoulder;
  const double away = flat(to).norm();
  const double most =
      std::max(std::sqrt(std::max(0.0, reach_m * reach_m - to.y() * to.y())), kLeastAhead * reach_m);
  if (away <= most) return wrist;
  return wrist - (1.0 - most / away) * flat(to);
}

Links two_bone(const Vec3& shoulder, const HandTarget& target, const ArmSize& size) {
  const Vec3 to = within_reach(shoulder, target.wrist, target.stretch * size.reach_m()) - shoulder;
  const Vec3 line = unit_or(to, -Vec3::UnitY());
  const double reach = std::clamp(to.norm(), kShortest * size.reach_m(), target.stretch * size.reach_m());
  const double least = std::abs(size.upper_m - size.fore_m) + 1e-3;
  const double distance = std::max(reach, least);
  Vec3 aside = target.elbow_way - line.dot(target.elbow_way) * line;
  aside = unit_or(aside, line.unitOrthogonal());
  const double along =
      (distance * distance + size.upper_m * size.upper_m - size.fore_m * size.fore_m) / (2.0 * distance);
  const double out = std::sqrt(std::max(0.0, size.upper_m * size.upper_m - along * along));
  const Vec3 elbow = along * line + out * aside;
  // Both links hang along their -y; the hinge is z, and bending takes the forearm to the front (x).
  const Vec3 hinge = aside.cross(line).normalized();
  return {from_axes(-elbow.normalized(), hinge), from_axes((elbow - distance * line).normalized(), hinge)};
}

}  // namespace

ArmPose arm_reaching(const FallBody& body, const Senses& senses, const HandTarget& target, BodySide side) {
  const Links links = two_bone(shoulder_of(senses, side), target, body.arms[index(side)]);
  const Quat& clavicle = senses.pose[index(on(side, Segment::clavicle_r))].rotation;
  ArmPose pose;
  pose.shoulder = clavicle.conjugate() * links.upper;
  const Quat hinge = links.upper.conjugate() * links.fore;
  // Palm down: the right palm looks along -z of the hand, the left one along z; the fingers along -y.
  const Vec3 out = sign(side) * Vec3::UnitY();
  const Vec3 fingers = unit_or(flat(target.fingers), chest_axes(senses).front);
  const Quat hand = from_axes(-fingers, out);
  const double turn = twist_angle(links.fore.conjugate() * hand, Vec3::UnitY());
  const double pronation = std::clamp(turn, -kMostPronation, kMostPronation);
  pose.elbow = hinge * exp_rotation(Vec3(0.0, pronation, 0.0));
  pose.wrist = senses.pose[index(on(side, Segment::forearm_r))].rotation.conjugate() * hand;
  return pose;
}

}  // namespace ukemi
