#include "rise/get_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "base/random.h"
#include "body/weight.h"
#include "rise/figure_motion.h"
#include "rise/get_up_routes.h"
#include "rise/whole_body.h"

namespace ukemi {
namespace {

enum ContactKind { hand, knee, foot, toes, seat };
constexpr int kContacts = 9;  // four parts of two sides, left first, and the seat

int contact_index(ContactKind part, bool left) { return part == seat ? 8 : 2 * part + (left ? 0 : 1); }
ContactKind kind_of(int contact) { return contact == 8 ? seat : static_cast<ContactKind>(contact / 2); }
bool is_left_contact(int contact) { return contact % 2 == 0; }
Segment on_side(Segment left, bool is_left) { return is_left ? left : mirror_of(left); }

Segment segment_of(int contact) {
  switch (kind_of(contact)) {
    case hand:
      return on_side(Segment::hand_l, is_left_contact(contact));
    case knee:
      return on_side(Segment::shank_l, is_left_contact(contact));
    case foot:
    case toes:
      return on_side(Segment::foot_l, is_left_contact(contact));
    case seat:
      break;
  }
  return Segment::pelvis;
}

Quat about(const Vec3& axis, double degrees_) { return exp_rotation(axis * radians(degrees_)); }
const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();

const double kMargin = radians(1.0);    // inside the ranges
constexpr double kClearance_m = 0.012;  // of skin on its way over the floor
constexpr double kInside = 0.02;        // of the height: of the weight, from the corners of its support

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

Vec3 level(const Vec3& v) { return {v.x(), 0.0, v.z()}; }
double yaw_of(const Vec3& direction) { return std::atan2(-direction.z(), direction.x()); }

/// Farthest skin of a segment along `d` (its frame) among points that count; `fallback` where there is none.
template <typename Counts>
double farthest(const std::vector<Vec3>& skin, const Vec3& d, double fallback, const Counts& counts) {
  double far = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : skin)
    if (counts(p)) far = std::max(far, p.dot(d));
  return std::isfinite(far) ? far : fallback;
}

/// Where each part touches, in the frame of its segment.
using ContactPoints = std::array<Vec3, kContacts>;

ContactPoints contact_points(const WholeBody& whole) {
  const double h = whole.body().height_m;
  const auto all = [](const Vec3&) { return true; };
  ContactPoints points;
  for (int c = 0; c < kContacts; ++c) {
    const std::vector<Vec3>& skin = whole.skin()[index(segment_of(c))];
    switch (kind_of(c)) {
      case hand: {
        const Vec3 palm(0.0, 0.0, is_left_contact(c) ? 1.0 : -1.0);
        points[c] = Vec3(0.0, -0.45 * farthest(skin, -kY, 0.1 * h, all), 0.0) +
                    palm * std::min(farthest(skin, palm, 0.015 * h, all), 0.02 * h);
        break;
      }
      case knee:
        points[c] = Vec3(farthest(skin, kX, 0.03 * h, [&](const Vec3& p) { return p.y() > -0.1 * h; }),
                         -0.015 * h, 0.0);
        break;
      case foot:
      case toes:
        points[c] = Vec3(0.62 * farthest(skin, kX, 0.1 * h, all), -farthest(skin, -kY, 0.04 * h, all), 0.0);
        break;
      case seat:
        points[c] = Vec3(-0.01 * h, -farthest(skin, -kY, 0.05 * h, all), 0.0);
        break;
    }
  }
  return points;
}

/// Skin that may touch at each contact.
std::array<OuterSkin, kContacts> contact_skins(const WholeBody& whole) {
  const double h = whole.body().height_m;
  std::array<OuterSkin, kContacts> skins;
  const auto add = [&](int contact, Segment segment, const auto& counts) {
    for (const Vec3& p : whole.skin()[index(segment)])
      if (counts(p)) skins[contact][index(segment)].push_back(p);
  };
  for (int c = 0; c < kContacts; ++c) {
    const Segment own = segment_of(c);
    const double thigh = whole.body().joints[index(Joint::knee_l)].anchor_in_parent.norm();
    const auto upper = [&](const Vec3& p) { return p.y() > -0.25 * thigh; };
    const auto all = [](const Vec3&) { return true; };
    if (kind_of(c) == knee) {
      add(c, own, [&](const Vec3& p) { return p.y() > -0.1 * h; });
      add(c, parent_of(own), [&](const Vec3& p) { return p.y() < -0.75 * thigh; });
    } else {
      add(c, own, all);
    }
    if (kind_of(c) == seat)
      for (const Segment s : {Segment::thigh_l, Segment::thigh_r}) add(c, s, upper);
  }
  return skins;
}

/// Corners on the ground of what bears at a contact.
void add_corners(const WholeBody& whole, int contact, const Rigid& at, const Vec3& point,
                 std::vector<Vec2>& corners) {
  const double h = whole.body().height_m;
  const auto add = [&](const Vec3& p) { corners.push_back({p.x(), p.z()}); };
  const Vec3 place = at * point;
  if (kind_of(contact) == foot) {
    const std::vector<Vec3>& skin = whole.skin()[index(segment_of(contact))];
    for (const Vec3& p : skin)
      if (p.y() < point.y() + 0.02 * h) add(at * p);
  } else if (kind_of(contact) == seat) {
    for (const double x : {-0.05, 0.05})
      for (const double z : {-0.06, 0.06}) add(place + h * Vec3(x, 0.0, z));
  } else {
    for (const double x : {-0.02, 0.02})
      for (const double z : {-0.02, 0.02}) add(place + h * Vec3(x, 0.0, z));
  }
}

bool is_low(const WholeBody& whole, const Vec3& place, double times = 1.0) {
  return place.y() < times * 0.015 * whole.body().height_m;
}

constexpr Joint kArms[] = {Joint::clavicle_l, Joint::shoulder_l, Joint::elbow_l, Joint::wrist_l,
                           Joint::clavicle_r, Joint::shoulder_r, Joint::elbow_r, Joint::wrist_r};

struct PlannedKey {
  double time_s = 0.0;
  FigurePose figure;
  std::array<bool, kContacts> on{};
  std::array<Rigid, kContacts> pin{};  // of the contact's segment
  bool lies = false;                   // other parts bear too
  bool keeps_body = false;
};

constexpr int kMends = 2, kMoreMends = 4;

/// Which way round a route is taken.
struct WayRound {
  bool a_is_right = true;
  bool knees_free = false;  // knees that lie on the floor may be moved
  int mends = kMends;       // times that the way of the weight is put right
};

class Planner {
 public:
  Planner(const WholeBody& whole, const BodyPose& before, const BodyPose& lying, const BodyPose& standing,
          const GetUpSettings& settings)
      : whole_(whole),
        before_(before),
        lying_(lying),
        standing_(standing),
        settings_(settings),
        points_(contact_points(whole)),
        skins_(contact_skins(whole)),
        trunk_(trunk_skin(whole)) {}

  GetUp plan(const Route& route, double heading, const WayRound& side, double tempo);

 private:
  FigurePose likeness_of(const KeyPose& key) const;
  std::array<bool, kContacts> touches_of(const KeyPose& key) const;
  PoseGoals likeness_goals(const KeyPose& key) const;
  void place_likeness(const KeyPose& key, const PlannedKey& next, PoseGoals& goals) const;
  PoseGoals with_contacts(PoseGoals goals, const PlannedKey& next,
                          const std::array<bool, kContacts>& placed) const;
  void solve_key(const KeyPose& key, const PlannedKey& following);
  std::vector<std::vector<Vec2>> supports_of(const PlannedKey& next, const PlannedKey& following,
                                             const std::array<bool, kContacts>& placed,
                                             const FigurePose& figure) const;
  PlannedKey touching(const KeyPose& key) const;
  void start_lying(const Route& route, bool knees_free);
  void end_standing(double rise_s);
  std::vector<PlantedPart> planted_parts() const;
  FigurePose carried_by_speed(FigurePose figure, double time_s) const;
  void add_new_contact(int contact, PoseGoals& goals) const;
  void add_pin(int contact, const Rigid& pin, double share, double turn_share, PoseGoals& goals) const;
  void place_stand(const FigurePose& figure, const std::array<bool, kContacts>& on);
  std::vector<Vec2> support(const PlannedKey& from, const PlannedKey& to) const;
  double eased(double time_s) const;
  std::vector<Vec2> balance_path() const;
  FigurePose reference_at(double time_s) const;
  std::vector<FigurePose> references() const;
  std::vector<FigurePose> smoothed(const std::vector<FigurePose>& figures, double sigma_s) const {
    return ukemi::smoothed(whole_, figures, sigma_s * settings_.fps);
  }
  std::vector<FigurePose> guided(const std::vector<FigurePose>& reference,
                                 const std::vector<Vec2>& balance) const;
  std::vector<FigurePose> balanced_motion(std::vector<Vec2>& balance) const;
  void fill_frames(GetUp& result);
  void mend_balance(const std::vector<FigurePose>& figures, std::vector<Vec2>& balance) const;
  std::vector<FigurePose> balanced(const std::vector<FigurePose>& guide,
                                   const std::vector<Vec2>& balance) const;
  PoseGoals balanced_goals(int frame, const FigurePose& reference, const Vec2& balance,
                           double likeness) const;
  PoseGoals goals_at(double time_s, const FigurePose& reference, double likeness) const;
  std::vector<double> stays(const std::vector<Vec2>& balance) const;
  std::optional<int> steps_to(int contact, int i) const;
  bool steps_from(int contact, int i) const;
  void raise(Segment segment, Rigid& at) const;
  void add_swing(int from, int to, int i, double time_s, PoseGoals& goals) const;
  void add_on_the_way(int contact, int i, double time_s, const BodyPose& alike, PoseGoals& goals) const;
  double unhurried_s(const PlannedKey& from, const PlannedKey& to) const;

  double end_s() const { return keys_.back().time_s; }
  int interval(double time_s) const {
    int i = 0;
    while (i + 2 < static_cast<int>(keys_.size()) && keys_[i + 1].time_s <= time_s) ++i;
    return i;
  }

  const WholeBody& whole_;
  const BodyPose& before_;
  const BodyPose& lying_;
  BodyPose standing_;
  GetUpSettings settings_;
  ContactPoints points_;
  std::array<OuterSkin, kContacts> skins_;
  OuterSkin trunk_;  // and thighs: what bears while the body lies
  double heading_ = 0.0;
  bool a_is_right_ = true;
  int mends_ = kMends;
  double tempo_ = 1.0;
  bool placed_ = false;
  double seat_height_ = 0.0, trunk_height_ = 0.0;  // of the lying body
  std::vector<PlannedKey> keys_;
  std::vector<double> stays_s_;  // of each key
};

FigurePose Planner::likeness_of(const KeyPose& key) const {
  FigurePose figure;
  const double m = a_is_right_ ? 1.0 : -1.0;  // a turn about y above 0 goes to the left
  figure.turn =
      exp_rotation(heading_ * kY) * about(kY, m * key.yaw) * about(kZ, -key.pitch) * about(kY, m * key.axial);
  const auto set = [&](Joint joint, const Quat& q) { figure.joints[index(joint)] = q; };
  for (Quat& q : figure.joints) q = Quat::Identity();
  set(Joint::spine, about(kZ, -0.54 * key.trunk) * about(kY, m * 0.3 * key.trunk_turn));
  set(Joint::chest, about(kZ, -0.46 * key.trunk) * about(kY, m * 0.7 * key.trunk_turn));
  set(Joint::neck, about(kZ, -key.neck) * about(kY, m * key.look));
  for (const bool is_a : {true, false}) {
    const bool left = is_a != a_is_right_;
    const double s = left ? -1.0 : 1.0;
    const KeyArm& arm = is_a ? key.arm_a : key.arm_b;
    const KeyLeg& leg = is_a ? key.leg_a : key.leg_b;
    const auto joint = [&](Joint on_left) { return left ? on_left : mirror_of(on_left); };
    set(joint(Joint::shoulder_l),
        about(kZ, arm.raise) * about(kX, -s * arm.abduction) * about(kY, s * arm.in_turn));
    set(joint(Joint::elbow_l),
        about(kZ, arm.elbow) * about(kY, s * std::min(80.0, 8.0 + 1.4 * std::abs(arm.wrist))));
    set(joint(Joint::wrist_l), about(kX, s * arm.wrist));
    set(joint(Joint::hip_l),
        about(kZ, leg.hip) * about(kX, -s * leg.abduction) * about(kY, -s * leg.out_turn));
    set(joint(Joint::knee_l), about(kZ, -leg.knee));
    set(joint(Joint::ankle_l), about(kZ, leg.ankle));
  }
  return whole_.inside(figure, kMargin);
}

std::array<bool, kContacts> Planner::touches_of(const KeyPose& key) const {
  std::array<bool, kContacts> on{};
  const auto set = [&](unsigned flag_a, unsigned flag_b, ContactKind part) {
    if (key.touches & flag_a) on[contact_index(part, !a_is_right_)] = true;
    if (key.touches & flag_b) on[contact_index(part, a_is_right_)] = true;
  };
  set(kHandA, kHandB, hand);
  set(kKneeA, kKneeB, knee);
  set(kFootA, kFootB, foot);
  set(kToesA, kToesB, toes);
  on[8] = (key.touches & kSeat) != 0;
  return on;
}

/// A part that comes down somewhere.
void Planner::add_new_contact(int contact, PoseGoals& goals) const {
  const Segment segment = segment_of(contact);
  if (kind_of(contact) == seat) {
    goals.touches.push_back({&skins_[contact], 300.0});
    return;
  }
  goals.touches.push_back({&skins_[contact], 300.0});
  if (kind_of(contact) == hand)
    goals.axes.push_back({segment, Vec3(0, 0, is_left_contact(contact) ? 1.0 : -1.0), -kY, 12.0});
  if (kind_of(contact) == foot) goals.axes.push_back({segment, kY, kY, 12.0});
}

void Planner::add_pin(int contact, const Rigid& pin, double share, double turn_share,
                      PoseGoals& goals) const {
  const Segment segment = segment_of(contact);
  if (kind_of(contact) == seat) {
    goals.points.push_back({segment, points_[contact], pin * points_[contact], share * 60.0 * (kX + kZ)});
    goals.touches.push_back({&skins_[contact], share * 300.0});
    return;
  }
  goals.points.push_back({segment, points_[contact], pin * points_[contact], share * Vec3::Constant(800.0)});
  if (kind_of(contact) == hand) goals.turns.push_back({segment, pin.rotation, turn_share * 25.0});
  if (kind_of(contact) == foot) goals.turns.push_back({segment, pin.rotation, turn_share * 40.0});
}

/// The standing pose to where the feet come down.
void Planner::place_stand(const FigurePose& figure, const std::array<bool, kContacts>& on) {
  const BodyPose segments = whole_.segments(figure);
  Vec3 wanted = Vec3::Zero(), is = Vec3::Zero();
  for (const bool left : {true, false}) {
    if (!on[contact_index(foot, left)]) continue;
    wanted += segments[index(on_side(Segment::foot_l, left))].translation;
    is += standing_[index(on_side(Segment::foot_l, left))].translation;
  }
  const int feet = on[contact_index(foot, true)] + on[contact_index(foot, false)];
  wanted /= feet, is /= feet;
  const Rigid move{Quat::Identity(), level(wanted - is)};
  for (Rigid& segment : standing_) segment = move * segment;
  placed_ = true;
}

std::vector<Vec2> Planner::support(const PlannedKey& from, const PlannedKey& to) const {
  std::vector<Vec2> corners;
  for (int c = 0; c < kContacts; ++c)
    if (from.on[c] && to.on[c]) add_corners(whole_, c, from.pin[c], points_[c], corners);
  return hull_of(corners);
}

/// What a key looks like, and how much that counts.
PoseGoals Planner::likeness_goals(const KeyPose& key) const {
  PoseGoals goals;
  goals.margin = kMargin;
  goals.likeness = likeness_of(key);
  goals.likeness_weight.fill(3.0);
  for (const Joint j : {Joint::spine, Joint::chest, Joint::neck}) goals.likeness_weight[index(j)] = 6.0;
  for (const Joint j : {Joint::clavicle_l, Joint::clavicle_r}) goals.likeness_weight[index(j)] = 8.0;
  goals.turn_weight = 5.0;
  if (!key.keeps_body) return goals;
  FigurePose kept = keys_.back().figure;
  for (const Joint j : kArms) kept.joints[index(j)] = goals.likeness.joints[index(j)];
  kept.joints[index(Joint::neck)] = goals.likeness.joints[index(Joint::neck)];
  goals.likeness = whole_.inside(kept, kMargin);
  for (const Joint j : {Joint::hip_l, Joint::hip_r, Joint::knee_l, Joint::knee_r})
    goals.likeness_weight[index(j)] = 12.0;
  goals.turn_weight = 30.0;
  return goals;
}

/// Places the target pose by the parts that stay on the floor, else where the body was.
void Planner::place_likeness(const KeyPose& key, const PlannedKey& next, PoseGoals& goals) const {
  const PlannedKey& last = keys_.back();
  const BodyPose alike = whole_.segments(goals.likeness);
  Vec3 shift = Vec3::Zero();
  int held = 0;
  for (int c = 0; c < kContacts; ++c) {
    if (!next.on[c] || !last.on[c]) continue;
    shift += level(last.pin[c] * points_[c] - alike[index(segment_of(c))] * points_[c]);
    ++held;
  }
  goals.likeness.place = held && !key.keeps_body ? Vec3(shift / held) : level(last.figure.place);
  goals.likeness.place.y() = key.keeps_body ? last.figure.place.y() : -whole_.lowest(alike);
  goals.place_weight = held ? Vec3(0.5, 0.5, 0.5) : Vec3(4.0, 0.5, 4.0);
  if (key.keeps_body) goals.place_weight = Vec3(30.0, 30.0, 30.0);
}

/// The likeness with contacts: contacts with a place stay in it, the others come down.
PoseGoals Planner::with_contacts(PoseGoals goals, const PlannedKey& next,
                                 const std::array<bool, kContacts>& placed) const {
  for (int c = 0; c < kContacts; ++c) {
    if (!next.on[c]) continue;
    if (placed[c])
      add_pin(c, next.pin[c], 1.0, 1.0, goals);
    else
      add_new_contact(c, goals);
  }
  return goals;
}

PlannedKey Planner::touching(const KeyPose& key) const {
  PlannedKey planned;
  planned.on = touches_of(key);
  planned.lies = (key.touches & kBody) != 0;
  planned.keeps_body = key.keeps_body;
  return planned;
}

/// Where the weight lies at a key: over the contacts that bear both before and after it. So it is shifted
/// before a part lifts.
std::vector<std::vector<Vec2>> Planner::supports_of(const PlannedKey& next, const PlannedKey& following,
                                                    const std::array<bool, kContacts>& placed,
                                                    const FigurePose& figure) const {
  const double margin = kInside * whole_.body().height_m;
  std::vector<std::vector<Vec2>> supports;
  if (!keys_.back().lies) supports.push_back(drawn_in(support(keys_.back(), next), margin));
  const BodyPose segments = whole_.segments(figure);
  PlannedKey now = next;
  for (int c = 0; c < kContacts; ++c)
    if (!placed[c]) now.pin[c] = segments[index(segment_of(c))];
  if (!(next.lies && following.lies)) supports.push_back(drawn_in(support(now, following), margin));
  return supports;
}

/// Iterates: where new feet come down decides where the body will stand, and the reverse; where hands and
/// knees come down decides what there is to lean on.
void Planner::solve_key(const KeyPose& key, const PlannedKey& following) {
  const PlannedKey& last = keys_.back();
  PlannedKey next = touching(key);
  std::array<bool, kContacts> placed{};
  for (int c = 0; c < kContacts; ++c)
    if (next.on[c] && last.on[c]) placed[c] = true, next.pin[c] = last.pin[c];
  PoseGoals goals = likeness_goals(key);
  place_likeness(key, next, goals);
  if (next.lies) goals.touches.push_back({&trunk_, 150.0});
  goals.support_weight = 120.0;
  FigurePose figure = whole_.reach(with_contacts(goals, next, placed), goals.likeness, 25);
  for (const bool left : {true, false}) {
    const int c = contact_index(foot, left);
    if (!next.on[c] || placed[c]) continue;
    if (!placed_) place_stand(figure, next.on);
    placed[c] = true;
    next.pin[c] = standing_[index(segment_of(c))];
  }
  for (int round = 0; round < 3; ++round) {
    goals.supports = supports_of(next, following, placed, figure);
    figure = whole_.reach(with_contacts(goals, next, placed), figure, 15);
  }
  const BodyPose segments = whole_.segments(figure);
  for (int c = 0; c < kContacts; ++c)
    if (next.on[c] && !placed[c]) next.pin[c] = segments[index(segment_of(c))];
  next.figure = whole_.inside(figure, kMargin);
  keys_.push_back(next);
}

/// Share of the way from the last key to the next.
double Planner::eased(double time_s) const {
  const int i = interval(time_s);
  const double u = std::clamp((time_s - keys_[i].time_s) / (keys_[i + 1].time_s - keys_[i].time_s), 0.0, 1.0);
  if (i == 0) return std::pow(u, 1.8);
  return i + 2 == static_cast<int>(keys_.size()) ? 1.0 - std::pow(1.0 - u, 1.8) : u;
}

FigurePose Planner::reference_at(double time_s) const {
  const int i = interval(time_s);
  return between(whole_, keys_[i].figure, keys_[i + 1].figure, eased(time_s));
}

/// The speed in which the body lay there is carried on and fades.
FigurePose Planner::carried_by_speed(FigurePose figure, double time_s) const {
  constexpr double kFade_s = 0.3;
  const double left = std::max(0.0, 1.0 - time_s / kFade_s);
  const double span = settings_.fps * time_s * left * left * left;
  if (span <= 0.0) return figure;
  const FigurePose was = figure_pose(before_), is = figure_pose(lying_);
  figure.place += span * (is.place - was.place);
  figure.turn =
      (exp_rotation(span * log_rotation(is.turn * was.turn.conjugate())) * figure.turn).normalized();
  for (int j = 0; j < kJointCount; ++j)
    figure.joints[j] =
        (figure.joints[j] * exp_rotation(span * log_rotation(was.joints[j].conjugate() * is.joints[j])))
            .normalized();
  return whole_.inside(figure, radians(-0.5));
}

std::vector<FigurePose> Planner::references() const {
  const int last = static_cast<int>(std::lround(end_s() * settings_.fps));
  std::vector<FigurePose> figures;
  for (int f = 0; f <= last; ++f)
    figures.push_back(carried_by_speed(reference_at(f / settings_.fps), f / settings_.fps));
  return figures;
}

/// Where the centre of mass goes: straight from key to key, rounded.
std::vector<Vec2> Planner::balance_path() const {
  std::vector<Vec2> at_key;
  for (const PlannedKey& key : keys_) {
    const Vec3 com = whole_.centre_of_mass(whole_.segments(key.figure));
    at_key.push_back({com.x(), com.z()});
  }
  const int last = static_cast<int>(std::lround(end_s() * settings_.fps));
  std::vector<FigurePose> path(last + 1);
  for (int f = 0; f <= last; ++f) {
    const int i = interval(f / settings_.fps);
    const double u = eased(f / settings_.fps);
    const Vec2 at = (1.0 - u) * at_key[i] + u * at_key[i + 1];
    path[f].place = Vec3(at.x(), 0.0, at.y());
  }
  std::vector<Vec2> result;
  for (const FigurePose& figure : smoothed(path, 0.11))
    result.push_back({figure.place.x(), figure.place.z()});
  return result;
}

/// Seconds that parts stay after each key, until the weight lies over what remains.
std::vector<double> Planner::stays(const std::vector<Vec2>& balance) const {
  constexpr double kLeast_s = 0.14, kAfter_s = 0.06;
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
    const double span = keys_[i + 1].time_s - keys_[i].time_s;
    const auto remains = drawn_in(support(keys_[i], keys_[i + 1]), 0.5 * kInside * whole_.body().height_m);
    double stays_s = 0.0;
    while (stays_s < span) {
      const auto frame = static_cast<std::size_t>(std::lround((keys_[i].time_s + stays_s) * settings_.fps));
      if (way_into(remains, balance[std::min(frame, balance.size() - 1)]).norm() < 0.005) break;
      stays_s += 1.0 / settings_.fps;
    }
    stays_s = stays_s > 0.0 ? stays_s + kAfter_s : 0.0;
    result.push_back(keys_[i].lies
                         ? 0.0
                         : std::min(std::max(kLeast_s, stays_s), (stays_s > kLeast_s ? 0.5 : 0.25) * span));
  }
  return result;
}

/// Where the same segment comes down that leaves the floor in an interval: a step.
std::optional<int> Planner::steps_to(int contact, int i) const {
  if (!keys_[i].on[contact]) return std::nullopt;
  for (int c = 0; c < kContacts; ++c)
    if (c != contact && segment_of(c) == segment_of(contact) && keys_[i + 1].on[c] && !keys_[i].on[c])
      return c;
  return std::nullopt;
}

bool Planner::steps_from(int contact, int i) const {
  for (int c = 0; c < kContacts; ++c)
    if (steps_to(c, i) == contact) return true;
  return false;
}

/// Out of the floor, with all its skin.
void Planner::raise(Segment segment, Rigid& at) const {
  double low = 0.0;
  for (const Vec3& p : whole_.skin()[index(segment)]) low = std::min(low, (at * p).y());
  at.translation.y() -= low;
}

/// A step: from one place to the next, lifted, in the time between them.
void Planner::add_swing(int from, int to, int i, double time_s, PoseGoals& goals) const {
  constexpr double kLift = 0.04;       // of the height
  constexpr double kSettles_s = 0.05;  // before the next key
  const double begins_s = keys_[i].time_s + stays_s_[i], ends_s = keys_[i + 1].time_s - kSettles_s;
  const double share = smooth_step((time_s - begins_s) / (ends_s - begins_s));
  const Rigid& a = keys_[i].pin[from];
  const Rigid& b = keys_[i + 1].pin[to];
  Rigid target{a.rotation.slerp(share, b.rotation), Vec3::Zero()};
  Vec3 place = (1.0 - share) * (a * points_[from]) + share * (b * points_[to]);
  place.y() += kLift * whole_.body().height_m * 4.0 * share * (1.0 - share);
  target.translation = place - target.rotation * points_[to];
  raise(segment_of(to), target);
  const double firm = 1.0 - 0.8 * 4.0 * share * (1.0 - share);
  add_pin(to, target, firm, 0.5 * firm, goals);
}

/// Draws a contact that moves from its last place to its next.
void Planner::add_on_the_way(int contact, int i, double time_s, const BodyPose& alike,
                             PoseGoals& goals) const {
  constexpr double kLongestEase_s = 0.42;
  constexpr double kArc = 0.02,
                   kSteep = 0.25;  // of the height, of what is left of the way: so far a part lifts
  const double span = keys_[i + 1].time_s - keys_[i].time_s;
  const double ease = std::min(kLongestEase_s, 0.75 * span);
  const auto partly = [&](const Rigid& pin, double progress) {
    if (progress <= 0.0) return;
    const double share = smooth_step(progress);
    const Rigid& own = alike[index(segment_of(contact))];
    Rigid target{pin.rotation, Vec3::Zero()};
    const Vec3 is = own * points_[contact], will_be = pin * points_[contact];
    Vec3 place = (1.0 - share) * is + share * will_be;
    if (kind_of(contact) != seat)
      place.y() += std::min(kArc * whole_.body().height_m, kSteep * level(will_be - is).norm()) *
                   std::sin(kPi * share);
    target.translation = place - target.rotation * points_[contact];
    if (kind_of(contact) != seat) raise(segment_of(contact), target);
    add_pin(contact, target, growing(progress), growing(progress), goals);
  };
  if (keys_[i].on[contact])
    partly(keys_[i].pin[contact], 1.0 - std::max(0.0, time_s - keys_[i].time_s - stays_s_[i]) /
                                            std::min(kLongestEase_s, span - stays_s_[i]));
  if (keys_[i + 1].on[contact])
    partly(keys_[i + 1].pin[contact], 1.0 - (keys_[i + 1].time_s - time_s) / ease);
}

PoseGoals Planner::goals_at(double time_s, const FigurePose& reference, double likeness) const {
  constexpr double kStill = 150.0;
  PoseGoals goals;
  // A limp body lies with joints at their ends, half a degree beyond.
  goals.margin = radians(-0.5) + (kMargin + radians(0.5)) * smooth_step(time_s / 0.4);
  goals.likeness = reference;
  goals.likeness_weight.fill(likeness);
  goals.place_weight = Vec3(likeness, likeness, likeness);
  goals.turn_weight = 1.5 * likeness;
  const BodyPose alike = whole_.segments(reference);
  // What lies in the floor, or a seat above it, gets there in time.
  const double settled = 1.0 - smooth_step(time_s / 0.4);
  goals.floor_m = settled * std::min(0.0, whole_.lowest(lying_));
  const int i = interval(time_s);
  if (keys_[i + 1].keeps_body) {  // arms find their way round it
    goals.place_weight = Vec3::Constant(kStill);
    goals.turn_weight = kStill;
    for (const Joint j : {Joint::spine, Joint::chest, Joint::hip_l, Joint::hip_r})
      goals.likeness_weight[index(j)] = kStill;
  }
  for (int c = 0; c < kContacts; ++c) {
    if (keys_[i].on[c] && keys_[i + 1].on[c])
      add_pin(c, keys_[i].pin[c], 1.0, 1.0, goals);
    else if (const auto to = steps_to(c, i))
      add_swing(c, *to, i, time_s, goals);
    else if (!steps_from(c, i))
      add_on_the_way(c, i, time_s, alike, goals);
  }
  for (TouchGoal& goal : goals.touches) goal.height_m = settled * seat_height_;
  if (keys_[i].lies) {
    const double rises = keys_[i + 1].lies
                             ? 0.0
                             : (time_s - keys_[i].time_s) / (0.6 * (keys_[i + 1].time_s - keys_[i].time_s));
    goals.touches.push_back({&trunk_, 150.0 * (1.0 - smooth_step(rises)), settled * trunk_height_});
  }
  return goals;
}

PoseGoals Planner::balanced_goals(int frame, const FigurePose& reference, const Vec2& balance,
                                  double likeness) const {
  PoseGoals goals = goals_at(frame / settings_.fps, reference, likeness);
  goals.balance = balance;
  goals.balance_weight = 150.0;
  const int i = interval(frame / settings_.fps);
  if (!keys_[i].lies)
    goals.supports = {drawn_in(support(keys_[i], keys_[i + 1]), 0.5 * kInside * whole_.body().height_m)};
  goals.support_weight = 120.0 * smooth_step(frame / settings_.fps / 0.4);
  goals.floor_weight = 200.0;
  return goals;
}

/// The reference, made to touch what it shall fifteen times a second and led through those poses.
std::vector<FigurePose> Planner::guided(const std::vector<FigurePose>& reference,
                                        const std::vector<Vec2>& balance) const {
  const int last = static_cast<int>(reference.size()) - 1;
  const int stride = std::max(1, static_cast<int>(std::lround(settings_.fps / 15.0)));
  std::vector<FigurePose> figures{reference.front()};
  FigurePose before = reference.front();
  for (int from = 0; from < last;) {
    const int to = last - from < 2 * stride ? last : from + stride;
    FigurePose next = reference[to];
    if (to < last) {
      PoseGoals goals = balanced_goals(to, reference[to], balance[to], 4.0);
      goals.floor_m += kClearance_m * smooth_step(to / settings_.fps / 0.4);
      goals.floor_weight = 400.0;
      next = whole_.reach(goals, carried_on(reference[from], before, reference[to]), 16);
    }
    for (int f = from + 1; f <= to; ++f)
      figures.push_back(between(whole_, before, next, static_cast<double>(f - from) / (to - from)));
    before = next;
    from = to;
  }
  return smoothed(figures, 0.09);
}

/// Adds to the way of the weight what is missing where it is not over what bears it, early enough.
void Planner::mend_balance(const std::vector<FigurePose>& figures, std::vector<Vec2>& balance) const {
  const int last = static_cast<int>(figures.size()) - 1;
  const int reach = static_cast<int>(std::lround(0.12 * settings_.fps));
  std::vector<Vec2> missing;
  for (const FigurePose& figure : figures) {
    const BodyPose segments = whole_.segments(figure);
    const Vec3 com = whole_.centre_of_mass(segments);
    const auto support = support_of(whole_.body(), whole_.skin(), segments);
    missing.push_back(
        way_into(drawn_in(support, 0.5 * kInside * whole_.body().height_m), {com.x(), com.z()}));
  }
  std::vector<Vec2> most;
  for (int f = 0; f <= last; ++f) {
    Vec2 largest = Vec2::Zero();
    for (int k = std::max(0, f - reach); k <= std::min(last, f + reach); ++k)
      if (missing[k].norm() > largest.norm()) largest = missing[k];
    most.push_back(largest);
  }
  for (int f = 1; f < last; ++f) {
    Vec2 sum = Vec2::Zero();
    const int around = std::min({reach, f, last - f});
    for (int k = f - around; k <= f + around; ++k) sum += most[k];
    const double ramp =
        smooth_step(f / settings_.fps / 0.35) * smooth_step((last - f) / settings_.fps / 0.35);
    balance[f] += ramp / (2.0 * around + 1.0) * sum;
  }
}

std::vector<FigurePose> Planner::balanced(const std::vector<FigurePose>& guide,
                                          const std::vector<Vec2>& balance) const {
  const int last = static_cast<int>(guide.size()) - 1;
  std::vector<FigurePose> figures;
  for (int f = 0; f <= last; ++f)
    figures.push_back(f == 0 || f == last
                          ? guide[f]
                          : whole_.reach(balanced_goals(f, guide[f], balance[f], 20.0), guide[f], 6));
  return smoothed(figures, 0.055);
}

/// The motion from key to key, balanced.
std::vector<FigurePose> Planner::balanced_motion(std::vector<Vec2>& balance) const {
  const std::vector<FigurePose> reference = smoothed(references(), 0.11);
  balance = balance_path();
  std::vector<FigurePose> figures = balanced(guided(reference, balance), balance);
  for (int round = 0; round < mends_; ++round) {
    mend_balance(figures, balance);
    figures = balanced(figures, balance);
  }
  return figures;
}

/// A motion is sought in about twenty frames a second, and put right in those that are wanted.
void Planner::fill_frames(GetUp& result) {
  constexpr double kSunk_m = 0.003;
  constexpr double kSought_hz = 18.0;  // at the tempo of the tables
  const double fps = settings_.fps;
  const int last = static_cast<int>(std::lround(end_s() * fps));
  const int count = std::min(last, static_cast<int>(std::lround(last / fps * kSought_hz / tempo_)));
  settings_.fps = count / (last / fps);
  std::vector<Vec2> coarse_balance;
  const std::vector<FigurePose> coarse = balanced_motion(coarse_balance);
  settings_.fps = fps;
  std::vector<FigurePose> figures;
  std::vector<Vec2> balance;
  for (int f = 0; f <= last; ++f) {
    const double at = static_cast<double>(f) * count / last;
    const int i = std::min(static_cast<int>(at), count - 1);
    figures.push_back(between(whole_, coarse[i], coarse[i + 1], at - i));
    balance.push_back((1.0 - at + i) * coarse_balance[i] + (at - i) * coarse_balance[i + 1]);
  }
  result.frames.push_back(lying_);
  for (int f = 1; f < last; ++f) {
    PoseGoals goals = balanced_goals(f, figures[f], balance[f], 40.0);
    FigurePose figure = whole_.reach(goals, figures[f], 4);
    goals.floor_weight = 800.0;
    if (whole_.lowest(whole_.segments(figure)) < goals.floor_m - kSunk_m)
      figure = whole_.reach(goals, figure, 6);
    result.frames.push_back(whole_.segments(whole_.inside(figure, radians(-0.5))));
  }
}

/// The least time from one pose to another: joints and pelvis turn no faster than people's do in get-ups.
double Planner::unhurried_s(const PlannedKey& from, const PlannedKey& to) const {
  constexpr double kJointSpeed = radians(250.0), kPelvisSpeed = radians(170.0);  // means
  constexpr double kRise = 0.8;                                                  // m/s, mean
  const double part_speed = 1.4 * std::sqrt(whole_.body().height_m / 1.75);      // m/s
  double least = angle_between(from.figure.turn, to.figure.turn) / kPelvisSpeed;
  for (int j = 0; j < kJointCount; ++j)
    least = std::max(least, angle_between(from.figure.joints[j], to.figure.joints[j]) / kJointSpeed);
  const BodyPose was = whole_.segments(from.figure), is = whole_.segments(to.figure);
  for (int c = 0; c < kContacts; ++c) {
    const auto s = static_cast<std::size_t>(index(segment_of(c)));
    if (from.on[c] != to.on[c])
      least = std::max(least, (is[s] * points_[c] - was[s] * points_[c]).norm() / part_speed);
  }
  least = std::max(least, (whole_.centre_of_mass(is) - whole_.centre_of_mass(was)).y() / kRise);
  return least;
}

void Planner::start_lying(const Route& route, bool knees_free) {
  PlannedKey start;
  start.figure = figure_pose(lying_);
  const bool kneels = !(route.keys.front().touches & (kSeat | kBody));
  start.lies = !kneels;
  for (const bool left : {true, false}) {
    const int c = contact_index(knee, left);
    start.pin[c] = lying_[index(segment_of(c))];
    start.on[c] = !knees_free && is_low(whole_, start.pin[c] * points_[c]);
    const int t = contact_index(toes, left);
    start.pin[t] = lying_[index(segment_of(t))];
    start.on[t] = kneels && is_low(whole_, start.pin[t] * points_[t], 2.0);
  }
  const int on_seat = contact_index(seat, true);
  start.pin[on_seat] = lying_[0];
  start.on[on_seat] = (route.keys.front().touches & kSeat) != 0;
  seat_height_ = lowest_of(skins_[on_seat], lying_);
  trunk_height_ = lowest_of(trunk_, lying_);
  keys_ = {start};
}

void Planner::end_standing(double rise_s) {
  PlannedKey end;
  end.time_s = keys_.back().time_s + rise_s;
  end.figure = figure_pose(standing_);
  for (const bool left : {true, false}) {
    const int c = contact_index(foot, left);
    end.on[c] = true;
    end.pin[c] = standing_[index(segment_of(c))];
  }
  keys_.push_back(end);
}

std::vector<PlantedPart> Planner::planted_parts() const {
  std::vector<PlantedPart> parts;
  for (int c = 0; c < kContacts; ++c) {
    if (kind_of(c) == seat) continue;
    for (std::size_t k = 0; k + 1 < keys_.size(); ++k)
      if (keys_[k].on[c] && keys_[k + 1].on[c])
        parts.push_back({segment_of(c), points_[c], keys_[k].pin[c] * points_[c],
                         static_cast<int>(std::ceil(keys_[k].time_s * settings_.fps)),
                         static_cast<int>(std::floor(keys_[k + 1].time_s * settings_.fps))});
  }
  return parts;
}

GetUp Planner::plan(const Route& route, double heading, const WayRound& side, double tempo) {
  heading_ = heading;
  a_is_right_ = side.a_is_right;
  mends_ = side.mends;
  tempo_ = tempo;
  const Quat turn = exp_rotation((heading - yaw_of(standing_[0].rotation * kX)) * kY);
  for (Rigid& segment : standing_) segment = Rigid{turn, Vec3::Zero()} * segment;
  start_lying(route, side.knees_free);
  GetUp result;
  result.fps = settings_.fps;
  result.route = std::string(route.name);
  PlannedKey stands;
  for (const bool left : {true, false}) stands.on[contact_index(foot, left)] = true;
  for (std::size_t k = 0; k < route.keys.size(); ++k) {
    const KeyPose& key = route.keys[k];
    const PlannedKey last = keys_.back();
    if (!key.phase.empty()) result.phases.push_back({std::string(key.phase), last.time_s});
    solve_key(key, k + 1 < route.keys.size() ? touching(route.keys[k + 1]) : stands);
    keys_.back().time_s = last.time_s + std::max(tempo * key.seconds, unhurried_s(last, keys_.back()));
  }
  end_standing(tempo * route.rise_s);
  result.phases.push_back({"stands", keys_.back().time_s});
  stays_s_ = stays(balance_path());
  fill_frames(result);
  result.frames.push_back(standing_);
  result.planted = planted_parts();
  return result;
}

}  // namespace

std::string_view name(Lying lying) {
  constexpr std::string_view kNames[] = {"supine", "prone",    "left_side", "right_side",
                                         "seated", "kneeling", "upright"};
  return kNames[static_cast<int>(lying)];
}

namespace {

/// From the pelvis to the middle of the ankles, on the ground.
Vec3 to_feet(const BodyPose& pose) {
  return level(0.5 * (pose[index(Segment::foot_l)].translation + pose[index(Segment::foot_r)].translation) -
               pose[0].translation);
}

/// Folded over his legs: feet and chest are on the same side of the pelvis.
bool feet_before_seat(const BodyPose& pose) {
  const Vec3 chest = level(pose[index(Segment::head)].translation - pose[0].translation);
  return chest.norm() > 1e-6 && to_feet(pose).dot(chest.normalized()) > 0.2;
}

}  // namespace

namespace {

/// About how high the pelvis of a standing body is: some have big heads and short legs.
double standing_hips(const ArticulatedBody& body) {
  return body.joints[index(Joint::knee_l)].anchor_in_parent.norm() +
         body.joints[index(Joint::ankle_l)].anchor_in_parent.norm() + 0.04 * body.height_m;
}

}  // namespace

Lying lying_of(const ArticulatedBody& body, const BodyPose& pose) {
  const Rigid& pelvis = pose[index(Segment::pelvis)];
  const Rigid& chest = pose[index(Segment::chest)];
  const double h = body.height_m;
  const double trunk_up = (chest.rotation * kY).y();
  const double front_up = (chest.rotation * kX + pelvis.rotation * kX).y();
  const double right_up = (chest.rotation * kZ + pelvis.rotation * kZ).y();
  if (pelvis.translation.y() > std::min(0.38 * h, 0.73 * standing_hips(body))) return Lying::upright;
  if (trunk_up > std::sin(radians(40.0)) && pelvis.translation.y() < 0.14 * h) return Lying::seated;
  if (pelvis.translation.y() < 0.14 * h && feet_before_seat(pose)) return Lying::seated;
  const bool aside = std::abs(right_up) > 1.25 * std::abs(front_up) + 0.2;
  if (pelvis.translation.y() > 0.16 * h && !(aside && std::abs(trunk_up) < 0.4)) return Lying::kneeling;
  if (aside) return right_up > 0.0 ? Lying::left_side : Lying::right_side;
  return front_up > 0.0 ? Lying::supine : Lying::prone;
}

namespace {

/// Seconds of a key, of those in the tables.
double tempo(GetUpStyle style) {
  switch (style) {
    case GetUpStyle::quick:
      return 0.7;
    case GetUpStyle::plain:
      return 0.9;
    case GetUpStyle::heavy:
      return 1.04;
    case GetUpStyle::hurt:
      break;
  }
  return 1.08;
}

bool bears(const KeyPose& key, unsigned part) { return (key.touches & part) != 0; }

/// Heavy: trunk and head hang, a hand pushes on the front knee. Hurt: bent, an arm held to the belly.
void in_style(GetUpStyle style, KeyPose& key) {
  if (style != GetUpStyle::heavy && style != GetUpStyle::hurt) return;
  const bool hurt = style == GetUpStyle::hurt;
  key.trunk += hurt ? 9.0 : 6.0;
  key.neck += hurt ? 10.0 : 7.0;
  if (hurt && !bears(key, kHandA)) key.arm_a = {18.0, 4.0, 55.0, 92.0, 0.0};
  if (!hurt && !bears(key, kHandA) && bears(key, kKneeB) && bears(key, kFootA) && !bears(key, kHandB))
    key.arm_a = {52.0, 4.0, 10.0, 34.0, -30.0};
}

void vary(Random& random, KeyPose& key) {
  key.seconds *= random.uniform(0.93, 1.07);
  key.trunk += random.uniform(-3.0, 3.0);
  key.look += random.uniform(-10.0, 10.0);
  for (KeyArm* arm : {&key.arm_a, &key.arm_b}) {
    arm->raise += random.uniform(-5.0, 5.0);
    arm->abduction += random.uniform(-3.0, 5.0);
    arm->elbow += random.uniform(-5.0, 5.0);
  }
  for (KeyLeg* leg : {&key.leg_a, &key.leg_b}) leg->abduction += random.uniform(-2.0, 3.0);
}

/// What is wrong with a get-up at its worst, in shares of what goes.
struct Faults {
  double balance = 0.0;  // weight without support
  double course = 0.0;   // parts that slide, sink or leap
  double worst() const { return std::max(balance, course); }
};

Faults faults_of(const WholeBody& whole, const GetUp& get_up) {
  constexpr double kSlide_m = 0.009, kSunk_m = 0.03, kSpeed_m_s = 6.5, kOffBalance_m = 0.03;
  Faults worst;
  const std::vector<WeightOffset> weights =
      weight_offsets(whole.body(), whole.skin(), get_up.frames, get_up.fps);
  for (std::size_t f = static_cast<std::size_t>(0.3 * get_up.fps); f < weights.size(); ++f)
    worst.balance = std::max(worst.balance, weights[f].least_m() / kOffBalance_m);
  const auto find = [&worst](double share) { worst.course = std::max(worst.course, share); };
  for (std::size_t f = 1; f < get_up.frames.size(); ++f) {
    const BodyPose& frame = get_up.frames[f];
    find(-whole.lowest(frame) / kSunk_m);
    for (int s = 0; s < kSegmentCount; ++s)
      find(get_up.fps / kSpeed_m_s * (frame[s].translation - get_up.frames[f - 1][s].translation).norm());
    for (const PlantedPart& part : get_up.planted)
      if (static_cast<int>(f) >= part.first && static_cast<int>(f) <= part.last)
        find((frame[index(part.segment)] * part.point - part.place).norm() / kSlide_m);
  }
  return worst;
}

/// What the pose decides.
struct Way {
  Route route;
  Vec3 ahead;  // where he will face
  bool a_is_right;
};

bool knees_lie(const WholeBody& whole, const BodyPose& lying) {
  const ContactPoints points = contact_points(whole);
  for (const int c : {contact_index(knee, true), contact_index(knee, false)})
    if (is_low(whole, lying[index(segment_of(c))] * points[c])) return true;
  return false;
}

bool knees_are_low(const ArticulatedBody& body, const BodyPose& lying) {
  return std::min(lying[index(Segment::shank_l)].translation.y(),
                  lying[index(Segment::shank_r)].translation.y()) < 0.08 * body.height_m;
}

Way choose(const ArticulatedBody& body, const BodyPose& lying, const GetUpSettings& settings,
           Random& random) {
  const Lying how = lying_of(body, lying);
  const Rigid& chest = lying[index(Segment::chest)];
  const Vec3 up = lying[0].rotation * kY + chest.rotation * kY;
  const Vec3 front = lying[0].rotation * kX + chest.rotation * kX;
  const bool open = random.uniform(0.0, 1.0) < 0.5;
  const bool squats = settings.style == GetUpStyle::quick && random.uniform(0.0, 1.0) < 0.6;
  const Route sits = squats ? squat_route() : half_kneel_route();
  switch (how) {
    case Lying::left_side:
    case Lying::right_side:
      return {side_route(), level(up), how == Lying::left_side};
    case Lying::seated: {
      Route route = sits;
      route.name = "seated";
      route.keys.erase(route.keys.begin());
      route.keys.front().phase = "sits";
      return {route, to_feet(lying), open};
    }
    case Lying::kneeling:
      if ((chest.rotation * kY).y() > 0.5)
        return {knees_are_low(body, lying) ? kneeling_route() : crouched_route(), level(front), open};
      return {prone_route(), level(up), open};
    case Lying::prone:
      return {prone_route(), level(up), open};
    case Lying::supine:
    case Lying::upright:
      break;
  }
  return {sits, -level(up), open};
}

/// Ways to turn, in the order in which they are tried.
std::vector<WayRound> ways_round(bool a_is_right, bool knees_lie) {
  std::vector<WayRound> ways;
  for (const int mends : {kMends, kMoreMends})
    for (const bool knees_free : {false, true})
      for (const bool right : {a_is_right, !a_is_right})
        if (knees_lie || !knees_free) ways.push_back({right, knees_free, mends});
  return ways;
}

}  // namespace

Result<GetUp> plan_get_up(const ArticulatedBody& body, const RangeOfMotion& range, const BodyPose& before,
                          const BodyPose& lying, const BodyPose& standing, const OuterSkin& skin,
                          const GetUpSettings& settings) {
  if (lying_of(body, lying) == Lying::upright)
    return usage_error("there is nothing to get up from: the body does not lie, sit or kneel",
                       "leave out --get-up");
  Random random(settings.seed ^ 0x6765745f7570ull);
  Way choice = choose(body, lying, settings, random);
  for (KeyPose& key : choice.route.keys) {
    in_style(settings.style, key);
    vary(random, key);
  }
  const WholeBody whole(body, range, skin);
  std::optional<GetUp> best;
  constexpr double kHolds = 1.1;
  Faults least;
  for (const WayRound& way : ways_round(choice.a_is_right, knees_lie(whole, lying))) {
    Planner planner(whole, before, lying, standing, settings);
    GetUp get_up = planner.plan(choice.route, yaw_of(choice.ahead), way, tempo(settings.style));
    const Faults faults = faults_of(whole, get_up);
    // Contacts that hold are not given up for better balance.
    const bool holds = faults.course < std::max(kHolds, least.course);
    if (!best || (holds && faults.worst() < least.worst())) least = faults, best = std::move(get_up);
    if (least.worst() < 1.0) break;
  }
  return *best;
}

}  // namespace ukemi
