#include "feet/stand.h"

#include <algorithm>
#include <cmath>

#include "body/centre_of_mass.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

// Balance.
constexpr double kSpinShare = 0.58;  // of the turning that becomes speed when it is stopped
constexpr double kEdge = 0.02;       // m: distance that pressure keeps from the edge of the soles
constexpr double kPush = 1.5;        // pressure beyond the capture point, per metre from the reference
constexpr double kCalmPush = 2.5;    // the same once a step has been taken and the capture point is inside
constexpr double kLift = 75.0, kLiftDamping = 14.0;         // 1/s^2, 1/s: height
constexpr double kUpright = 600.0, kUprightDamping = 30.0;  // N m/rad, N m s/rad: trunk
constexpr double kMostUpright = 150.0;                      // N m
constexpr double kHipLean = 4.0, kMostLean = 0.7;  // rad per m of the capture point beyond planted feet, rad
constexpr double kHelp = 1.5;                      // of what stops the capture point
constexpr double kReaction_s = 0.06;               // from nothing to everything

constexpr double kDamping_s = 0.12;

// Steps.
constexpr double kFastest_s = 0.22;
constexpr double kSwing_m_s = 2.8, kLongestSwing_s = 0.4;  // of a foot over its way

constexpr double kWellUp = 0.06;       // m: a foot higher than this does not roll over its toes
constexpr double kOutOfReach = 1.05;   // of the leg: no step catches a capture point farther beyond the feet
constexpr double kOutOfStride = 1.4;   // the same of a body that walks or runs
constexpr double kLongestStep = 1.03;  // of the leg
constexpr double kAgain = 0.6;         // m: cost of a step with the foot that has just landed
constexpr double kHovers = 0.015;      // m: a late foot that is nearer to the ground stands
constexpr double kSettle_s = 0.08;     // a foot that lands takes its place
constexpr double kBearing_s = 0.02;    // time until a foot off the ground pushes no more
constexpr double kSlipped = 0.10;      // m: a foot that was moved farther stands there now
constexpr double kSinking = 0.82, kSunk = 0.72;  // height of the centre of mass, over its height at home
constexpr double kHigh = 0.135;  // m: a foot so far up, over its height at home, sinks all the way
// m: a foot that lags so far behind its way is waited for: longer, the farther it lags, up to this share of
// the time. A thigh gains some 350 degrees a second where a hurried way asks for 700: the shank must not go
// ahead of it.
constexpr double kLags = 0.15, kLagsFarther = 0.2, kMostWait = 0.7;
constexpr double kToesClear = 0.03;  // m: from the toes of a foot in the air to the ground
constexpr double kLevelBy = 0.8, kSwungThroughLevelBy = 0.5;  // of the step: then the foot is level
constexpr double kSwungUntil = 0.9;                           // of the step: then it comes down
constexpr double kHeel = 1.03;                                // of the leg, by the heel

}  // namespace

struct Standing::View {
  double time_s = 0.0;
  PerSide<bool> stands{};
  Vec2 com, velocity, icp;  // on the ground; icp: the extrapolated centre of mass (capture point)
  double height = 1.0, rate = 3.0;
  double yaw = 0.0;  // of the body from home
  Vec2 forward, right;
  PerSide<Vec2> sole;
  std::vector<Vec2> outer, inner;  // support, and the part of it that pressure uses
  Vec2 middle = Vec2::Zero();      // of the soles that stand
  Vec2 reference = Vec2::Zero();

  /// The capture point after a while, pressure at the nearest place to it.
  Vec2 icp_after(double span_s) const {
    const Vec2 p = into(inner, icp);
    return p + (icp - p) * std::exp(rate * std::max(0.0, span_s));
  }
  double right_part(const Vec2& v) const { return v.dot(right); }
};

struct Standing::Wrench {
  Vec3 force = Vec3::Zero();  // of the ground
  PerSide<double> share{0.5, 0.5};
  PerSide<Vec2> pressure{Vec2::Zero(), Vec2::Zero()};
};

Standing::Standing(const ArticulatedBody& body, const BodyPose& home, double gravity,
                   const StandSettings& settings)
    : settings_(settings),
      physique_(body, Leg(body, home, BodySide::left).length_m(), gravity),
      legs_{Leg(body, home, BodySide::left), Leg(body, home, BodySide::right)},
      home_(home) {
  const double heading = yaw_of(home[0].rotation * Vec3::UnitX());
  flinch_ = Flinch(settings.flinch, heading);
  const Vec3 com = centre_of_mass(body, home);
  Vec2 middle = Vec2::Zero();
  for (const BodySide side : kSides) {
    const Vec2 sole = on_ground(home[ukemi::index(leg(side).foot)] * leg(side).sole_middle);
    home_sole_[ukemi::index(side)] = sole;
    middle += 0.5 * sole;
  }
  const auto in_heading = [&](const Vec2& v) {
    return Vec2(v.dot(forward_of(heading)), v.dot(right_of(heading)));
  };
  home_com_ = in_heading(on_ground(com) - middle);
  for (Vec2& sole : home_sole_) sole = in_heading(sole - middle);
  home_height_ = com.y();
  straightness_ = 1.0;
  pelvis_y_ = home[0].translation.y();
}

double Standing::active(double time_s) const {
  if (under_way_) return 1.0;  // its gait is in control already
  return std::clamp((time_s - s(settings_.latency_s)) / s(kReaction_s), 0.0, 1.0);
}

std::optional<BodySide> Standing::swinging() const {
  return phase_ == Phase::swing ? std::optional(swing_.side) : std::nullopt;
}

Standing::View Standing::view_of(const Senses& senses) const {
  View view;
  view.time_s = senses.time_s;
  view.com = on_ground(senses.com);
  view.velocity = on_ground(senses.com_velocity);
  view.height = std::max(senses.com.y(), 0.1);
  view.rate = std::sqrt(std::max(physique_.gravity, 0.1) / view.height);
  const Vec2 turning =
      Vec2(-senses.angular_momentum.z(), senses.angular_momentum.x()) / (physique_.mass_kg * view.height);
  view.icp = view.com + (view.velocity + kSpinShare * turning) / view.rate;
  double yaw_x = 0.0;
  double yaw_y = 0.0;
  std::vector<Vec2> outer;
  std::vector<Vec2> inner;
  int standing = 0;
  for (const BodySide side : kSides) {
    const int i = ukemi::index(side);
    view.sole[i] = leg(side).sole_at(senses);
    view.stands[i] = swinging() != side;
    if (!view.stands[i]) continue;
    ++standing;
    view.middle += view.sole[i];
    const double foot_yaw = leg(side).yaw(senses) - points_[i];
    yaw_x += std::cos(foot_yaw);
    yaw_y += std::sin(foot_yaw);
    const auto corners = leg(side).sole_corners(senses, 0.0);
    const auto moved_in = leg(side).sole_corners(senses, m(kEdge));
    outer.insert(outer.end(), corners.begin(), corners.end());
    inner.insert(inner.end(), moved_in.begin(), moved_in.end());
  }
  view.middle /= standing;
  view.yaw = std::atan2(yaw_y, yaw_x);
  const double heading = yaw_of(home_[0].rotation * Vec3::UnitX()) + view.yaw;
  view.forward = forward_of(heading);
  view.right = right_of(heading);
  view.outer = convex_hull(std::move(outer));
  view.inner = convex_hull(std::move(inner));
  switch (phase_) {
    case Phase::stand:
      view.reference = view.middle + home_com_.x() * view.forward + home_com_.y() * view.right;
      view.reference += landing_offset_;
      break;
    case Phase::shift:
      view.reference = view.sole[ukemi::index(shift_to_)];
      break;
    case Phase::swing:
      view.reference = view.sole[ukemi::index(other(swing_.side))];
      break;
  }
  view.reference = into(view.inner, view.reference);
  return view;
}

void Standing::start(const Senses& senses) {
  start_com_ = on_ground(senses.com);
  for (const BodySide side : kSides)
    planted_[ukemi::index(side)] = senses.pose[ukemi::index(leg(side).foot)].translation;
  if (settings_.under_way) take_over(senses);
  ask(senses, view_of(senses));
}

Vec3 Standing::ankle_velocity(const Senses& senses, const Leg& leg) const {
  const int foot = ukemi::index(leg.foot);
  return senses.velocity[foot] +
         senses.angular_velocity[foot].cross(senses.pose[foot].translation - senses.centre[foot]);
}

/// Every corner of the sole moves, or the lowest is well above the ground.
bool Standing::in_air(const Senses& senses, const Leg& leg) const {
  if (leg.lowest_corner(senses) > m(0.025)) return true;
  const int foot = ukemi::index(leg.foot);
  return std::all_of(leg.sole.begin(), leg.sole.end(), [&](const Vec3& corner) {
    const Vec3 at = senses.pose[foot] * corner;
    const Vec3 velocity =
        senses.velocity[foot] + senses.angular_velocity[foot].cross(at - senses.centre[foot]);
    return velocity.norm() > m_s(0.6);
  });
}

/// The start of a body under way: a foot in the air goes on with its step.
void Standing::take_over(const Senses& senses) {
  under_way_ = senses.pose;
  for (const BodySide side : kSides) points_[ukemi::index(side)] = leg(side).yaw(senses);
  std::optional<BodySide> first;
  for (const BodySide side : kSides) {
    if (!in_air(senses, leg(side))) continue;
    const auto lands = settings_.under_way->lands_in_s[ukemi::index(side)];
    const auto sooner = [&] { return *lands < *settings_.under_way->lands_in_s[ukemi::index(*first)]; };
    if (!first || (lands && settings_.under_way->lands_in_s[ukemi::index(*first)] && sooner())) first = side;
  }
  if (first) go_on(senses, *first, settings_.under_way->lands_in_s[ukemi::index(*first)].value_or(s(0.25)));
}

/// A foot that is in the air already is taken over with its speed.
void Standing::go_on(const Senses& senses, BodySide side, double lands_in_s) {
  lift(senses, view_of(senses), side, false);
  swing_.in_air = true;
  swing_.from_velocity = ankle_velocity(senses, leg(side));
  swing_.span_s = std::clamp(lands_in_s, s(0.12), s(0.45));
  swing_.to = landing_place(view_of(senses), side, swing_.span_s);
}

/// A goal that begins as the motion under way had the joint.
Quat Standing::taken_over(const Senses& senses, Joint joint, const Quat& goal, double from_s,
                          double until_s) const {
  if (!under_way_) return goal;
  const Quat was = (*under_way_)[ukemi::index(parent_of(joint))].rotation.conjugate() *
                   (*under_way_)[ukemi::index(child_of(joint))].rotation;
  return was.slerp(min_jerk((senses.time_s - s(from_s)) / s(until_s - from_s)), goal);
}

void Standing::observe(const Senses& senses, double h) {
  choose(senses, view_of(senses), h);
  const View view = view_of(senses);
  watch(senses, view, h);
  update_slow_state(senses, view, h);
  ask(senses, view);
}

// ---- the state machine

void Standing::choose(const Senses& senses, const View& view, double h) {
  if (lost_s()) {
    if (phase_ == Phase::swing) swing_on(senses, view, h);
    return;
  }
  switch (phase_) {
    case Phase::stand:
      return stand_on(senses, view, h);
    case Phase::shift:
      return shift_on(senses, view, h);
    case Phase::swing:
      return swing_on(senses, view, h);
  }
}

double Standing::earliest_lift_s() const {
  return std::max({under_way_ ? 0.0 : s(settings_.lift_s), landed_s_[0] + 0.01, landed_s_[1] + 0.01});
}

bool Standing::must_step(const View& view, double time_s) const {
  return beyond(view.outer, view.icp_after(earliest_lift_s() - time_s)) > 0.0;
}

void Standing::stand_on(const Senses& senses, const View& view, double h) {
  const double time_s = senses.time_s;
  for (const BodySide side : kSides)
    if (under_way_ && !steps_.empty() && leg(side).lowest_corner(senses) > m(kWellUp))
      return go_on(senses, side, swing_span(view, side));
  if (must_step(view, time_s)) {
    ready_s_ = 0.0;
    if (time_s < earliest_lift_s()) return;
    if (steps_in_a_row_ >= settings_.most_steps) {
      if (settings_.most_steps > 0) lose(time_s, "steps");
      return;
    }
    return lift(senses, view, stepping_foot(view), false);
  }
  if (settings_.most_steps == 0) return;
  const auto hanging = hanging_foot(senses);
  hanging_s_ = hanging ? hanging_s_ + h : 0.0;
  if (hanging_s_ > s(0.1) && time_s > s(settings_.lift_s)) {
    const bool away = beyond(view.outer, view.icp) > m(0.05);
    return lift(senses, view, *hanging, !away);
  }
  const bool slow = view.velocity.norm() < m_s(0.45) && beyond(view.outer, view.icp) < 0.0;
  ready_s_ = slow && !stance_is_fine(view) && closings_ < 2 ? ready_s_ + h : 0.0;
  if (ready_s_ < s(0.03) || active(time_s) < 1.0) return;
  phase_ = Phase::shift;
  shift_since_s_ = time_s;
  shift_to_ =
      (view.icp - view.sole[0]).norm() < (view.icp - view.sole[1]).norm() ? BodySide::left : BodySide::right;
}

/// Weight goes to one foot, so that the other can be brought home.
void Standing::shift_on(const Senses& senses, const View& view, double) {
  const double time_s = senses.time_s;
  const double span = time_s - shift_since_s_;
  if (must_step(view, time_s) && beyond(view.outer, view.icp) > 0.0) {
    phase_ = Phase::stand;
    return;
  }
  if (span > s(1.5)) {
    phase_ = Phase::stand;
    closings_ = 2;
    return;
  }
  const auto corners = leg(shift_to_).sole_corners(senses, 0.0);
  const double outside = beyond(convex_hull({corners.begin(), corners.end()}), view.icp);
  const double brave = m(0.03) + m_s(0.3) * (span - s(0.2));
  const bool wide = (view.sole[0] - view.sole[1]).norm() > m(0.25);
  if (outside < (wide ? brave : m(-0.01) + std::max(0.0, brave - m(0.03))) && view.velocity.norm() < m_s(0.6))
    lift(senses, view, other(shift_to_), true);
}

void Standing::lift(const Senses& senses, const View& view, BodySide side, bool closing) {
  swing_ = {};
  swing_.side = side;
  swing_.closing = closing;
  swing_.lift_s = senses.time_s;
  swing_.from = senses.pose[ukemi::index(leg(side).foot)].translation;
  swing_.from_foot = senses.pose[ukemi::index(leg(side).foot)].rotation;
  swing_.from_sole = view.sole[ukemi::index(side)];
  points_[ukemi::index(side)] = 0.0;
  swing_.to = swing_.from_sole;
  swing_.span_s = closing ? s(0.30) : swing_span(view, side);
  phase_ = Phase::swing;
  ready_s_ = hanging_s_ = 0.0;
  landing_offset_ = Vec2::Zero();
  (closing ? closings_ : steps_in_a_row_) += 1;
  if (!closing) closings_ = 0;
  steps_.push_back({leg(side).foot, senses.time_s, std::nullopt, 0.0});
}

/// How much farther a foot in the air has to go than its way has, m.
double Standing::lag(const Senses& senses) const {
  const Vec3 target = swing_target();
  const Vec3& ankle = senses.pose[ukemi::index(leg(swing_.side).foot)].translation;
  return on_ground(target - ankle).norm() - on_ground(target - swing_ankle(senses.time_s)).norm();
}

void Standing::swing_on(const Senses& senses, const View& view, double h) {
  swing_.lift_s += h * std::clamp((lag(senses) - m(kLags)) / m(kLagsFarther), 0.0, kMostWait);
  const double phase = (senses.time_s - swing_.lift_s) / swing_.span_s;
  if (phase < 0.85) {
    const double left = std::max(0.0, swing_.lift_s + swing_.span_s - senses.time_s);
    swing_.to = swing_.closing ? closing_place(view, swing_.side) : landing_place(view, swing_.side, left);
    const double back = std::clamp(view.yaw, -0.5, 0.5);
    swing_.to_yaw = view.yaw - back;
  }
  const bool touches = leg(swing_.side).touches(senses);
  swing_.in_air = swing_.in_air || !touches;
  // Legs that lean on one another may hold a foot just over the ground.
  const bool hovers = phase > 1.0 && leg(swing_.side).lowest_corner(senses) < m(kHovers);
  if (hovers || (touches && phase > (swing_.in_air ? 0.5 : 0.95))) land(senses, view);
}

void Standing::land(const Senses& senses, const View& view) {
  StepTaken& step = steps_.back();
  step.contact_s = senses.time_s;
  step.length_m = (view.sole[ukemi::index(swing_.side)] - swing_.from_sole).norm();
  landed_s_[ukemi::index(swing_.side)] = senses.time_s;
  phase_ = Phase::stand;
  const View now = view_of(senses);
  std::vector<Vec2> deep;
  for (const BodySide side : kSides) {
    const auto corners = leg(side).sole_corners(senses, m(0.04));
    deep.insert(deep.end(), corners.begin(), corners.end());
  }
  landing_offset_ = into(convex_hull(std::move(deep)), now.icp) - now.reference;
}

/// A foot that hangs in the air or on its toe while the body is meant to stand.
std::optional<BodySide> Standing::hanging_foot(const Senses& senses) const {
  for (const BodySide side : kSides) {
    const double ankle = senses.pose[ukemi::index(leg(side).foot)].translation.y();
    if (ankle > leg(side).home_ankle_m + m(0.025)) return side;
  }
  return std::nullopt;
}

bool Standing::stance_is_fine(const View& view) const {
  const Vec2 apart = view.sole[1] - view.sole[0];
  const Vec2 home = home_sole_[1] - home_sole_[0];
  const Vec2 now(apart.dot(view.forward), apart.dot(view.right));
  if ((now - home).norm() < m(0.08)) return true;
  // As people stand, or as wide and staggered as at home.
  const double widest = std::max(m(0.33), home.y() + m(0.08));
  const double longest = std::max(m(0.30), std::abs(home.x()) + m(0.08));
  return now.y() > m(0.12) && now.y() < widest && std::abs(now.x()) < longest;
}

BodySide Standing::stepping_foot(const View& view) const {
  if (settings_.first_foot && steps_.empty()) return *settings_.first_foot;
  return cost_of(view, BodySide::left) < cost_of(view, BodySide::right) ? BodySide::left : BodySide::right;
}

double Standing::cost_of(const View& view, BodySide swing) const {
  const int standing = ukemi::index(other(swing));
  const Vec2 place = landing_place(view, swing, s(settings_.swing_s));
  const double own = sign(swing);
  // The swinging foot does not cross the standing one.
  const double across = std::max(0.0, -own * view.right_part(view.icp - view.sole[standing]));
  const double too_far = std::max(0.0, (place - view.sole[standing]).norm() - 0.95 * physique_.leg_length_m);
  const double travel = (place - view.sole[ukemi::index(swing)]).norm();
  const double again = view.time_s - landed_s_[ukemi::index(swing)] < s(0.3) ? m(kAgain) : 0.0;
  return 5.0 * (across + too_far) + (place - view.sole[standing]).norm() + 0.3 * travel + again +
         (swing == BodySide::left ? m(settings_.foot_bias_m) : 0.0);
}

double Standing::swing_span(const View& view, BodySide swing) const {
  const Vec2 from_standing = view.icp - view.sole[ukemi::index(other(swing))];
  const double hurry = std::max(0.0, from_standing.norm() / physique_.size - 0.10 - 0.08);
  const double span = s(std::clamp(settings_.swing_s - 0.6 * hurry, kFastest_s, settings_.swing_s));
  // No leg swings faster: a foot that comes from behind has a long way.
  const double travel = (landing_place(view, swing, s(0.3)) - view.sole[ukemi::index(swing)]).norm();
  return std::clamp(travel / m_s(kSwing_m_s), span, std::max(span, s(kLongestSwing_s)));
}

Vec2 Standing::landing_place(const View& view, BodySide swing, double time_left) const {
  const Vec2& sole = view.sole[ukemi::index(other(swing))];
  const double own = sign(swing);
  const double rate = view.rate;
  const Vec2 p = into(view.inner, view.icp);
  const Vec2 icp = p + (view.icp - p) * std::exp(rate * time_left);
  const double speed = view.velocity.norm();
  Vec2 way =
      0.855 * settings_.step_scale * (icp - sole) + m(0.04) * view.velocity / std::max(speed, m_s(0.4));
  const double ahead = way.dot(view.forward);
  double aside = own * view.right_part(way);
  const double plain = aside;
  aside = std::max(aside + 0.5 * m(0.083), m(0.11));
  if (std::abs(ahead) > std::abs(plain)) aside = std::min(aside, m(settings_.narrow_m));
  way = ahead * view.forward + own * aside * view.right;
  const double longest = kLongestStep * physique_.leg_length_m;
  if (way.norm() > longest) way *= longest / way.norm();
  return sole + way;
}

/// Beside the standing foot as at home.
Vec2 Standing::closing_place(const View& view, BodySide swing) const {
  const int own = ukemi::index(swing);
  const int standing = ukemi::index(other(swing));
  const Vec2 apart = home_sole_[own] - home_sole_[standing];
  return view.sole[standing] + apart.x() * view.forward + apart.y() * view.right;
}

void Standing::watch(const Senses& senses, const View& view, double h) {
  const double speed = view.velocity.norm();
  const bool calm = phase_ == Phase::stand && speed < m_s(0.05) && !must_step(view, senses.time_s) &&
                    (stance_is_fine(view) || closings_ >= 2 || settings_.most_steps == 0) &&
                    !hanging_foot(senses);
  calm_s_ = calm ? calm_s_ + h : 0.0;
  if (calm_s_ > s(0.3)) {
    steps_in_a_row_ = 0;
    closings_ = 0;
  }
  if (lost_s() || active(senses.time_s) <= 0.0) return;
  const double reach = settings_.most_steps == 0
                           ? m(0.25)
                           : (under_way_ ? kOutOfStride : kOutOfReach) * physique_.leg_length_m;
  const double tilt = (senses.pose[0].rotation * home_[0].rotation.conjugate() * Vec3::UnitY()).y();
  // A long robe touches the ground beside feet that stand, and so does a shank above its ankle in a lunge.
  const auto bears = [&](const SegmentContact& c) {
    if (c.with != SegmentContact::With::floor) return false;
    for (const Leg& l : legs_) {
      if (c.segment == l.foot) return false;
      const Vec3& knee = senses.pose[ukemi::index(l.shank)].translation;
      const Vec3& ankle = senses.pose[ukemi::index(l.foot)].translation;
      if (c.segment == l.shank && (c.place - ankle).norm() < (c.place - knee).norm()) return false;
    }
    return true;
  };
  const bool touches = senses.com.y() < kSinking * home_height_ &&
                       std::any_of(senses.contacts.begin(), senses.contacts.end(), bears);
  const bool gives_in = settings_.gives_in_s && senses.time_s >= s(*settings_.gives_in_s);
  const char* why = gives_in                                ? "gives in"
                    : beyond(view.outer, view.icp) > reach  ? "icp"
                    : senses.com.y() < kSunk * home_height_ ? "low"
                    : tilt < 0.5                            ? "tilt"
                    : touches                               ? "touch"
                                                            : nullptr;
  if (why != nullptr) lose(senses.time_s, why);
}

// ---- what is asked of the muscles

void Standing::update_slow_state(const Senses& senses, const View& view, double h) {
  for (const BodySide side : kSides) {
    const Vec3& ankle = senses.pose[ukemi::index(leg(side).foot)].translation;
    Vec3& planted = planted_[ukemi::index(side)];
    const bool settling = senses.time_s < landed_s_[ukemi::index(side)] + s(kSettle_s);
    double& bearing = bearing_[ukemi::index(side)];
    bearing += std::min(1.0, h / s(kBearing_s)) * ((leg(side).touches(senses) ? 1.0 : 0.0) - bearing);
    if (settling || (ankle - planted).norm() > m(kSlipped)) planted = ankle;
  }
  const double time_s = senses.time_s;
  const double since = time_s - std::max(landed_s_[0], landed_s_[1]);
  const double home = std::min(legs_[0].home_straightness, legs_[1].home_straightness);
  const double bent = std::min(home, 0.967);
  double wanted = home;
  if (phase_ == Phase::shift)
    wanted = std::min(home, 0.985);
  else if (phase_ == Phase::swing || since < s(0.2))
    wanted = bent;
  else if (since < s(0.6))
    wanted = bent + (home - bent) * (since - s(0.2)) / s(0.4);
  straightness_ += std::min(1.0, h / s(0.05)) * (wanted - straightness_);
  heel_ += std::min(1.0, h / s(0.05)) * ((phase_ == Phase::shift ? 0.0 : 1.0) - heel_);
  landing_offset_ *= std::exp(-h / s(0.22));
  const double unsteady = std::clamp(0.3 + beyond(view.outer, view.icp) / m(0.1), 0.0, 1.0) * active(time_s);
  const double span = unsteady > arms_up_ ? 0.12 : 0.28;
  arms_up_ += std::min(1.0, h / s(span)) * (unsteady - arms_up_);
}

Vec2 Standing::wanted_pressure(const View& view) const {
  const bool inside = beyond(view.outer, view.icp) < m(-0.01);
  const bool calming = phase_ == Phase::stand && !steps_.empty() && inside;
  Vec2 p = into(view.inner, view.icp + (calming ? kCalmPush : kPush) * (view.icp - view.reference));
  const double lateral = view.right_part(view.icp - view.middle);
  if (phase_ == Phase::stand && settings_.most_steps > 0 && must_step(view, view.time_s) &&
      std::abs(lateral) < m(0.06)) {
    // The foot that is going to swing pushes the body over the other.
    const Vec2& sole = view.sole[ukemi::index(stepping_foot(view))];
    p = into(view.inner, p + view.right_part(sole - p) * view.right);
  }
  const double b = active(view.time_s);
  return b * p + (1.0 - b) * start_com_;
}

/// Wanted of the pelvis. Feet that stay leave the hips: the trunk goes after the fall, which pushes the body
/// back.
Quat Standing::attitude_of(const View& view) const {
  const Quat upright = Quat(Eigen::AngleAxisd(view.yaw, Vec3::UnitY())) * home_[0].rotation;
  if (settings_.most_steps > 0) return upright;
  const Vec2 out = view.icp - into(view.inner, view.icp);
  const double lean = std::min(kHipLean / physique_.size * out.norm(), kMostLean) * active(view.time_s);
  if (lean < 1e-6) return upright;
  return Quat(Eigen::AngleAxisd(lean, Vec3(out.y(), 0.0, -out.x()).normalized())) * upright;
}

/// Height of the pelvis that the legs can hold.
double Standing::pelvis_height(const Senses& senses, const View& view) const {
  double height = home_[0].translation.y();
  const Quat attitude = attitude_of(view);
  const double right = view.stands[0] && view.stands[1]
                           ? std::clamp((view.com - view.sole[0]).dot(view.sole[1] - view.sole[0]) /
                                            std::max((view.sole[1] - view.sole[0]).squaredNorm(), 1e-6),
                                        0.0, 1.0)
                           : (view.stands[1] ? 1.0 : 0.0);
  for (const BodySide side : kSides) {
    const int i = ukemi::index(side);
    if (!view.stands[i]) continue;
    const double load = side == BodySide::right ? right : 1.0 - right;
    const double rise = heel_ * std::clamp((0.5 - load) / 0.1, 0.0, 1.0);
    const double reach = (straightness_ + rise * (kHeel - straightness_)) * leg(side).length_m();
    const Vec3 hip = attitude * leg(side).hip_in_pelvis;
    const Vec3 ankle = standing_ankle(senses, side);
    const double aside = (on_ground(senses.pose[0].translation + hip) - on_ground(ankle)).norm();
    const double up = std::sqrt(std::max(reach * reach - aside * aside, 0.25 * reach * reach));
    height = std::min(height, ankle.y() + up - hip.y());
  }
  // The foot in the air must reach its place.
  if (phase_ == Phase::swing && view.time_s > swing_.lift_s + 0.5 * swing_.span_s) {
    const Leg& l = leg(swing_.side);
    const Vec3 hip = attitude * l.hip_in_pelvis;
    const double aside = (on_ground(senses.pose[0].translation + hip) - swing_.to).norm();
    const double reach = 0.985 * l.length_m();
    height = std::min(
        height,
        l.home_ankle_m + std::sqrt(std::max(reach * reach - aside * aside, 0.25 * reach * reach)) - hip.y());
  }
  return height;
}

Standing::Wrench Standing::wrench_of(const Senses& senses, const View& view) const {
  const double b = active(view.time_s);
  const double mass = physique_.mass_kg;
  const double strength = physique_.strength * settings_.strength;
  Wrench wrench;
  const Vec2 p = wanted_pressure(view);
  const double height = home_height_ - (home_[0].translation.y() - pelvis_height(senses, view));
  const double lift = kLift / physique_.size * (height - senses.com.y()) -
                      kLiftDamping / physique_.tempo * senses.com_velocity.y();
  const double up = mass * std::clamp(physique_.gravity + b * lift, 0.4 * physique_.weight_m_s2(),
                                      1.7 * physique_.weight_m_s2());
  const Quat upright = attitude_of(view);
  const Vec3 lean = log_rotation(senses.pose[0].rotation * upright.conjugate());
  Vec3 moment = b * strength * (-kUpright * lean - kUprightDamping * senses.angular_velocity[0]);
  const double most = kMostUpright * strength;
  moment = moment.cwiseMax(-most).cwiseMin(most);
  Vec2 along = up * (view.com - p) / view.height + Vec2(moment.z(), -moment.x()) / view.height;
  if (along.norm() > 0.6 * up) along *= 0.6 * up / along.norm();
  wrench.force = at_height(along, up);
  if (!view.stands[0] || !view.stands[1]) {
    const int standing = view.stands[0] ? 0 : 1;
    wrench.share = {standing == 0 ? 1.0 : 0.0, standing == 1 ? 1.0 : 0.0};
    wrench.pressure[standing] = p;
    return wrench;
  }
  const Vec2 apart = view.sole[1] - view.sole[0];
  const double right =
      std::clamp((p - view.sole[0]).dot(apart) / std::max(apart.squaredNorm(), 1e-6), 0.06, 0.94);
  wrench.share = {1.0 - right, right};
  const Vec2 rest = p - (view.sole[0] + right * apart);
  for (const BodySide side : kSides) {
    const auto corners = leg(side).sole_corners(senses, 0.0);
    wrench.pressure[ukemi::index(side)] =
        into(convex_hull({corners.begin(), corners.end()}), view.sole[ukemi::index(side)] + rest);
  }
  return wrench;
}

/// Where the ankle of a standing leg belongs: a foot without load that drifts goes back to its place.
Vec3 Standing::standing_ankle(const Senses& senses, BodySide side) const {
  const Vec3& now = senses.pose[ukemi::index(leg(side).foot)].translation;
  const Vec3& planted = planted_[ukemi::index(side)];
  return leg(side).touches(senses) ? at_height(on_ground(planted), now.y()) : planted;
}

LegPosture Standing::standing_posture(const Senses& senses, const View& view, BodySide side,
                                      const Vec2& shift) const {
  const Quat attitude = attitude_of(view);
  const Vec3 pelvis = at_height(on_ground(senses.pose[0].translation) + shift, pelvis_y_);
  const Vec3 ankle = standing_ankle(senses, side);
  return leg(side).reach(pelvis + attitude * leg(side).hip_in_pelvis, ankle, view.yaw, leg(side).yaw(senses));
}

/// Of the ankle of a foot in the air, where the foot will be flat on the ground.
Vec3 Standing::swing_target() const {
  const Leg& l = leg(swing_.side);
  const Quat foot = Quat(Eigen::AngleAxisd(swing_.to_yaw, Vec3::UnitY())) * l.home_foot;
  return at_height(swing_.to, 0.0) - foot * l.sole_middle;
}

Vec3 Standing::swing_ankle(double time_s) const {
  const Leg& leg_in_air = leg(swing_.side);
  const double phase = (time_s - swing_.lift_s) / swing_.span_s;
  const Vec3 target = swing_target();
  const double along = min_jerk(phase / 0.85);
  const double most = swing_.closing ? 0.05 : 0.09;
  const double top = std::max(swing_.from.y(), leg_in_air.home_ankle_m + m(most));
  const double risen = swing_.from.y() + (top - swing_.from.y()) * min_jerk(phase / 0.55);
  Vec3 at = swing_.from + along * (target - swing_.from);
  const double duration = 0.85 * swing_.span_s;
  const double u = std::clamp(phase / 0.85, 0.0, 1.0);
  const Vec3 carried = duration * u * (1.0 + u * u * (-6.0 + u * (8.0 - 3.0 * u))) * swing_.from_velocity;
  at += carried;
  const bool high = swing_.from.y() > leg_in_air.home_ankle_m + m(kHigh);
  const double sinks_from = high ? 0.0 : 0.55;
  at.y() = carried.y() + risen + (target.y() - risen) * min_jerk((phase - sinks_from) / (1.0 - sinks_from)) -
           m_s(0.5) * std::max(0.0, time_s - swing_.lift_s - swing_.span_s);
  if (!under_way_) return at;
  // The toes of a foot that swings through have not come level yet: they clear the ground too.
  const Quat foot = Quat(Eigen::AngleAxisd(swing_.to_yaw, Vec3::UnitY())) * leg_in_air.home_foot;
  const Quat turned = swing_foot(phase, foot);
  double lowest = 0.0;
  for (const Vec3& corner : leg_in_air.sole) lowest = std::min(lowest, (turned * corner).y());
  const double clear = m(kToesClear) * (1.0 - min_jerk((phase - 0.6) / 0.3));
  if (phase < kSwungUntil) at.y() = std::max(at.y(), min_jerk(phase / 0.15) * (clear - lowest));
  return at;
}

/// Orientation of the foot in the air, on its way to `level`.
Quat Standing::swing_foot(double phase, const Quat& level) const {
  return swing_.from_foot.slerp(min_jerk(phase / (under_way_ ? kSwungThroughLevelBy : kLevelBy)), level);
}

LegPosture Standing::swinging_posture(const Vec3& hip_at, double time_s) const {
  LegPosture posture = leg(swing_.side).reach(hip_at, swing_ankle(time_s), swing_.to_yaw, swing_.to_yaw);
  posture.foot = swing_foot((time_s - swing_.lift_s) / swing_.span_s, posture.foot);
  return posture;
}

void Standing::ask_joint(Joint joint, const Drive& drive) {
  ukemi::ask_joint(physique_, settings_.strength, joint, drive, asked_);
}

void Standing::ask_standing_leg(const Senses& senses, const View& view, const Wrench& wrench, BodySide side) {
  const Leg& l = leg(side);
  const int i = ukemi::index(side);
  const double b = active(view.time_s);
  const Vec2 moved = kAhead_s * view.velocity;
  Vec2 shove = Vec2::Zero();
  if (view.stands[0] && view.stands[1]) {
    // Two straight legs share the load by their geometry alone: the far one is asked to be longer.
    const bool shifting = phase_ == Phase::shift;
    shove = b * (shifting ? 1.2 : 0.25) * (view.com - wanted_pressure(view));
    const double most = m(shifting ? 0.15 : 0.06);
    if (shove.norm() > most) shove *= most / shove.norm();
  }
  const LegPosture now = standing_posture(senses, view, side, shove);
  const LegPosture next = standing_posture(senses, view, side, shove + moved);
  const Quat attitude = attitude_of(view);
  const double soft = 1.0 - 0.5 * (1.0 - std::clamp(2.0 * wrench.share[i], 0.15, 1.0));
  const std::array<Joint, 3> joints = {l.hip, l.knee, l.ankle};
  const std::array<Segment, 4> chain = {Segment::pelvis, l.thigh, l.shank, l.foot};
  const std::array<Quat, 4> goal = {attitude, now.thigh, now.shank, now.foot};
  const std::array<Quat, 4> soon = {attitude, next.thigh, next.shank, next.foot};
  const std::array<double, 3> share = {0.76 * soft, 0.76 * soft, 0.25 * soft};
  const double bearing = under_way_ ? 1.0 : bearing_[i];  // a gait rolls over its feet
  for (int k = 0; k < 3; ++k) {
    const Vec3 at = joint_at(senses, joints[k]);
    const Vec3 arm = at_height(wrench.pressure[i], 0.0) - at;
    const Vec3 carried =
        -(arm.cross(bearing * wrench.share[i] * wrench.force) + physique_.weight_torque(senses, joints[k]));
    const Quat relative = goal[k].conjugate() * goal[k + 1];
    const Quat later = soon[k].conjugate() * soon[k + 1];
    const Quat& parent = senses.pose[ukemi::index(chain[k])].rotation;
    const Quat home =
        home_[ukemi::index(chain[k])].rotation.conjugate() * home_[ukemi::index(chain[k + 1])].rotation;
    const Vec3 omega = b * (parent * log_rotation(later * relative.conjugate())) / kAhead_s;
    ask_joint(joints[k], {taken_over(senses, joints[k], home.slerp(b, relative), 0.0, 0.15), omega, carried,
                          share[k], s(kDamping_s)});
  }
}

void Standing::ask_swinging_leg(const Senses& senses) {
  const Leg& l = leg(swing_.side);
  const Vec3 hip = joint_at(senses, l.hip);
  const Vec3 hip_velocity = senses.velocity[0] + senses.angular_velocity[0].cross(hip - senses.centre[0]);
  const LegPosture now = swinging_posture(hip, senses.time_s);
  const LegPosture next = swinging_posture(hip + kAhead_s * hip_velocity, senses.time_s + kAhead_s);
  ukemi::ask_swinging_leg(physique_, settings_.strength, l, senses, now, next, asked_);
}

void Standing::ask_upper_body(const Senses& senses) {
  for (int j = 0; j <= ukemi::index(Joint::wrist_r); ++j) {
    const Joint joint = ukemi::joint_at(j);
    const BodySide side = is_left(joint) ? BodySide::left : BodySide::right;
    const bool arm = is_left(joint) || is_right(joint);
    Vec3 turn = flinch_.turn(joint, senses.time_s);
    const double a = 0.5 * arms_up_ * settings_.arm_size[ukemi::index(side)];
    if (joint == Joint::shoulder_l || joint == Joint::shoulder_r) turn += Vec3(-sign(side) * a, 0.0, 0.5 * a);
    if (joint == Joint::elbow_l || joint == Joint::elbow_r) turn += Vec3(0.0, 0.0, 0.8 * a);
    if (arm && !settings_.arms_free[ukemi::index(side)]) turn = Vec3::Zero();
    const Quat home = home_[ukemi::index(parent_of(joint))].rotation.conjugate() *
                      home_[ukemi::index(child_of(joint))].rotation;
    ask_joint(joint, {taken_over(senses, joint, exp_rotation(turn) * home, 0.1, 0.5), Vec3::Zero(),
                      -physique_.weight_torque(senses, joint), arm ? 0.35 : 0.5, s(kDamping_s)});
  }
}

/// What takes the capture point back to the feet, or what pushes a body over that would stand.
Vec3 Standing::help_of(const View& view) const {
  const Help& help = settings_.help;
  if (help.most_n <= 0.0 || lost_s()) return Vec3::Zero();
  if (help.down) return at_height(help.most_n * on_ground(settings_.flinch.way).normalized(), 0.0);
  const Vec2 back = into(view.inner, view.icp) - view.icp;
  Vec2 force = kHelp * physique_.mass_kg * view.rate * view.rate * back;
  if (force.norm() > help.most_n) force *= help.most_n / force.norm();
  return at_height(force, 0.0);
}

void Standing::ask(const Senses& senses, const View& view) {
  asked_.clear();
  asked_.help_n = help_of(view);
  asked_.firm_soles = true;
  pelvis_y_ = pelvis_height(senses, view);
  const Wrench wrench = wrench_of(senses, view);
  for (const BodySide side : kSides) {
    if (view.stands[ukemi::index(side)])
      ask_standing_leg(senses, view, wrench, side);
    else
      ask_swinging_leg(senses);
  }
  ask_upper_body(senses);
}

}  // namespace ukemi
