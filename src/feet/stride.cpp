#include "feet/stride.h"

#include <algorithm>
#include <cmath>

#include "body/centre_of_mass.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

// Balance.
constexpr double kPush = 2.0;  // pressure beyond that of the gait, per metre of the capture point
constexpr double kLift = 75.0, kLiftDamping = 14.0;         // 1/s^2, 1/s: height
constexpr double kUpright = 550.0, kUprightDamping = 30.0;  // N m/rad, N m s/rad: trunk
constexpr double kMostUpright = 150.0;                      // N m
constexpr double kLeastLoad = 0.2, kMostLoad = 3.2;         // of the weight: what the ground bears
constexpr double kMostAlong = 0.7;                          // of that: along the ground
constexpr double kLeastShare = 0.06;                        // of it: on either of two feet

// Steps.
constexpr double kCatch = 1.12;        // of the capture point's error: how far beyond its place a foot lands
constexpr double kCatchFlying = 0.6;   // the same out of a flight
constexpr double kFlight_s = 0.03;     // both feet are in the air for more
constexpr double kShareOfBoth = 0.5;   // of the time on both feet: the error still grows
constexpr double kMostOfBoth_s = 0.3;  // that time, at most
constexpr double kLongestReach = 0.8;  // of the leg: from the centre of mass to a foot that lands
constexpr double kAside = 0.09;  // m: least distance to the side of the other foot, unless the gait has less
constexpr double kToesClear = 0.05;   // m: from the toes of a foot in the air to the ground
constexpr double kLandsFrom = 0.6;    // of a step
constexpr double kLandsBy_s = 0.03;   // before its end, a foot that touches stands wherever it is,
constexpr double kNear = 0.15;        // m: and earlier where it is as near to its place
constexpr double kOverdue_s = 0.1;    // a foot is lifted even if the other does not bear
constexpr double kLate_m_s = 0.5;     // a foot that is late goes down
constexpr double kComing_s = 0.2;     // time before a far step lands in which the pelvis sinks,
constexpr double kDeepest = 0.15;     // m: at most,
constexpr double kGivesWay_s = 0.05;  // with this time constant
constexpr double kReached = 0.985;    // of the leg
constexpr double kOnGround = 0.01;    // m: a foot so low at the start stands
constexpr double kBearing_s = 0.02;   // time until a foot on the ground bears its load
constexpr double kSettle_s = 0.08;    // a foot that lands takes its place
constexpr double kSlipped = 0.10;     // m: a foot that was moved farther stands there now

// Pace of the gait.
constexpr double kWaits = 0.25;     // for a foot that is late
constexpr double kCatchesUp = 1.5;  // with one that was early
constexpr double kFollows = 8.0;    // 1/s: with a body that is ahead of it or behind
constexpr double kGoes_m_s = 0.3;   // slower gaits keep their own pace
constexpr double kSlowest = 0.6, kFastest = 1.66;
constexpr double kHurries = 2.1, kHurriesFrom = 0.1;  // 1/m, m: for a body that falls aside

// Springs, shares.
constexpr double kStanding = 0.6, kStandingAnkle = 0.2;
constexpr double kTrunk = 1.0, kArm = 0.7;
constexpr double kDamping_s = 0.12;

// When balance is lost, and when it goes well.
constexpr double kSunk = 0.6;                       // of the height of a body that stands
constexpr double kOutOfReach = 0.9;                 // of the leg: of the capture point
constexpr double kWell = 0.15, kWell_m_s = 0.35;    // m, m/s: of the capture point and the speed
constexpr double kWellFor_s = 0.4, kLeast_s = 1.2;  // it is seen to go on for so long after the blow

}  // namespace

struct Striding::View {
  BodyPose gait, soon;  // now, and after kAhead_s
  Vec3 gait_com, gait_velocity, gait_acceleration;
  Vec2 com, velocity;
  double height = 1.0, rate = 3.0;
  PerSide<Vec2> sole;
  PerSide<Quat> foot;  // orientation
  int standing = 0;
  std::vector<Vec2> outer;            // of the soles that stand
  Vec2 anchor, gait_anchor;           // middle of those soles, here and in the gait; without any, the body's
  Vec2 ahead = Vec2::Zero();          // of the body over them, from where the gait has it
  Vec2 error = Vec2::Zero();          // of the capture point, likewise
  Vec2 speed_error = Vec2::Zero();    // m/s
  Vec2 gait_pressure = Vec2::Zero();  // where the gait pushes, under these soles
  Vec2 pressure = Vec2::Zero();       // where it is wanted
  Vec3 force = Vec3::Zero();          // of the ground
  PerSide<double> share{0.5, 0.5};    // of it
};

Striding::Striding(const ArticulatedBody& body, const BodyPose& home, double gravity,
                   const StandSettings& settings, std::shared_ptr<const Gait> gait)
    : settings_(settings),
      physique_(body, Leg(body, home, BodySide::left).length_m(), gravity),
      legs_{Leg(body, home, BodySide::left), Leg(body, home, BodySide::right)},
      gait_(std::move(gait)),
      flinch_(settings.flinch, yaw_of(home[0].rotation * Vec3::UnitX())),
      home_height_(centre_of_mass(body, home).y()) {}

void Striding::start(const Senses& senses) {
  for (const BodySide side : kSides) {
    Foot& f = foot(side);
    const auto& stands = gait_->stands(side);
    while (f.stand < stands.size() && stands[f.stand].until_s <= 0.0) ++f.stand;
    f.stands = f.stand < stands.size() && stands[f.stand].from_s <= 0.0;
    f.in_air = !f.stands;
    // No contact is known yet.
    f.bears = f.stands && leg(side).lowest_corner(senses) < m(kOnGround) ? 1.0 : 0.0;
    f.planted = senses.pose[ukemi::index(leg(side).foot)].translation;
    if (!f.stands) steps_.push_back({leg(side).foot, 0.0, std::nullopt, 0.0});
  }
  ask(senses);
}

void Striding::observe(const Senses& senses, double h) {
  time_s_ = senses.time_s;
  feel_feet(senses, h);
  pace_ = pace(view_of(senses));
  phase_s_ += pace_ * h;
  if (!lost_s()) change_feet(senses);
  const View view = view_of(senses);
  sunk_m_ += std::min(1.0, h / s(kGivesWay_s)) * (out_of_reach(senses, view) - sunk_m_);
  watch(senses, view, h);
  ask(senses);
}

std::optional<BodySide> Striding::swinging() const {
  for (const BodySide side : kSides)
    if (!foot(side).stands) return side;
  return std::nullopt;
}

std::optional<GoesOn> Striding::goes_on() const {
  if (lost_s() || well_s_ < s(kWellFor_s) || time_s_ < s(kLeast_s)) return std::nullopt;
  return GoesOn{time_s_, phase_s_};
}

std::optional<Stand> Striding::stand_of(BodySide side) const {
  const auto& stands = gait_->stands(side);
  return foot(side).stand < stands.size() ? std::optional(stands[foot(side).stand]) : std::nullopt;
}

// ---- what is seen

Striding::View Striding::view_of(const Senses& senses) const {
  View view;
  view.gait = gait_->pose(phase_s_);
  view.soon = gait_->pose(phase_s_ + pace_ * kAhead_s);
  view.gait_com = gait_->com(phase_s_);
  view.gait_velocity = gait_->velocity(phase_s_);
  view.gait_acceleration = gait_->acceleration(phase_s_);
  view.com = on_ground(senses.com);
  view.velocity = on_ground(senses.com_velocity);
  view.speed_error = view.velocity - on_ground(view.gait_velocity);
  view.height = std::max(senses.com.y(), 0.1);
  view.rate = std::sqrt(std::max(physique_.gravity, 0.1) / view.height);
  view.anchor = view.gait_anchor = Vec2::Zero();
  std::vector<Vec2> outer;
  for (const BodySide side : kSides) {
    const int i = ukemi::index(side);
    const int segment = ukemi::index(leg(side).foot);
    view.sole[i] = leg(side).sole_at(senses);
    view.foot[i] = senses.pose[segment].rotation;
    if (!foot(side).stands) continue;
    ++view.standing;
    view.anchor += view.sole[i];
    const auto stand = stand_of(side);
    view.gait_anchor += stand ? stand->sole : on_ground(view.gait[segment] * leg(side).sole_middle);
    const auto corners = leg(side).sole_corners(senses, 0.0);
    outer.insert(outer.end(), corners.begin(), corners.end());
  }
  view.outer = convex_hull(std::move(outer));
  see_balance(view);
  see_force(senses, view);
  return view;
}

void Striding::see_balance(View& view) const {
  const Vec2 gait_com = on_ground(view.gait_com);
  if (view.standing == 0) {
    view.anchor = view.com;
    view.gait_anchor = gait_com;
    view.error = view.speed_error / view.rate;
    return;
  }
  view.anchor /= view.standing;
  view.gait_anchor /= view.standing;
  const double gait_rate = std::sqrt(std::max(physique_.gravity, 0.1) / view.gait_com.y());
  view.ahead = (view.com - view.anchor) - (gait_com - view.gait_anchor);
  view.error = view.ahead + view.velocity / view.rate - on_ground(view.gait_velocity) / gait_rate;
  const double up = std::max(physique_.gravity + view.gait_acceleration.y(), 0.3 * physique_.gravity);
  const Vec2 pushes = gait_com - on_ground(view.gait_acceleration) * view.gait_com.y() / up;
  view.gait_pressure = into(view.outer, view.anchor + pushes - view.gait_anchor);
  view.pressure = into(view.outer, view.gait_pressure + kPush * view.error);
}

void Striding::see_force(const Senses& senses, View& view) const {
  const double lift = kLift / physique_.size * (view.gait_com.y() - sunk_m_ - senses.com.y()) +
                      kLiftDamping / physique_.tempo * (view.gait_velocity.y() - senses.com_velocity.y());
  const double up = physique_.mass_kg * std::clamp(physique_.gravity + view.gait_acceleration.y() + lift,
                                                   kLeastLoad * physique_.weight_m_s2(),
                                                   kMostLoad * physique_.weight_m_s2());
  const double strength = physique_.strength * settings_.strength;
  const Vec3 lean = log_rotation(senses.pose[0].rotation * view.gait[0].rotation.conjugate());
  const Vec3 turning = log_rotation(view.soon[0].rotation * view.gait[0].rotation.conjugate()) / kAhead_s;
  Vec3 moment = strength * (-kUpright * lean - kUprightDamping * (senses.angular_velocity[0] - turning));
  const double most = kMostUpright * strength;
  moment = moment.cwiseMax(-most).cwiseMin(most);
  Vec2 along = up * (view.com - view.pressure) / view.height + Vec2(moment.z(), -moment.x()) / view.height;
  if (along.norm() > kMostAlong * up) along *= kMostAlong * up / along.norm();
  view.force = at_height(along, up);
  if (view.standing == 1) {
    view.share = {foot(BodySide::left).stands ? 1.0 : 0.0, foot(BodySide::right).stands ? 1.0 : 0.0};
  } else if (view.standing == 2) {
    const Vec2 apart = view.sole[1] - view.sole[0];
    const double right =
        std::clamp((view.pressure - view.sole[0]).dot(apart) / std::max(apart.squaredNorm(), 1e-6),
                   kLeastShare, 1.0 - kLeastShare);
    view.share = {1.0 - right, right};
  }
}

Vec2 Striding::heading() const {
  const Vec2 velocity = on_ground(gait_->velocity(phase_s_));
  return velocity.norm() > 1e-6 ? Vec2(velocity.normalized()) : Vec2(Vec2::UnitX());
}

// ---- the gait and its feet

/// How fast the gait goes on, of its own speed.
double Striding::pace(const View& view) const {
  double pace = 1.0;
  const double speed = on_ground(view.gait_velocity).norm();
  if (view.standing > 0 && speed > m_s(kGoes_m_s)) {
    pace = std::clamp(1.0 + kFollows * view.ahead.dot(heading()) / speed, kSlowest, kFastest);
    const Vec2 aside = view.error - view.error.dot(heading()) * heading();
    const double hurry = kHurries * std::max(0.0, aside.norm() / physique_.size - kHurriesFrom);
    if (view.standing == 1) pace = std::min(kFastest, pace + hurry);
  }
  for (const BodySide side : kSides) {
    const auto stand = stand_of(side);
    if (!stand) continue;
    if (!foot(side).stands && phase_s_ > stand->from_s) pace = std::min(pace, kWaits);
    if (foot(side).stands && phase_s_ < stand->from_s) pace = std::max(pace, kCatchesUp);
  }
  return pace;
}

void Striding::feel_feet(const Senses& senses, double h) {
  for (const BodySide side : kSides) {
    Foot& f = foot(side);
    const auto stand = stand_of(side);
    const Vec3& ankle = senses.pose[ukemi::index(leg(side).foot)].translation;
    f.bears += std::min(1.0, h / s(kBearing_s)) * ((leg(side).touches(senses) ? 1.0 : 0.0) - f.bears);
    f.late_s = !f.stands && stand && phase_s_ > stand->from_s ? f.late_s + h : 0.0;
    const bool settling = senses.time_s < f.landed_s + s(kSettle_s);
    if (settling || on_ground(ankle - f.planted).norm() > m(kSlipped)) f.planted = ankle;
  }
}

/// The other foot bears, or the gait flies.
bool Striding::may_lift(BodySide side) const {
  const auto stand = stand_of(side), theirs = stand_of(other(side));
  if (phase_s_ < stand->until_s) return false;
  const Foot& o = foot(other(side));
  const bool flies = !o.stands && theirs && theirs->from_s > stand->until_s;
  return flies || (o.stands && o.bears > 0.5) || phase_s_ > stand->until_s + s(kOverdue_s);
}

bool Striding::lands(const Senses& senses, BodySide side) const {
  const Foot& f = foot(side);
  if (!f.in_air || !leg(side).touches(senses)) return false;
  const Stand stand = *stand_of(side);
  const double progress = (phase_s_ - f.lifted_s) / std::max(stand.from_s - f.lifted_s, 0.02);
  const bool near = (leg(side).sole_at(senses) - f.to).norm() < m(kNear);
  return progress > kLandsFrom && (near || stand.from_s - phase_s_ < s(kLandsBy_s));
}

void Striding::change_feet(const Senses& senses) {
  for (const BodySide side : kSides) {
    Foot& f = foot(side);
    if (!stand_of(side)) continue;
    if (f.stands && may_lift(side)) return lift(senses, side);
    if (f.stands) continue;
    f.in_air = f.in_air || !leg(side).touches(senses);
    if (lands(senses, side)) land(senses, side);
  }
}

void Striding::lift(const Senses& senses, BodySide side) {
  Foot& f = foot(side);
  f.stands = f.in_air = false;
  f.lifted_s = phase_s_;
  ++f.stand;
  const Vec3 gait = gait_->pose(phase_s_)[ukemi::index(leg(side).foot)].translation;
  const Vec3& ankle = senses.pose[ukemi::index(leg(side).foot)].translation;
  f.off = ankle - gait;
  f.off -= at_height(on_ground(senses.com - gait_->com(phase_s_)), 0.0);
  steps_.push_back({leg(side).foot, senses.time_s, std::nullopt, 0.0});
}

void Striding::land(const Senses& senses, BodySide side) {
  Foot& f = foot(side);
  f.stands = true;
  f.landed_s = senses.time_s;
  const Vec3 lifted = f.planted;
  f.planted = senses.pose[ukemi::index(leg(side).foot)].translation;
  const auto step = std::find_if(steps_.rbegin(), steps_.rend(),
                                 [&](const StepTaken& taken) { return taken.foot == leg(side).foot; });
  if (step == steps_.rend()) return;
  step->contact_s = senses.time_s;
  step->length_m = on_ground(f.planted - lifted).norm();
}

/// Of the capture point, when the foot has landed and bears.
Vec2 Striding::error_at_landing(const View& view, BodySide side, double left_s) const {
  const auto theirs = stand_of(other(side));
  // A foot that the gait never lifts again stands for long: the error does not grow until then.
  const double both = foot(other(side)).stands && theirs
                          ? std::clamp(theirs->until_s - phase_s_, 0.0, left_s + kMostOfBoth_s)
                          : 0.0;
  const double flight_s = std::max(0.0, left_s - both);
  const double grounded_s = std::min(both, left_s + kShareOfBoth * std::max(0.0, both - left_s));
  Vec2 error = view.error;
  if (view.standing > 0) {
    const Vec2 held = into(view.outer, view.gait_pressure + view.error) - view.gait_pressure;
    error = held + (view.error - held) * std::exp(view.rate * grounded_s);
  }
  return (flight_s > kFlight_s ? kCatchFlying : kCatch) * error + flight_s * view.speed_error;
}

/// Where the foot is to land so that the capture point lies from it as in the gait.
Vec2 Striding::landing_place(const View& view, BodySide side) const {
  const auto stand = stand_of(side);
  if (!stand) return view.sole[ukemi::index(side)];
  const double left_s = std::max(0.0, stand->from_s - phase_s_);
  const Vec2 way = stand->sole - view.gait_anchor;
  Vec2 place = view.anchor + way + error_at_landing(view, side, left_s);
  if (foot(other(side)).stands) {
    // It does not cross the standing foot.
    const Vec2 out = sign(side) * Vec2(-heading().y(), heading().x());
    const double aside = (place - view.sole[ukemi::index(other(side))]).dot(out);
    place += std::max(0.0, std::min(way.dot(out), m(kAside)) - aside) * out;
  }
  const Vec2 com_then = view.com + left_s * view.velocity;
  Vec2 from_com = place - com_then;
  const double longest = kLongestReach * physique_.leg_length_m;
  if (from_com.norm() > longest) from_com *= longest / from_com.norm();
  return com_then + from_com;
}

/// How far below the gait's the pelvis must be for a foot that comes down to reach its place; taken to the
/// middle of its sole, not to the ankle: who bends his knees more steps more surely.
double Striding::out_of_reach(const Senses& senses, const View& view) const {
  double deepest = 0.0;
  for (const BodySide side : kSides) {
    const Leg& l = leg(side);
    const auto stand = stand_of(side);
    if (foot(side).stands || !stand || stand->from_s - phase_s_ > s(kComing_s)) continue;
    const BodyPose there = gait_->pose(stand->from_s);
    const Rigid& gait_foot = there[ukemi::index(l.foot)];
    const Vec3 hip = there[0].rotation * l.hip_in_pelvis;
    const Vec2 moves = std::max(0.0, stand->from_s - phase_s_) * view.velocity;
    const double aside = (on_ground(senses.pose[0].translation + hip) + moves - foot(side).to).norm();
    const double reach = kReached * l.length_m();
    const double up = std::sqrt(std::max(reach * reach - aside * aside, 0.4 * reach * reach));
    deepest = std::max(deepest, there[0].translation.y() + hip.y() - up - gait_foot.translation.y());
  }
  return std::min(deepest, m(kDeepest));
}

void Striding::watch(const Senses& senses, const View& view, double h) {
  const bool well = view.error.norm() < m(kWell) && view.speed_error.norm() < m_s(kWell_m_s);
  well_s_ = well ? well_s_ + h : 0.0;
  if (lost_s()) return;
  const double tilt = (senses.pose[0].rotation * view.gait[0].rotation.conjugate() * Vec3::UnitY()).y();
  const char* why = senses.com.y() < kSunk * home_height_                      ? "low"
                    : tilt < 0.5                                               ? "tilt"
                    : view.error.norm() > kOutOfReach * physique_.leg_length_m ? "icp"
                                                                               : nullptr;
  if (why != nullptr) lose(senses.time_s, why);
}

// ---- what is asked of the muscles

/// Where the ankle of a foot in the air is to be: as in the gait from the centre of mass, and on its way to
/// another place.
Vec3 Striding::swing_ankle(const BodyPose& gait, const View& view, BodySide side, double phase_s) const {
  const Foot& f = foot(side);
  const Leg& l = leg(side);
  const Rigid& gait_foot = gait[ukemi::index(l.foot)];
  const auto stand = stand_of(side);
  const double progress = (phase_s - f.lifted_s) / (stand ? std::max(stand->from_s - f.lifted_s, 0.05) : 0.3);
  const double fading = 1.0 - min_jerk(progress / 0.6);
  const Vec2 com = view.com + (phase_s - phase_s_) / pace_ * view.velocity;
  const Vec2 gait_com = on_ground(gait_->com(phase_s));
  Vec2 at = com + on_ground(gait_foot.translation) - gait_com + fading * on_ground(f.off);
  // Toes of a rigid foot clear the ground.
  double lowest = 0.0;
  for (const Vec3& corner : l.sole)
    lowest =
        std::min({lowest, (gait_foot.rotation * corner).y(), (view.foot[ukemi::index(side)] * corner).y()});
  const double clear = m(kToesClear) * min_jerk(progress / 0.2) * (1.0 - min_jerk((progress - 0.8) / 0.2));
  const double height =
      std::max(gait_foot.translation.y() + fading * f.off.y(), min_jerk(progress / 0.1) * (clear - lowest));
  if (!stand) return at_height(at, height);
  const double left_s = std::max(0.0, stand->from_s - phase_s);
  const Vec2 as_in_the_gait = com + stand->sole - gait_com + left_s * view.speed_error;
  at += min_jerk(progress) * (f.to - as_in_the_gait);
  return at_height(at, height - m_s(kLate_m_s) * f.late_s);
}

/// The gait's posture of a leg, changed as much as another way from hip to ankle asks.
LegPosture Striding::posture(const BodyPose& gait, BodySide side, const Vec3& hip, const Vec3& ankle) const {
  const Leg& l = leg(side);
  const Rigid& thigh = gait[ukemi::index(l.thigh)];
  const Rigid& foot = gait[ukemi::index(l.foot)];
  const double yaw = yaw_of(gait[0].rotation * Vec3::UnitX()) - l.home_yaw;
  const LegPosture own = l.reach(thigh.translation, foot.translation, yaw, 0.0);
  const LegPosture wanted = l.reach(hip, ankle, yaw, 0.0);
  return {wanted.thigh * own.thigh.conjugate() * thigh.rotation,
          wanted.shank * own.shank.conjugate() * gait[ukemi::index(l.shank)].rotation, foot.rotation};
}

void Striding::ask_standing_leg(const Senses& senses, const View& view, BodySide side) {
  const Leg& l = leg(side);
  const int i = ukemi::index(side);
  const int foot_segment = ukemi::index(l.foot);
  const auto hip_of = [&](const BodyPose& gait, double later_s) -> Vec3 {
    const Vec2 pelvis = on_ground(senses.pose[0].translation) + later_s * view.velocity;
    return at_height(pelvis, gait[0].translation.y() - sunk_m_) + gait[0].rotation * l.hip_in_pelvis;
  };
  Vec3 ankle = senses.pose[foot_segment].translation;
  if (!l.touches(senses))  // it reaches for the ground
    ankle = at_height(on_ground(foot(side).planted), view.gait[foot_segment].translation.y() - m(0.01));
  const double rises = view.soon[foot_segment].translation.y() - view.gait[foot_segment].translation.y();
  const LegPosture now = posture(view.gait, side, hip_of(view.gait, 0.0), ankle);
  const LegPosture next =
      posture(view.soon, side, hip_of(view.soon, kAhead_s), ankle + rises * Vec3::UnitY());
  const std::array<Joint, 3> joints = {l.hip, l.knee, l.ankle};
  const std::array<Segment, 3> parents = {Segment::pelvis, l.thigh, l.shank};
  const std::array<Quat, 4> goal = {view.gait[0].rotation, now.thigh, now.shank, now.foot};
  const std::array<Quat, 4> soon = {view.soon[0].rotation, next.thigh, next.shank, next.foot};
  // A leg that unloads does not push the body off the ground.
  const double soft = 0.5 + 0.5 * std::clamp(2.0 * view.share[i], 0.15, 1.0);
  const double loaded = std::clamp(2.0 * view.share[i], 0.1, 1.0);
  const std::array<double, 3> share = {kStanding * soft, kStanding * soft, kStandingAnkle * loaded};
  const auto corners = l.sole_corners(senses, 0.0);
  const Vec2 pressure = into(convex_hull({corners.begin(), corners.end()}), view.pressure);
  for (int k = 0; k < 3; ++k) {
    const Vec3 arm = at_height(pressure, 0.0) - joint_at(senses, joints[k]);
    const Vec3 carried = -(arm.cross(foot(side).bears * view.share[i] * view.force) +
                           physique_.weight_torque(senses, joints[k]));
    const Quat relative = goal[k].conjugate() * goal[k + 1];
    const Quat later = soon[k].conjugate() * soon[k + 1];
    const Quat& parent = senses.pose[ukemi::index(parents[k])].rotation;
    const Vec3 omega = parent * log_rotation(later * relative.conjugate()) / kAhead_s;
    ask_joint(physique_, settings_.strength, joints[k], {relative, omega, carried, share[k], s(kDamping_s)},
              asked_);
  }
}

void Striding::ask_swinging_leg(const Senses& senses, const View& view, BodySide side) {
  const Leg& l = leg(side);
  const Vec3 hip = joint_at(senses, l.hip);
  const Vec3 hip_velocity = senses.velocity[0] + senses.angular_velocity[0].cross(hip - senses.centre[0]);
  const LegPosture now = posture(view.gait, side, hip, swing_ankle(view.gait, view, side, phase_s_));
  const LegPosture next = posture(view.soon, side, hip + kAhead_s * hip_velocity,
                                  swing_ankle(view.soon, view, side, phase_s_ + pace_ * kAhead_s));
  ukemi::ask_swinging_leg(physique_, settings_.strength, l, senses, now, next, asked_);
}

void Striding::ask_upper_body(const Senses& senses, const View& view) {
  for (int j = 0; j <= ukemi::index(Joint::wrist_r); ++j) {
    const Joint joint = ukemi::joint_at(j);
    const BodySide side = is_left(joint) ? BodySide::left : BodySide::right;
    const bool arm = is_left(joint) || is_right(joint);
    const int up = ukemi::index(parent_of(joint)), down = ukemi::index(child_of(joint));
    const Quat now = view.gait[up].rotation.conjugate() * view.gait[down].rotation;
    const Quat soon = view.soon[up].rotation.conjugate() * view.soon[down].rotation;
    const Vec3 omega = senses.pose[up].rotation * log_rotation(soon * now.conjugate()) / kAhead_s;
    const bool holds = arm && !settings_.arms_free[ukemi::index(side)];
    const Vec3 turn = holds ? Vec3(Vec3::Zero()) : flinch_.turn(joint, senses.time_s);
    ask_joint(physique_, settings_.strength, joint,
              {exp_rotation(turn) * now, omega, -physique_.weight_torque(senses, joint), arm ? kArm : kTrunk,
               s(kDamping_s)},
              asked_);
  }
}

void Striding::ask(const Senses& senses) {
  const View view = view_of(senses);
  asked_.clear();
  asked_.firm_soles = true;
  for (const BodySide side : kSides)
    if (!foot(side).stands) foot(side).to = landing_place(view, side);
  for (const BodySide side : kSides) {
    if (foot(side).stands)
      ask_standing_leg(senses, view, side);
    else
      ask_swinging_leg(senses, view, side);
  }
  ask_upper_body(senses, view);
}

}  // namespace ukemi
