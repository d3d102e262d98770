#include "behave/stride.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "body/centre_of_mass.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

double env(const char* name, double value) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : value;
}

const double kPush = env("PUSH", 2.0);          // pressure beyond that of the gait, per metre of the capture point
const double kLift = env("LIFT", 75.0), kLiftDamping = env("LIFTD", 14.0);
const double kUpright = env("UP", 544.0), kUprightDamping = env("UPD", 30.0), kMostUpright = env("UPM", 150.0);
const double kMostLoad = env("LOAD", 3.2), kLeastLoad = 0.2;      // of the weight
const double kCatch = env("CATCH", 1.12);
const double kCatchFlight = env("CATCHF", 0.6);
const double kFollow = env("FOLLOW", 8.0), kClear = env("CLEAR", 0.05), kFast = env("FAST", 1.66), kAside = env("ASIDE", 0.09), kIcp = env("ICP", 0.9), kShare = env("SHARE", 0.49), kComing = env("COMING", 0.2), kMostSunk = env("SUNK", 0.15), kAnkle = env("ANKLE", 1.0), kKnee = env("KNEE", 1.1), kSoft = env("SOFT", 1.0), kHurry = env("HURRY", 0.42), kHurryFrom = env("HFROM", 0.1);
const double kStanding = env("SST", 0.6), kSwing = env("SSW", 2.0), kUpper = env("SUP", 1.0), kArm = env("SARM", 0.7);

constexpr double kStiffness[] = {220.0, 160.0, 40.0,  70.0,  70.0,  60.0,  12.0,  70.0, 70.0,
                                 60.0,  12.0,  230.0, 230.0, 150.0, 230.0, 230.0, 150.0};
constexpr double kFullAt = 0.35;
constexpr double kEccentric = 1.2;
constexpr double kDamping_s = 0.12, kSwingDamping_s = 0.10;
constexpr double kAhead_s = 0.004;
const double kSunk = env("LOW", 0.6);

}  // namespace

struct Striding::View {
  BodyPose gait, soon;  // now, and after kAhead_s
  Vec2 com, velocity, icp;
  Vec3 com_now;
  double height = 1.0, rate = 3.0;
  PerSide<Vec2> sole;
  PerSide<Quat> foot;       // orientation
  std::vector<Vec2> outer;  // of the soles that stand
  Vec2 error = Vec2::Zero();        // of the capture point from where the gait has it over the standing foot
  Vec2 speed_error = Vec2::Zero();
  Vec2 gait_pressure = Vec2::Zero();  // from the gait's own soles' middle
  Vec2 anchor = Vec2::Zero(), gait_anchor = Vec2::Zero();  // standing soles, here and in the gait
  int standing = 0;
  Vec2 pressure = Vec2::Zero();
  Vec3 force = Vec3::Zero();
  PerSide<double> share{0.5, 0.5};
};

Striding::Striding(const ArticulatedBody& body, const BodyPose& home, const MuscleStrength& strength,
                   double gravity, const StandSettings& settings, std::shared_ptr<const Gait> gait)
    : body_(&body),
      home_(home),
      settings_(settings),
      physique_(body, Leg(body, home, BodySide::left).length_m(), gravity),
      legs_{Leg(body, home, BodySide::left), Leg(body, home, BodySide::right)},
      gait_(std::move(gait)),
      flinch_(settings.flinch, yaw_of(home[0].rotation * Vec3::UnitX())),
      home_height_(centre_of_mass(body, home).y()) {
  for (const BodySide side : kSides) {
    ankle_n_m_[ukemi::index(side)] = -strength[ukemi::index(leg(side).ankle)].least_n_m.z();
    knee_n_m_[ukemi::index(side)] = strength[ukemi::index(leg(side).knee)].most_n_m.z();
  }
}

std::optional<BodySide> Striding::swinging() const {
  if (stops_) return stops_->swinging();
  if (!feet_[0].stands) return BodySide::left;
  if (!feet_[1].stands) return BodySide::right;
  return std::nullopt;
}

std::optional<Stand> Striding::stand_of(BodySide side) const {
  const auto& stands = gait_->stands(side);
  return foot(side).stand < stands.size() ? std::optional(stands[foot(side).stand]) : std::nullopt;
}

void Striding::start(const Senses& senses) {
  for (const BodySide side : kSides) {
    Foot& f = feet_[ukemi::index(side)];
    const auto& stands = gait_->stands(side);
    while (f.stand < stands.size() && stands[f.stand].until_s <= 0.0) ++f.stand;
    f.stands = f.stand < stands.size() && stands[f.stand].from_s <= 0.0;
    f.in_air = !f.stands;
    f.bears = leg(side).touches(senses) ? 1.0 : 0.0;
    f.planted = senses.pose[ukemi::index(leg(side).foot)].translation;
    if (!f.stands) steps_.push_back({leg(side).foot, 0.0, std::nullopt, 0.0});
  }
  if (must_stop(view_of(senses))) return stop(senses);
  ask(senses);
}

Striding::View Striding::view_of(const Senses& senses) const {
  View view;
  view.gait = gait_->pose(phase_s_);
  view.soon = gait_->pose(phase_s_ + pace_ * kAhead_s);
  view.com_now = senses.com;
  view.com = on_ground(senses.com);
  view.velocity = on_ground(senses.com_velocity);
  view.height = std::max(senses.com.y(), 0.1);
  view.rate = std::sqrt(std::max(physique_.gravity, 0.1) / view.height);
  view.icp = view.com + view.velocity / view.rate;
  const Vec2 gait_com = on_ground(gait_->com(phase_s_));
  const Vec2 gait_velocity = on_ground(gait_->velocity(phase_s_));
  const double gait_rate = std::sqrt(std::max(physique_.gravity, 0.1) / gait_->com(phase_s_).y());
  const Vec2 gait_icp = gait_com + gait_velocity / gait_rate;
  view.speed_error = view.velocity - gait_velocity;
  std::vector<Vec2> outer;
  for (const BodySide side : kSides) {
    const int i = ukemi::index(side);
    view.sole[i] = leg(side).sole_at(senses);
    view.foot[i] = senses.pose[ukemi::index(leg(side).foot)].rotation;
    if (!foot(side).stands) continue;
    ++view.standing;
    view.anchor += view.sole[i];
    view.gait_anchor += stand_of(side) ? stand_of(side)->sole
                                       : on_ground(view.gait[ukemi::index(leg(side).foot)] * leg(side).sole_middle);
    const auto corners = leg(side).sole_corners(senses, 0.0);
    outer.insert(outer.end(), corners.begin(), corners.end());
  }
  if (view.standing > 0) {
    view.anchor /= view.standing;
    view.gait_anchor /= view.standing;
    view.error = (view.icp - view.anchor) - (gait_icp - view.gait_anchor);
    view.outer = convex_hull(std::move(outer));
    const Vec3 a = gait_->acceleration(phase_s_);
    const double up = std::max(physique_.gravity + a.y(), 0.3 * physique_.gravity);
    view.gait_pressure = gait_com - on_ground(a) * gait_->com(phase_s_).y() / up - view.gait_anchor;
    view.pressure = into(view.outer, into(view.outer, view.anchor + view.gait_pressure) + kPush * view.error);
  } else {
    view.anchor = view.com;
    view.gait_anchor = gait_com;
    view.error = view.speed_error / view.rate;
  }
  // The force of the ground.
  const double lift = kLift / physique_.size * (gait_->com(phase_s_).y() - sunk_m_ - senses.com.y()) +
                      kLiftDamping / physique_.tempo * (gait_->velocity(phase_s_).y() - senses.com_velocity.y());
  const double up = physique_.mass_kg * std::clamp(physique_.gravity + gait_->acceleration(phase_s_).y() + lift,
                                                   kLeastLoad * physique_.gravity, kMostLoad * physique_.gravity);
  const double strength = physique_.strength * settings_.strength;
  const Vec3 lean = log_rotation(senses.pose[0].rotation * view.gait[0].rotation.conjugate());
  const Vec3 turning = log_rotation(view.soon[0].rotation * view.gait[0].rotation.conjugate()) / kAhead_s;
  Vec3 moment = strength * (-kUpright * lean - kUprightDamping * (senses.angular_velocity[0] - turning));
  const double most = kMostUpright * strength;
  moment = moment.cwiseMax(-most).cwiseMin(most);
  if (view.standing == 1) {
    // No farther from the ankle than it can push.
    const BodySide side = foot(BodySide::left).stands ? BodySide::left : BodySide::right;
    const Vec2 ankle = on_ground(senses.pose[ukemi::index(leg(side).foot)].translation);
    const double longest = kAnkle * ankle_n_m_[ukemi::index(side)] / std::max(up, 1.0);
    // So far forward that the knee can bear it.
    const Vec3 knee = joint_at(senses, leg(side).knee);
    const Vec2 ahead = on_ground(senses.pose[ukemi::index(leg(side).foot)].rotation * Vec3::UnitX()).normalized();
    const Vec2 force = up * (view.com - view.pressure) / view.height;
    const double knee_n_m = up * (on_ground(knee) - view.pressure).dot(ahead) + force.dot(ahead) * (0.0 - knee.y()) * -1.0;
    const double too_much = knee_n_m - kKnee * knee_n_m_[ukemi::index(side)];
    if (std::getenv("TORQUE")) std::printf("knee %.0f of %.0f\n", knee_n_m, knee_n_m_[ukemi::index(side)]);
    if (kKnee > 0 && too_much > 0.0) view.pressure = into(view.outer, view.pressure + too_much / up / (1.0 + knee.y() / view.height * 0.0) * ahead);
    const Vec2 lever = view.pressure - ankle;
    if (lever.norm() > longest) view.pressure = ankle + longest / lever.norm() * lever;
  }
  Vec2 along = up * (view.com - view.pressure) / view.height + Vec2(moment.z(), -moment.x()) / view.height;
  if (along.norm() > 0.7 * up) along *= 0.7 * up / along.norm();
  view.force = at_height(along, up);
  if (view.standing == 1) {
    view.share = {foot(BodySide::left).stands ? 1.0 : 0.0, foot(BodySide::right).stands ? 1.0 : 0.0};
  } else if (view.standing == 2) {
    const Vec2 apart = view.sole[1] - view.sole[0];
    const double right = std::clamp(
        (view.pressure - view.sole[0]).dot(apart) / std::max(apart.squaredNorm(), 1e-6), 0.06, 0.94);
    view.share = {1.0 - right, right};
  }
  return view;
}

/// How fast the gait goes on: it waits for a foot that is late, and catches up with one that was early.
double Striding::pace(const Senses& senses) const {
  double pace = 1.0;
  const View view = view_of(senses);
  const Vec2 v = on_ground(gait_->velocity(phase_s_));
  if (view.standing > 0 && v.norm() > m_s(0.3)) {
    const Vec2 gait_com = on_ground(gait_->com(phase_s_));
    const Vec2 ahead = (view.com - view.anchor) - (gait_com - view.gait_anchor);
    pace = std::clamp(1.0 + kFollow * ahead.dot(v) / v.squaredNorm(), 0.6, kFast);
    const double aside = std::abs(view.error.x() * v.y() - view.error.y() * v.x()) / v.norm();
    if (view.standing == 1) pace = std::min(kFast, pace + kHurry * std::max(0.0, aside / physique_.size - kHurryFrom) / 0.2);
  }
  for (const BodySide side : kSides) {
    const auto stand = stand_of(side);
    if (!stand) continue;
    if (!foot(side).stands && phase_s_ > stand->from_s) pace = std::min(pace, 0.25);
    if (foot(side).stands && phase_s_ < stand->from_s) pace = std::max(pace, 1.5);
  }
  (void)senses;
  return pace;
}

void Striding::lift(const Senses& senses, BodySide side) {
  Foot& f = feet_[ukemi::index(side)];
  f.stands = false;
  f.in_air = false;
  f.lifted_s = phase_s_;
  ++f.stand;
  const BodyPose gait = gait_->pose(phase_s_);
  const int foot_index = ukemi::index(leg(side).foot);
  const Vec3 nominal = gait[foot_index].translation - gait_->com(phase_s_);
  const Vec3 actual = senses.pose[foot_index].translation - senses.com;
  f.off = actual - nominal;
  f.off.y() = senses.pose[foot_index].translation.y() - gait[foot_index].translation.y();
  steps_.push_back({leg(side).foot, senses.time_s, std::nullopt, 0.0});
}

void Striding::change_feet(const Senses& senses) {
  for (const BodySide side : kSides) {
    Foot& f = feet_[ukemi::index(side)];
    const auto stand = stand_of(side);
    if (!stand) continue;
    if (f.stands) {
      const Foot& o = foot(other(side));
      const auto theirs = stand_of(other(side));
      const bool carried = (o.stands && o.bears > 0.5) || (!o.stands && theirs && theirs->from_s > stand->until_s);
      if (phase_s_ >= stand->until_s && (carried || phase_s_ > stand->until_s + 0.1)) lift(senses, side);
      continue;
    }
    const bool touches = leg(side).touches(senses);
    f.in_air = f.in_air || !touches;
    const double progress = (phase_s_ - f.lifted_s) / std::max(stand->from_s - f.lifted_s, 0.02);
    const bool there = stand->from_s - phase_s_ < s(0.03) || (leg(side).sole_at(senses) - f.to).norm() < m(0.15);
    if (touches && f.in_air && progress > 0.6 && there) {
      f.stands = true;
      f.landed_s = senses.time_s;
      f.planted = senses.pose[ukemi::index(leg(side).foot)].translation;
      if (std::getenv("STRIDE")) {
        const Vec2 miss = leg(side).sole_at(senses) - f.to;
        std::printf("LAND %d ph %.3f of %.3f miss %.3f %.3f\n", ukemi::index(side), phase_s_, stand->from_s, miss.x(), miss.y());
      }
      for (auto step = steps_.rbegin(); step != steps_.rend(); ++step)
        if (step->foot == leg(side).foot) {
          step->contact_s = senses.time_s;
          break;
        }
    }
  }
}

/// Where the foot is to land so that the capture point lies from it as in the gait.
Vec2 Striding::landing_place(const Senses&, const View& view, BodySide side) const {
  const auto stand = stand_of(side);
  if (!stand) return view.sole[ukemi::index(side)];
  const double left = std::max(0.0, stand->from_s - phase_s_);
  double grounded = 0.0;
  const Foot& o = foot(other(side));
  if (o.stands && stand_of(other(side)))
    grounded = std::max(0.0, stand_of(other(side))->until_s - phase_s_);
  const double flight = std::max(0.0, left - grounded);
  grounded = std::min(grounded, left + kShare * std::max(0.0, grounded - left));
  Vec2 error = view.error;
  if (view.standing > 0) {
    const Vec2 nominal = into(view.outer, view.anchor + view.gait_pressure);
    const Vec2 held = into(view.outer, nominal + view.error) - nominal;
    const Vec2 v = on_ground(gait_->velocity(phase_s_)).normalized();
    static const double gf = env("GROWF", 0.5), gl = env("GROWL", 1.0), most = env("MOSTF", 0.25);
    error = held + (view.error - held) * std::exp(gl * view.rate * grounded);
    const double ahead = held.dot(v) + (view.error - held).dot(v) * std::exp(gf * view.rate * grounded);
    error += (std::clamp(ahead, -m(most), m(most)) - error.dot(v)) * v;
  }
  const bool flies = flight > 0.03;
  error = (flies ? kCatchFlight : kCatch) * error + flight * view.speed_error;
  const Vec2 way = stand->sole - view.gait_anchor;
  Vec2 place = view.anchor + way + error;
  if (o.stands) {
    // It does not cross the standing foot.
    const Vec2 forward = on_ground(gait_->velocity(phase_s_)).normalized();
    const Vec2 out = sign(side) * Vec2(-forward.y(), forward.x());
    const Vec2 standing = view.sole[ukemi::index(other(side))];
    const double aside = (place - standing).dot(out);
    const double least = std::min(way.dot(out), m(kAside));
    if (aside < least) place += (least - aside) * out;
  }
  // Within reach of the hip as it will be then.
  const Vec2 com_then = view.com + left * view.velocity;
  Vec2 from_com = place - com_then;
  const double longest = 0.8 * physique_.leg_length_m;
  if (from_com.norm() > longest) from_com *= longest / from_com.norm();
  return com_then + from_com;
}

Vec3 Striding::swing_ankle(const BodyPose& gait, const View& view, BodySide side, double phase_s) const {
  const Foot& f = foot(side);
  const int i = ukemi::index(leg(side).foot);
  const double later = (phase_s - phase_s_) / std::max(pace_, 0.1);
  const Vec2 com = view.com + later * view.velocity;
  const Vec3 gait_com = gait_->com(phase_s);
  Vec3 ankle = gait[i].translation;
  const auto stand = stand_of(side);
  const double span = stand ? std::max(stand->from_s - f.lifted_s, 0.05) : 0.3;
  const double progress = (phase_s - f.lifted_s) / span;
  const double fading = 1.0 - min_jerk(progress / 0.6);
  Vec2 at = com + on_ground(ankle - gait_com) + fading * on_ground(f.off);
  double y = ankle.y() + fading * f.off.y();
  // Toes of a rigid foot clear the ground.
  double lowest = 0.0;
  for (const Vec3& corner : leg(side).sole)
    lowest = std::min({lowest, (gait[i].rotation * corner).y(), (view.foot[ukemi::index(side)] * corner).y()});
  const double clear = m(kClear) * min_jerk(progress / 0.2) * (1.0 - min_jerk((progress - 0.8) / 0.2));
  y = std::max(y, min_jerk(progress / 0.1) * (clear - lowest));
  if (stand) {
    const double left = std::max(0.0, stand->from_s - phase_s);
    const Vec2 nominal = com + (stand->sole - on_ground(gait_com)) + left * view.speed_error;
    at += min_jerk(progress) * (f.to - nominal);
    y -= m_s(0.5) * f.late_s;
  }
  return at_height(at, y);
}

/// The gait's posture of a leg, changed as much as another way from hip to ankle asks.
LegPosture Striding::posture(const BodyPose& gait, BodySide side, const Vec3& hip, const Vec3& ankle) const {
  const Leg& l = leg(side);
  const Vec3 gait_hip = gait[ukemi::index(l.thigh)].translation;
  const Vec3 gait_ankle = gait[ukemi::index(l.foot)].translation;
  const double yaw = yaw_of(gait[0].rotation * Vec3::UnitX()) - l.home_yaw;
  const LegPosture own = l.reach(gait_hip, gait_ankle, yaw, 0.0);
  const LegPosture wanted = l.reach(hip, ankle, yaw, 0.0);
  return {wanted.thigh * own.thigh.conjugate() * gait[ukemi::index(l.thigh)].rotation,
          wanted.shank * own.shank.conjugate() * gait[ukemi::index(l.shank)].rotation,
          gait[ukemi::index(l.foot)].rotation};
}

void Striding::ask_joint(Joint joint, const Quat& goal, const Vec3& velocity, const Vec3& feed_forward,
                         double share, double damping_s) {
  if (physique_.fused[ukemi::index(joint)]) return;
  JointGoal asked;
  asked.parent_from_child = goal;
  asked.velocity = velocity;
  asked.feed_forward_n_m = feed_forward;
  asked.stiffness_n_m_rad = share * kStiffness[ukemi::index(joint)] * kEccentric * physique_.strength *
                            settings_.strength / kFullAt;
  asked.damping_n_m_s_rad = asked.stiffness_n_m_rad * damping_s;
  asked.least_n_m.setConstant(-1e6);
  asked.most_n_m.setConstant(1e6);
  asked_.joints[ukemi::index(joint)].push_back(asked);
}

void Striding::ask_standing_leg(const Senses& senses, const View& view, BodySide side) {
  const Leg& l = leg(side);
  const int i = ukemi::index(side);
  const auto hip_of = [&](const BodyPose& gait, double later) {
    const Vec2 pelvis = on_ground(senses.pose[0].translation) + later * view.velocity;
    return Vec3(at_height(pelvis, gait[0].translation.y() - sunk_m_) +
                gait[0].rotation * l.hip_in_pelvis);
  };
  Vec3 ankle = senses.pose[ukemi::index(l.foot)].translation;
  if (!l.touches(senses))  // it reaches for the ground
    ankle = at_height(on_ground(foot(side).planted), view.gait[ukemi::index(l.foot)].translation.y() - m(0.01));
  const LegPosture now = posture(view.gait, side, hip_of(view.gait, 0.0), ankle);
  const Vec3 rolls = view.soon[ukemi::index(l.foot)].translation - view.gait[ukemi::index(l.foot)].translation;
  const LegPosture next = posture(view.soon, side, hip_of(view.soon, kAhead_s), ankle + at_height(Vec2::Zero(), rolls.y()));
  const std::array<Joint, 3> joints = {l.hip, l.knee, l.ankle};
  const std::array<Segment, 4> chain = {Segment::pelvis, l.thigh, l.shank, l.foot};
  const std::array<Quat, 4> goal = {view.gait[0].rotation, now.thigh, now.shank, now.foot};
  const std::array<Quat, 4> soon = {view.soon[0].rotation, next.thigh, next.shank, next.foot};
  const double soft = 1.0 - 0.5 * (1.0 - std::clamp(2.0 * view.share[i], 0.15, 1.0));
  const double unloads = 1.0 - kSoft * (1.0 - std::clamp(2.0 * view.share[i], 0.1, 1.0));
  const std::array<double, 3> share = {kStanding * soft, kStanding * soft, 0.33 * kStanding * unloads};
  const auto corners = l.sole_corners(senses, 0.0);
  const Vec2 pressure = into(convex_hull({corners.begin(), corners.end()}), view.pressure);
  const double bears = foot(side).bears;
  for (int k = 0; k < 3; ++k) {
    const Vec3 arm = at_height(pressure, 0.0) - joint_at(senses, joints[k]);
    const Vec3 carried = -(arm.cross(bears * view.share[i] * view.force) + physique_.weight_torque(senses, joints[k]));
    if (std::getenv("TORQUE")) {
      const Quat& par = senses.pose[ukemi::index(chain[k])].rotation;
      const Quat& chi = senses.pose[ukemi::index(chain[k+1])].rotation;
      const Vec3 local = par.conjugate() * carried;
      const Vec3 e = log_rotation((par * goal[k].conjugate() * goal[k+1]) * chi.conjugate());
      std::printf("   T %d %d ff %.0f %.0f %.0f  err %.2f %.2f %.2f up %.2f bears %.2f press %.3f\n", ukemi::index(side), k, local.x(), local.y(), local.z(), e.x(), e.y(), e.z(), view.force.y() / physique_.mass_kg / 9.81, bears, (pressure - on_ground(senses.pose[ukemi::index(l.foot)].translation)).norm());
    }
    const Quat relative = goal[k].conjugate() * goal[k + 1];
    const Quat later = soon[k].conjugate() * soon[k + 1];
    const Quat& parent = senses.pose[ukemi::index(chain[k])].rotation;
    const Vec3 omega = (parent * log_rotation(later * relative.conjugate())) / kAhead_s;
    ask_joint(joints[k], relative, omega, carried, share[k], s(kDamping_s));
  }
}

void Striding::ask_swinging_leg(const Senses& senses, const View& view, BodySide side) {
  const Leg& l = leg(side);
  const Vec3 hip = joint_at(senses, l.hip);
  const Vec3 hip_velocity = senses.velocity[0] + senses.angular_velocity[0].cross(hip - senses.centre[0]);
  const double phase = phase_s_;
  const LegPosture now = posture(view.gait, side, hip, swing_ankle(view.gait, view, side, phase));
  if (std::getenv("SWING")) {
    const Vec3 want = swing_ankle(view.gait, view, side, phase), is = senses.pose[ukemi::index(l.foot)].translation;
    const Vec3 g = view.gait[ukemi::index(l.foot)].translation;
    std::printf("   S %d want %.3f %.3f %.3f is %.3f %.3f %.3f gait %.3f %.3f %.3f hipdist %.3f of %.3f low %.3f\n", ukemi::index(side), want.x(), want.y(), want.z(), is.x(), is.y(), is.z(), g.x(), g.y(), g.z(), (want - hip).norm(), l.length_m(), l.lowest_corner(senses));
  }
  const LegPosture next = posture(view.soon, side, hip + kAhead_s * hip_velocity,
                                  swing_ankle(view.soon, view, side, phase + pace_ * kAhead_s));
  const std::array<Joint, 3> joints = {l.hip, l.knee, l.ankle};
  const std::array<Segment, 3> parents = {Segment::pelvis, l.thigh, l.shank};
  const std::array<Quat, 3> goal = {now.thigh, now.shank, now.foot};
  const std::array<Quat, 3> soon = {next.thigh, next.shank, next.foot};
  const std::array<double, 3> share = {kSwing, kSwing, 0.4 * kSwing};
  for (int k = 0; k < 3; ++k) {
    const int parent = ukemi::index(parents[k]);
    const Vec3 omega =
        log_rotation(soon[k] * goal[k].conjugate()) / kAhead_s - senses.angular_velocity[parent];
    ask_joint(joints[k], senses.pose[parent].rotation.conjugate() * goal[k], omega,
              -physique_.weight_torque(senses, joints[k]), share[k], s(kSwingDamping_s));
  }
}

void Striding::ask_upper_body(const Senses& senses, const View& view) {
  for (int j = 0; j <= ukemi::index(Joint::wrist_r); ++j) {
    const Joint joint = ukemi::joint_at(j);
    const bool arm = is_left(joint) || is_right(joint);
    const int up = ukemi::index(parent_of(joint)), down = ukemi::index(child_of(joint));
    const Quat now = view.gait[up].rotation.conjugate() * view.gait[down].rotation;
    const Quat soon = view.soon[up].rotation.conjugate() * view.soon[down].rotation;
    const Vec3 omega = senses.pose[up].rotation * log_rotation(soon * now.conjugate()) / kAhead_s;
    Vec3 turn = flinch_.turn(joint, senses.time_s);
    const BodySide side = is_left(joint) ? BodySide::left : BodySide::right;
    if (arm && !settings_.arms_free[ukemi::index(side)]) turn = Vec3::Zero();
    ask_joint(joint, exp_rotation(turn) * now, omega, -physique_.weight_torque(senses, joint),
              arm ? kArm : kUpper, s(kDamping_s));
  }
}

void Striding::ask(const Senses& senses) {
  const View view = view_of(senses);
  asked_.clear();
  asked_.firm_soles = true;
  for (const BodySide side : kSides)
    if (!foot(side).stands) feet_[ukemi::index(side)].to = landing_place(senses, view, side);
  for (const BodySide side : kSides) {
    if (foot(side).stands)
      ask_standing_leg(senses, view, side);
    else
      ask_swinging_leg(senses, view, side);
  }
  ask_upper_body(senses, view);
}

/// How far below the gait's the pelvis must be for the legs to reach the ground where their feet are or go.
double Striding::out_of_reach(const Senses& senses, const View& view) const {
  double deepest = 0.0;
  for (const BodySide side : kSides) {
    const Leg& l = leg(side);
    const auto stand = stand_of(side);
    const bool coming = !foot(side).stands && stand && stand->from_s - phase_s_ < s(kComing);
    if (!coming) continue;
    const Vec3 hip = view.gait[0].rotation * l.hip_in_pelvis;
    const double left = std::max(0.0, stand->from_s - phase_s_);
    const double aside = (on_ground(senses.pose[0].translation + hip) + left * view.velocity - foot(side).to).norm();
    const double reach = 0.985 * l.length_m();
    const double up = std::sqrt(std::max(reach * reach - aside * aside, 0.4 * reach * reach));
    const double height = l.home_ankle_m + up - hip.y();
    deepest = std::max(deepest, gait_->pose(stand->from_s)[0].translation.y() - height);
  }
  return std::min(deepest, m(kMostSunk));
}

void Striding::watch(const Senses& senses, const View& view, double h) {
  if (lost_s()) return;
  const double tilt = (senses.pose[0].rotation * view.gait[0].rotation.conjugate() * Vec3::UnitY()).y();
  const bool touches = std::any_of(senses.contacts.begin(), senses.contacts.end(), [](const SegmentContact& c) {
    return c.with == SegmentContact::With::floor && c.segment != Segment::foot_l && c.segment != Segment::foot_r;
  });
  const char* why = senses.com.y() < kSunk * home_height_                        ? "low"
                    : tilt < 0.5                                                 ? "tilt"
                    : touches && senses.com.y() < 0.85 * home_height_            ? "touch"
                    : view.error.norm() > kIcp * physique_.leg_length_m           ? "icp"
                                                                                 : nullptr;
  if (std::getenv("STRIDE"))
    std::printf("%.3f ph %.3f pace %.2f  %d%d tch %d%d  y %.3f/%.3f v %.2f/%.2f err %.3f %.3f  verr %.2f %.2f tilt %.2f\n", senses.time_s, phase_s_, pace_,
                feet_[0].stands, feet_[1].stands, leg(BodySide::left).touches(senses), leg(BodySide::right).touches(senses), senses.com.y(), gait_->com(phase_s_).y(), senses.com_velocity.y(), gait_->velocity(phase_s_).y(), view.error.x(), view.error.y(), view.speed_error.x(), view.speed_error.y(), tilt);
  const bool fine = view.error.norm() < m(0.10) && view.speed_error.norm() < m_s(0.3);
  back_s_ = fine ? back_s_ + h : 0.0;
  if (why != nullptr) lose(senses.time_s, why);
}

std::optional<double> Striding::goes_on_from_s() const {
  static const double least = env("LEAST", 1.2); if (time_s_ > 100) return std::nullopt;
  if (stops_ || lost_s() || back_s_ < 0.6 || time_s_ < least) return std::nullopt;
  return phase_s_;
}

bool Striding::must_stop(const View& view) const {
  static const double late = env("STOP", 9), aside_at = env("STOPA", 0.05), ahead_at = env("STOPF", 0.1);
  const Vec2 v = on_ground(gait_->velocity(phase_s_)).normalized();
  const double ahead = std::abs(view.error.dot(v)), aside = std::abs(view.error.x() * v.y() - view.error.y() * v.x());
  if (time_s_ > s(0.05)) return view.error.norm() > m(late);
  return aside > m(aside_at) || ahead > m(ahead_at);
}

/// Gives the gait up: comes to stand.
void Striding::stop(const Senses& senses) {
  StandSettings settings = settings_;
  if (time_s_ > s(0.13) || !settings.under_way) settings.under_way.emplace();
  for (const BodySide side : kSides) {
    auto& lands = settings.under_way->lands_in_s[ukemi::index(side)];
    if (lands) {
      *lands = std::max(0.0, *lands - time_s_);
      continue;
    }
    const std::size_t next = foot(side).stand + (foot(side).stands ? 1 : 0);
    if (next < gait_->stands(side).size())
      settings.under_way->lands_in_s[ukemi::index(side)] = std::max(0.0, gait_->stands(side)[next].from_s - phase_s_);
  }
  strides_ = steps_.size();
  while (strides_ > 0 && !steps_[strides_ - 1].contact_s) --strides_;  // a foot in the air goes on as a step
  steps_.resize(strides_);
  stops_ = std::make_unique<Standing>(*body_, home_, physique_.gravity, settings);
  stops_->start(senses);
}

void Striding::observe(const Senses& senses, double h) {
  if (stops_) {
    stops_->observe(senses, h);
    steps_.resize(strides_);
    steps_.insert(steps_.end(), stops_->steps().begin(), stops_->steps().end());
    if (stops_->lost_s() && !lost_s()) lose(*stops_->lost_s(), stops_->lost_why().c_str());
    return;
  }
  time_s_ = senses.time_s;
  for (const BodySide side : kSides) {
    Foot& f = feet_[ukemi::index(side)];
    f.bears += std::min(1.0, h / s(0.02)) * ((leg(side).touches(senses) ? 1.0 : 0.0) - f.bears);
    const auto stand = stand_of(side);
    f.late_s = !f.stands && stand && phase_s_ > stand->from_s ? f.late_s + h : 0.0;
    const Vec3& ankle = senses.pose[ukemi::index(leg(side).foot)].translation;
    if (senses.time_s < f.landed_s + s(0.08) || on_ground(ankle - f.planted).norm() > m(0.1)) f.planted = ankle;
  }
  pace_ = pace(senses);
  phase_s_ += pace_ * h;
  if (!lost_s()) change_feet(senses);
  const View view = view_of(senses);
  if (must_stop(view)) return stop(senses);
  sunk_m_ += std::min(1.0, h / s(0.05)) * (out_of_reach(senses, view) - sunk_m_);
  watch(senses, view, h);
  ask(senses);
}

void Striding::drive(Goals& goals) const {
  if (stops_) return stops_->drive(goals);
  for (int j = 0; j < kJointCount; ++j)
    goals.joints[j].insert(goals.joints[j].end(), asked_.joints[j].begin(), asked_.joints[j].end());
  goals.firm_soles = goals.firm_soles || asked_.firm_soles;
}

}  // namespace ukemi
