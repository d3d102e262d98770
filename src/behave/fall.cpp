#include "behave/fall.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kFade_s = 0.10;
constexpr double kMargin = radians(3.0);  // goals stay this far inside the range
constexpr double kArmReady_m = 0.2;  // arms reach fully when the centre of mass is this far outside the soles
constexpr double kArmAtOnce = 0.45;
constexpr double kReadyBefore_s = 0.45,
                 kReadyIn_s = 0.2;        // and at the latest, before the hands are to touch
constexpr double kLeastShare = 0.12;      // of full effort that a joint's damper may use
constexpr double kLooseDamping_s = 0.03;  // damper of a joint that lets go, times the full torque
constexpr double kCalm_m_s = 0.14, kCalmTurning = 0.7, kCalmFor_s = 0.15;
constexpr double kSlow_m_s = 0.5, kSlowFor_s = 0.3;
constexpr double kLongestArch_s = 2.0;  // after landing a body may hang between knees and chest
constexpr double kRest_m_s = 0.03, kRestTurning = 0.15, kRestFor_s = 0.25;
constexpr double kBreathesOn_s = 1.0;   // after rest
constexpr double kFullTorqueAt = 0.35;  // rad
constexpr double kLookAhead_s = 0.25;   // a seated trunk that will have sunk then goes on to lie
constexpr double kStaysSeated = 0.42;   // of its y axis
constexpr double kChoosesFor_s = 1.2;   // after landing
constexpr double kRolledOver_s = 0.25;  // on the back, later than that
constexpr double kTouching = 1.0, kHardTouching = 0.8;  // share of an arm's effort; more where the shoulder
constexpr double kHardSink_m_s = 2.0;                   // sinks faster than this
constexpr double kStill_s = 0.5;                        // until a settled body's joints hold still
constexpr double kStillDamping = 20.0;                  // times that of lying
constexpr double kOnFront = 0.5;   // side_down.x(): above, the body comes to lie on its belly
constexpr double kYielding = 0.1;  // share of its effort that an arm keeps where nothing sinks on to it
constexpr double kHipsThrough = 1.2,
                 kLooseKnees = 0.05;     // efforts while a kneeling body goes on to the belly
constexpr double kArmsLieDown_s = 0.45;  // on the belly: nobody lies still at once
constexpr double kArmAtRest = 0.1;       // effort on the back: too weak to hold a hand up in the air
constexpr double kFlatAfter_s = 0.03, kFlatAtLast_s = 0.4;  // trunk down, or landed: then the legs lie down
constexpr double kLegsAside = 1.0;  // added effort of legs that brake a fall to the side
constexpr double kMoving = 1.2;     // added effort midway to where a part will lie

bool is_hip(Joint j) { return j == Joint::hip_l || j == Joint::hip_r; }
bool is_arm(Joint j) { return j >= Joint::clavicle_l && j <= Joint::wrist_r; }

}  // namespace

FallSettings FallSettings::dazed() {
  FallSettings settings;
  settings.rise_s = 0.45;
  settings.strength = 0.35;
  settings.propping = 0.2;
  return settings;
}

Falling::Falling(const FallSettings& settings, const ArticulatedBody& body, const RangeOfMotion& range,
                 const MuscleStrength& strength)
    : settings_(settings), body_(body, range, strength), variation_(fall_variation(settings.seed)) {
  fade_from_s_.fill(std::numeric_limits<double>::infinity());
  velocity_.fill(Vec3::Zero());
}

Falling::Part Falling::part_of(Joint joint) {
  if (joint == Joint::neck) return Part::neck;
  if (joint < Joint::neck) return Part::trunk;
  if (!is_arm(joint)) return Part::legs;
  return is_left(joint) ? Part::arm_l : Part::arm_r;
}

bool Falling::protects(BodySide side) const { return settings_.arms_free[index(side)]; }

double Falling::Turn::way(double time_s) const { return min_jerk((time_s - begins_s) / takes_s); }

void Falling::start(const Senses& senses) {
  before_ = senses;
  direction_.update(body_, senses, 0.0);
}

void Falling::watch(const Senses& senses, double h) {
  direction_.update(body_, senses, h);
  before_ = senses;
}

void Falling::begin(const Senses& senses, const PerJoint<double>& fade_from_s) {
  report_.begins_s = senses.time_s;
  fade_from_s_ = fade_from_s;
  for (int j = 0; j < kJointCount; ++j) held_[j] = joint_rotation_of(senses.pose, joint_at(j));
  before_ = senses;
  capture(senses);
  ask(senses);
}

void Falling::fade_in(Joint joint, double from_s) { fade_from_s_[index(joint)] = from_s; }

double Falling::faded(Joint joint, double time_s) const {
  return begun() ? min_jerk((time_s - fade_from_s_[index(joint)]) / kFade_s) : 0.0;
}

/// A joint's spring starts from where the joint is when its fade begins.
void Falling::capture(const Senses& senses) {
  for (int j = 0; j < kJointCount; ++j) {
    if (captured_[j] || senses.time_s < fade_from_s_[j]) continue;
    captured_[j] = joint_rotation_of(senses.pose, joint_at(j));
    const BodySide side = is_left(joint_at(j)) ? BodySide::left : BodySide::right;
    const double late = is_arm(joint_at(j)) ? std::max(0.0, sign(side) * variation_.arm_delay_s) : 0.0;
    turns_[j] = {*captured_[j], 0.0, fade_from_s_[j] + late, settings_.rise_s * body_.tau};
  }
}

void Falling::observe(const Senses& senses, double h) {
  direction_.update(body_, senses, h);
  if (begun()) {
    feel(senses);
    capture(senses);
    landing_.observe(body_, senses, way(), h);
    if (landing_.landed_s() && !report_.landed_s) report_.landed_s = landing_.landed_s();
    choose_pose(senses, h);
    settle_parts(senses);
    watch_calm(senses, h);
    ask(senses);
  }
  before_ = senses;
}

namespace {

/// Speed with which the point approaches the floor, from the state before the step.
double approach(const Senses& before, const SegmentContact& contact) {
  const int s = index(contact.segment);
  const Vec3 speed = before.velocity[s] + before.angular_velocity[s].cross(contact.place - before.centre[s]);
  return std::max(0.0, -speed.dot(contact.normal));
}

bool is_knee(const FallBody& body, const Senses& senses, const SegmentContact& contact) {
  for (const BodySide side : kSides) {
    const Segment shank = on(side, Segment::shank_r);
    if (contact.segment != shank && contact.segment != on(side, Segment::thigh_r)) continue;
    const double off = (contact.place - senses.pose[index(shank)].translation).norm();
    return off < 0.35 * body.shank_m[index(side)];
  }
  return false;
}

bool is_any(Segment s, Segment right) { return s == right || s == mirror_of(right); }

}  // namespace

void Falling::feel(const Senses& senses) {
  for (const SegmentContact& contact : senses.contacts) {
    if (contact.with != SegmentContact::With::floor) continue;
    const TouchDown touch{contact.segment, senses.time_s, approach(before_, contact)};
    const auto note = [&touch](bool applies, std::optional<TouchDown>& where) {
      if (applies && !where) where = touch;
    };
    const Segment s = contact.segment;
    note(!is_any(s, Segment::foot_r), report_.first);
    note(is_any(s, Segment::hand_r) || is_any(s, Segment::forearm_r), report_.hand);
    note(is_knee(body_, senses, contact), report_.knee);
    note(s == Segment::pelvis, report_.pelvis);
    note(s == Segment::head, report_.head);
  }
}

namespace {

/// The pose that the body is coming to: a person does not stay on hands and knees for long, and a seated body
/// that goes on falling will lie.
EndPose coming_pose(const Senses& senses, EndPose now, double tau) {
  if (now == EndPose::kneeling) return EndPose::prone;
  if (now != EndPose::seated) return now;
  const int chest = index(Segment::chest);
  const Vec3 up = senses.pose[chest].rotation * Vec3::UnitY();
  const double soon = up.y() + kLookAhead_s * tau * senses.angular_velocity[chest].cross(up).y();
  if (soon > kStaysSeated) return EndPose::seated;
  return (senses.pose[chest].rotation * Vec3::UnitX()).y() >= 0.0 ? EndPose::supine : EndPose::prone;
}

}  // namespace

/// Sets the pose that the body comes to, once that has lasted; a lying body does not sit up again.
void Falling::choose_pose(const Senses& senses, double h) {
  // Knees first, or the front: on to the belly.
  const bool forward = landing_.kneels_s() || (landing_.landed_s() && way().side_down.x() > kOnFront);
  if (pose_ == EndPose::standing && forward) pose_ = EndPose::prone;
  if (!landing_.landed_s()) return;
  const EndPose present = end_pose_of(senses);
  report_.end_pose = name(present);
  EndPose now = coming_pose(senses, present, body_.tau);
  if (now == EndPose::seated && pose_ != EndPose::standing) now = pose_;
  seen_s_ = now == seen_ ? seen_s_ + h : 0.0;
  seen_ = now;
  const bool late = senses.time_s > *landing_.landed_s() + kChoosesFor_s * body_.tau;
  // Late, only who has rolled on to the back lies otherwise: arms that lay beside him would stand up.
  if (now == pose_ || now == EndPose::standing || (late && now != EndPose::supine)) return;
  if (seen_s_ < (late ? kRolledOver_s : 0.1) * body_.tau) return;
  pose_ = now;
  for (std::size_t p = 0; p < settling_.size(); ++p)
    if (settling_[p]) settle(static_cast<Part>(p), senses.time_s, 0.7 * body_.tau);
}

/// From now on the part's goals go over into those of lying.
void Falling::settle(Part part, double time_s, double takes_s) {
  settling_[static_cast<std::size_t>(part)] = true;
  for (int j = 0; j < kJointCount; ++j)
    if (part_of(joint_at(j)) == part) turns_[j] = {held_[j], share_[j], time_s, takes_s};
}

/// A body that has gone over its knees lies.
bool Falling::is_flat(double time_s) const {
  const auto& down_s = landing_.trunk_down_s();
  return (down_s && time_s - *down_s > kFlatAfter_s * body_.tau) ||
         time_s - *landing_.landed_s() > kFlatAtLast_s * body_.tau;
}

/// Legs give as soon as the body is down, an arm when it has braked, the trunk when it lies or is slow.
void Falling::settle_parts(const Senses& senses) {
  const double time_s = senses.time_s;
  const auto begin = [&](Part part, double takes_s) {
    if (!is_settling(part)) settle(part, time_s, takes_s * body_.tau);
  };
  if (landing_.kneels_s()) begin(Part::legs, 0.2);
  if (!landing_.landed_s() || pose_ == EndPose::standing) return;
  const double since_s = (time_s - *landing_.landed_s()) / body_.tau;
  const bool prone = pose_ == EndPose::prone;
  begin(Part::legs, prone ? 0.4 : 0.8);
  if (prone && !flat_ && is_flat(time_s)) {
    flat_ = true;
    settle(Part::legs, time_s, 0.7 * body_.tau);
  }
  const bool lies = landing_.chest_down_s() && time_s - *landing_.chest_down_s() > 0.05 * body_.tau;
  const double speed = senses.velocity[index(Segment::chest)].norm() / body_.tau;
  if (prone || lies || (since_s > 0.25 && speed < 0.5) || since_s > 0.8)
    begin(Part::trunk, prone ? 0.5 : 0.7);
  // The face is kept up until the chest has come down.
  const bool face_down = prone ? (lies || since_s > 0.2) && speed < 0.3 : is_settling(Part::trunk);
  if (face_down) begin(Part::neck, prone ? 0.8 : 0.7);
  if (pose_ == EndPose::seated) return;  // the arms prop
  for (const BodySide side : kSides) {
    const ArmLanding& arm = landing_.arm(side);
    const bool braked = !prone && arm.braked_s && time_s - *arm.braked_s > 0.12 * body_.tau;
    if (braked || (lies && since_s > 0.1) || since_s > (prone ? 0.3 : 0.7))
      begin(side == BodySide::left ? Part::arm_l : Part::arm_r, prone ? kArmsLieDown_s : 0.7);
  }
}

/// Settled: calm, or slow for a while with nothing left to do: then the joints hold still. At rest: nothing
/// moves.
void Falling::watch_calm(const Senses& senses, double h) {
  const double speed = senses.fastest_m_s / body_.tau;
  const double turning = senses.fastest_turning_rad_s * body_.tau;
  const bool finished = std::all_of(turns_.begin(), turns_.end(),
                                    [&](const Turn& turn) { return turn.way(senses.time_s) >= 1.0; });
  calm_s_ = finished && speed < kCalm_m_s && turning < kCalmTurning ? calm_s_ + h : 0.0;
  slow_s_ = finished && speed < kSlow_m_s ? slow_s_ + h : 0.0;
  if (!landing_.landed_s()) return;
  const bool lies = on_floor(senses, Segment::pelvis) || on_floor(senses, Segment::abdomen) ||
                    senses.time_s > *landing_.landed_s() + kLongestArch_s * body_.tau;
  if (!report_.settled_s && lies && (calm_s_ > kCalmFor_s || slow_s_ > kSlowFor_s))
    report_.settled_s = senses.time_s;
  still_s_ = report_.settled_s && speed < kRest_m_s && turning < kRestTurning ? still_s_ + h : 0.0;
  if (!rest_s_ && still_s_ > kRestFor_s) rest_s_ = senses.time_s;
}

ControllerReport Falling::report() const {
  ControllerReport report;
  report.fall = report_;
  if (report_.settled_s) report.events.push_back({"settled", *report_.settled_s});
  return report;
}

bool Falling::done() const {
  if (!begun()) return true;
  return rest_s_ && (!settings_.breathes || before_.time_s > *rest_s_ + kBreathesOn_s);
}

namespace {

Quat towards(const Quat& from, const Quat& to, double share) { return from.slerp(share, to); }

}  // namespace

void Falling::aim_arms(const Senses& senses, PerJoint<Quat>& goals) const {
  const double off =
      kArmAtOnce + (1.0 - kArmAtOnce) * min_jerk(way().beyond_m / (kArmReady_m * body_.lambda));
  for (const BodySide side : kSides) {
    if (!protects(side)) continue;
    const double left_s = time_to_brace(body_, senses, side) / body_.tau;
    const double ready = std::max(off, min_jerk((kReadyBefore_s - left_s) / kReadyIn_s));
    HandTarget target = landing_place(body_, senses, way(), variation_, side);
    const ArmLanding& arm = landing_.arm(side);
    if (arm.touched_s) target.wrist = arm.wrist;
    const ArmPose pose = arm_reaching(body_, senses, target, side);
    const double share = arm.touched_s ? 1.0 : ready;
    const auto set = [&](Joint right, const Quat& to) {
      const int j = index(on(side, right));
      goals[j] = towards(captured_[j].value_or(to), body_.inside(joint_at(j), to, kMargin), share);
    };
    set(Joint::shoulder_r, pose.shoulder);
    set(Joint::elbow_r, pose.elbow);
    set(Joint::wrist_r, pose.wrist);
  }
}

/// What each joint is turned to: as falling asks, or as lying asks once its part settles.
PerJoint<Quat> Falling::goals_of(const Senses& senses) const {
  PerJoint<Quat> falling = held_;
  crouch(way(), variation_, body_.lambda, dive(body_, senses, way()), falling);
  PerJoint<Quat> lying = held_;
  lie(pose_, variation_, lying);
  if (pose_ == EndPose::prone && !flat_) sprawl(lying);
  for (int j = 0; j < kJointCount; ++j) {
    const Joint joint = joint_at(j);
    const bool settles = is_settling(part_of(joint));
    if (settles || !is_arm(joint) || joint == Joint::clavicle_l || joint == Joint::clavicle_r)
      falling[j] = body_.inside(joint, settles ? lying[j] : falling[j], kMargin);
  }
  PerJoint<Quat> arms = falling;
  aim_arms(senses, arms);
  for (int j = 0; j < kJointCount; ++j)
    if (is_arm(joint_at(j)) && !is_settling(part_of(joint_at(j)))) falling[j] = arms[j];
  return falling;
}

Falling::Effort Falling::falling_effort(Joint joint, double time_s) const {
  Effort effort;
  switch (part_of(joint)) {
    case Part::trunk:
      effort = {0.7, 0.12};
      break;
    case Part::neck:
      effort = {1.2, 0.12};
      break;
    case Part::legs:
      effort = {0.6 + 0.6 * way().backward + kLegsAside * way().sideways, 0.15 + 0.15 * way().backward};
      break;
    case Part::arm_l:
    case Part::arm_r:
      effort = arm_effort(joint, time_s);
      break;
  }
  effort.share *= settings_.strength;
  return effort;
}

/// Reaching, then bracing against the ground, then propping.
Falling::Effort Falling::arm_effort(Joint joint, double time_s) const {
  const BodySide side = is_left(joint) ? BodySide::left : BodySide::right;
  const bool wrist = joint == Joint::wrist_l || joint == Joint::wrist_r;
  if (!protects(side)) return {0.05, 0.12};
  const ArmLanding& arm = landing_.arm(side);
  if (!arm.touched_s) return {wrist ? 2.5 : 0.8, 0.12};
  Effort effort{
      wrist ? 2.5
            : kTouching + kHardTouching * std::clamp(arm.sink_m_s / body_.tau - kHardSink_m_s, 0.0, 1.0),
      0.30};
  if (pose_ == EndPose::prone) {
    effort.share *= kYielding + (1.0 - kYielding) * arm.brake;  // on to the belly
    return effort;
  }
  if (!arm.braked_s || pose_ == EndPose::seated) return effort;
  const double since_s = (time_s - *arm.braked_s) / body_.tau;
  effort.share *= 1.0 - 0.5 * min_jerk((since_s - 0.2) / 0.6);  // props for a while
  return effort;
}

double Falling::lying_share(Joint joint) const {
  const bool seated = pose_ == EndPose::seated;
  switch (part_of(joint)) {
    case Part::trunk:
      return (seated ? 0.5 : 0.25) * settings_.propping;
    case Part::neck:
      return 0.5 * settings_.propping;
    case Part::legs:
      if (pose_ == EndPose::prone && !flat_)
        return (is_hip(joint) ? kHipsThrough : kLooseKnees) * settings_.propping;
      return (pose_ == EndPose::prone && !report_.settled_s ? 0.4 : 0.22) * settings_.propping;
    default:
      if (pose_ == EndPose::supine) return kArmAtRest * settings_.propping;
      return (seated ? 0.6 : landing_.chest_down_s() ? 0.25 : 0.15) * settings_.propping;
  }
}

Falling::Effort Falling::effort_of(Joint joint, double time_s) const {
  const Turn& turn = turns_[index(joint)];
  if (!is_settling(part_of(joint))) return falling_effort(joint, time_s);
  const double way = turn.way(time_s);
  const double still =
      report_.settled_s ? min_jerk((time_s - *report_.settled_s) / (kStill_s * body_.tau)) : 0.0;
  const double moving = landing_.landed_s() ? kMoving * 4.0 * way * (1.0 - way) * settings_.propping : 0.0;
  return {turn.from_share + way * (lying_share(joint) - turn.from_share) + moving,
          (0.12 + 0.1 * way) * (1.0 + (kStillDamping - 1.0) * still)};
}

/// The chest rises and falls once the body has settled: turns a goal and gives it the speed of that turn.
void Falling::breathe(Joint joint, double time_s, JointGoal& goal) const {
  if (!settings_.breathes || !report_.settled_s) return;
  const double since_s = (time_s - *report_.settled_s) / body_.tau;
  const auto [angle, speed] = breath(joint, since_s);
  goal.parent_from_child = goal.parent_from_child * exp_rotation(Vec3(0.0, 0.0, angle));
  goal.velocity = before_.pose[index(parent_of(joint))].rotation * goal.parent_from_child *
                  Vec3(0.0, 0.0, speed / body_.tau);
}

void Falling::ask(const Senses& senses) {
  const PerJoint<Quat> goals = goals_of(senses);
  for (int j = 0; j < kJointCount; ++j) {
    if (!captured_[j]) continue;
    const Joint joint = joint_at(j);
    const Quat last = held_[j];
    held_[j] = towards(turns_[j].from, goals[j], turns_[j].way(senses.time_s));
    const Effort effort = effort_of(joint, senses.time_s);
    share_[j] = effort.share;
    velocity_[j] = Vec3::Zero();
    const double h = senses.time_s - before_.time_s;
    if (part_of(joint) == Part::legs && h > 0.0 && !is_settling(Part::legs))
      velocity_[j] =
          (senses.pose[index(parent_of(joint))].rotation * log_rotation(held_[j] * last.conjugate())) / h;
    damping_s_[j] = effort.damping_s;
  }
}

void Falling::drive(double time_s, Goals& goals) const {
  if (!begun()) return;
  for (int j = 0; j < kJointCount; ++j) {
    const double fade = faded(joint_at(j), time_s);
    if (body_.fused[j] || !captured_[j] || fade <= 0.0) continue;
    const double stiffness = share_[j] * body_.stiffness[j];
    const double torque = body_.stiffness[j] * kFullTorqueAt;
    JointGoal goal;
    goal.parent_from_child = held_[j];
    goal.velocity = velocity_[j];
    breathe(joint_at(j), time_s, goal);
    goal.stiffness_n_m_rad = fade * stiffness;
    goal.damping_n_m_s_rad = fade * std::max(damping_s_[j] * stiffness, kLooseDamping_s * torque);
    const double cap = fade * std::max(share_[j], kLeastShare) * torque;
    goal.least_n_m = body_.strength[j].least_n_m.cwiseMax(-cap);
    goal.most_n_m = body_.strength[j].most_n_m.cwiseMin(cap);
    goals.joints[j].push_back(goal);
  }
}

}  // namespace ukemi
