#include "behave/lying.h"

#include <cmath>

#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kUpright = 0.5;  // of the chest's y axis against the vertical: seated or kneeling
constexpr double kOnSide = 0.75;  // of the chest's z axis: on a side
constexpr double kBreath_hz = 0.25;
constexpr double kBreathTurn = radians(1.6);  // of the chest, from empty to full

/// Degrees. Flexion is positive, so is turning the knee or the forearm inwards.
struct LegAngles {
  double hip, out, turn, knee, ankle;
};
struct ArmAngles {
  double raise, out, turn, elbow, pronation, wrist;
};

Quat about_z(double angle) { return exp_rotation(Vec3(0.0, 0.0, radians(angle))); }
Quat outwards(BodySide side, double angle) {
  return exp_rotation(Vec3(-sign(side) * radians(angle), 0.0, 0.0));
}
Quat inwards(BodySide side, double angle) {
  return exp_rotation(Vec3(0.0, sign(side) * radians(angle), 0.0));
}

void set_leg(BodySide side, const LegAngles& a, PerJoint<Quat>& goals) {
  goals[index(on(side, Joint::hip_r))] = about_z(a.hip) * outwards(side, a.out) * inwards(side, a.turn);
  goals[index(on(side, Joint::knee_r))] = about_z(-a.knee);
  goals[index(on(side, Joint::ankle_r))] = about_z(a.ankle);
}

void set_arm(BodySide side, const ArmAngles& a, PerJoint<Quat>& goals) {
  goals[index(on(side, Joint::clavicle_r))] = Quat::Identity();
  goals[index(on(side, Joint::shoulder_r))] =
      about_z(a.raise) * outwards(side, a.out) * inwards(side, a.turn);
  goals[index(on(side, Joint::elbow_r))] = about_z(a.elbow) * inwards(side, a.pronation);
  goals[index(on(side, Joint::wrist_r))] = about_z(a.wrist);
}

/// Flexion, bend to the right, turn to the left of trunk and neck.
void set_trunk(const Vec3& trunk, const Vec3& neck, PerJoint<Quat>& goals) {
  const auto turned = [](const Vec3& a, double share) {
    return exp_rotation(share * Vec3(radians(a.y()), radians(a.z()), -radians(a.x())));
  };
  goals[index(Joint::spine)] = turned(trunk, 0.5);
  goals[index(Joint::chest)] = turned(trunk, 0.5);
  goals[index(Joint::neck)] = turned(neck, 1.0);
}

void lie_supine(BodySide lead, double turn, PerJoint<Quat>& goals) {
  set_trunk({6.0, 0.0, 0.0}, {8.0, 0.0, turn * 20.0}, goals);
  set_leg(lead, {46.0, 6.0, 0.0, 78.0, 0.0}, goals);
  set_leg(other(lead), {8.0, 9.0, -12.0, 12.0, -15.0}, goals);
  set_arm(lead, {12.0, 24.0, 70.0, 88.0, 45.0, 0.0}, goals);
  set_arm(other(lead), {0.0, 38.0, 10.0, 30.0, 40.0, 0.0}, goals);
}

void lie_prone(BodySide lead, double turn, PerJoint<Quat>& goals) {
  set_trunk({-4.0, 0.0, 0.0}, {-12.0, 0.0, turn * 62.0}, goals);
  set_leg(lead, {6.0, 26.0, -38.0, 34.0, -40.0}, goals);
  set_leg(other(lead), {-5.0, 8.0, 0.0, 6.0, -45.0}, goals);
  set_arm(lead, {60.0, 55.0, 20.0, 95.0, 70.0, 0.0}, goals);
  set_arm(other(lead), {15.0, 42.0, 20.0, 60.0, 70.0, 0.0}, goals);
}

/// `down`: the side that is lain on.
void lie_on_side(BodySide down, PerJoint<Quat>& goals) {
  set_trunk({16.0, 0.0, 0.0}, {10.0, sign(down) * 18.0, 0.0}, goals);
  set_leg(down, {28.0, 0.0, 0.0, 45.0, -15.0}, goals);
  set_leg(other(down), {58.0, -4.0, 8.0, 85.0, -10.0}, goals);
  set_arm(down, {75.0, 5.0, 0.0, 75.0, 20.0, 0.0}, goals);
  set_arm(other(down), {42.0, 0.0, 20.0, 75.0, 60.0, -15.0}, goals);
}

/// The arms stay as they prop.
void sit(BodySide lead, double turn, PerJoint<Quat>& goals) {
  set_trunk({16.0, 0.0, 0.0}, {14.0, 0.0, turn * 14.0}, goals);
  set_leg(lead, {70.0, 6.0, 0.0, 84.0, 0.0}, goals);
  set_leg(other(lead), {56.0, 10.0, -8.0, 32.0, -10.0}, goals);
}

}  // namespace

std::string_view name(EndPose pose) {
  switch (pose) {
    case EndPose::standing:
      return "standing";
    case EndPose::kneeling:
      return "kneeling";
    case EndPose::seated:
      return "seated";
    case EndPose::supine:
      return "supine";
    case EndPose::prone:
      return "prone";
    case EndPose::left_side:
      return "left_side";
    case EndPose::right_side:
      break;
  }
  return "right_side";
}

EndPose end_pose_of(const Senses& senses) {
  const Mat3 chest = senses.pose[index(Segment::chest)].rotation.toRotationMatrix();
  const bool seat = on_floor(senses, Segment::pelvis) || on_floor(senses, Segment::thigh_l) ||
                    on_floor(senses, Segment::thigh_r);
  const bool shanks = on_floor(senses, Segment::shank_l) || on_floor(senses, Segment::shank_r);
  const double front_up = chest(1, 0);
  const double right_up = chest(1, 2);
  if (!on_floor(senses, Segment::chest)) {
    if (!seat && !shanks) return EndPose::standing;
    const bool on_knees = shanks && !on_floor(senses, Segment::pelvis);
    if (on_knees && front_up < 0.6) return EndPose::kneeling;
    if (chest(1, 1) > kUpright && on_floor(senses, Segment::pelvis)) return EndPose::seated;
  }
  if (std::abs(right_up) > kOnSide) return right_up > 0.0 ? EndPose::left_side : EndPose::right_side;
  return front_up >= 0.0 ? EndPose::supine : EndPose::prone;
}

void sprawl(PerJoint<Quat>& goals) {
  for (const BodySide side : kSides) set_leg(side, {-5.0, 8.0, 0.0, 8.0, -45.0}, goals);
}

void lie(EndPose pose, const FallVariation& variation, PerJoint<Quat>& goals) {
  const BodySide lead = variation.lying_side < 0.0 ? BodySide::left : BodySide::right;
  switch (pose) {
    case EndPose::supine:
      return lie_supine(lead, -sign(lead), goals);
    case EndPose::prone:
      return lie_prone(lead, -sign(lead), goals);
    case EndPose::left_side:
      return lie_on_side(BodySide::left, goals);
    case EndPose::right_side:
      return lie_on_side(BodySide::right, goals);
    case EndPose::seated:
      return sit(lead, sign(lead), goals);
    case EndPose::kneeling:
    case EndPose::standing:
      return;
  }
}

BreathTurn breath(Joint joint, double time_s) {
  const double share = joint == Joint::chest   ? 1.0
                       : joint == Joint::spine ? -0.35
                       : joint == Joint::neck  ? -0.65
                                               : 0.0;
  const double rate = 2.0 * kPi * kBreath_hz;
  const double half = 0.5 * share * kBreathTurn;
  return {half * (1.0 - std::cos(rate * time_s)), half * rate * std::sin(rate * time_s)};
}

}  // namespace ukemi
