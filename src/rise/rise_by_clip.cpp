#include "rise/rise_by_clip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "body/fading.h"
#include "body/on_ground.h"
#include "rise/bearing_points.h"
#include "rise/figure_motion.h"

namespace ukemi {
namespace {

const double kMargin = radians(0.5);   // inside the ranges
const double kBeyond = radians(-0.5);  // a limp body lies with joints at their ends, half a degree beyond
constexpr double kSettles_s = 0.4;     // in which what lies in the floor comes out of it
constexpr double kLevelling_s = 0.08;  // to either side
constexpr double kPin = 700.0;         // 1/m
constexpr double kStands = 250.0;      // 1/m, of the lowest part that can carry the body, on the floor
constexpr double kTouch = 200.0;       // 1/m
constexpr double kHolds_s = 0.035;     // before and after a part bears
constexpr double kEase_s = 0.14;       // into and out of a place
constexpr double kHandsLower = 0.16;   // of the height: so much longer may arms be than those of the clip
constexpr double kArc = 0.03;          // of the height: so high a hand or a foot is lifted on a long way
constexpr double kLongWay = 0.025;     // of the height

/// Skin of what can carry a body.
OuterSkin support_skin(const WholeBody& whole) {
  OuterSkin skin = trunk_skin(whole);
  for (const Segment s : {Segment::shank_l, Segment::shank_r, Segment::foot_l, Segment::foot_r})
    skin[index(s)] = whole.skin()[index(s)];
  return skin;
}

OuterSkin hand_skin(const WholeBody& whole) {
  OuterSkin skin;
  for (const Segment s : {Segment::hand_l, Segment::hand_r}) skin[index(s)] = whole.skin()[index(s)];
  return skin;
}

/// A figure with the charts of its joints.
struct Charted {
  FigurePose figure;
  PerJoint<SwingTwist> charts;
};

class ClipRiser {
 public:
  ClipRiser(const WholeBody& whole, const RangeOfMotion& range, const BodyPose& before, const BodyPose& lying,
            const RisingClip& clip, const ClipEntry& entry, double fps)
      : whole_(whole),
        range_(range),
        before_(before),
        lying_(lying),
        clip_(clip),
        entry_(entry),
        fps_(fps),
        trunk_(trunk_skin(whole)),
        support_(support_skin(whole)),
        hands_(hand_skin(whole)),
        move_s_(std::clamp(entry.needed_s, ClipEntry::kShortest_s, ClipEntry::kLongest_s)) {}

  LedGetUp rise();

 private:
  Charted charted(const FigurePose& figure) const { return {figure, whole_.charts(figure.joints)}; }
  void take_clip(LedGetUp& result);
  FigurePose clip_at(double clip_s) const;
  double clip_time(double time_s) const;
  std::vector<FigurePose> references() const;
  void level(std::vector<FigurePose>& figures) const;
  /// 1 where hands alone bear, the rest being well over them; 0 where they may dip into the floor.
  double on_hands(const BodyPose& pose) const;
  double lowest_support(const BodyPose& pose) const;
  double settled(int frame) const { return 1.0 - min_jerk(frame / fps_ / kSettles_s); }
  PoseGoals goals_at(int frame, double likeness) const;
  void add_bearing(int frame, const BodyPose& alike, PoseGoals& goals) const;
  void add_arcs(int frame, const BodyPose& alike, PoseGoals& goals) const;
  void begin_as_he_lies(std::vector<FigurePose>& figures) const;
  std::vector<GetUpPhase> phases(const std::vector<BodyPose>& frames) const;

  const WholeBody& whole_;
  const RangeOfMotion& range_;
  const BodyPose& before_;
  const BodyPose& lying_;
  const RisingClip& clip_;
  const ClipEntry& entry_;
  double fps_;
  OuterSkin trunk_, support_, hands_;
  double move_s_;
  std::vector<FigurePose> led_;        // the clip from its entry on, in ranges, where it is taken up
  std::vector<FigurePose> reference_;  // per frame
  std::vector<BodyPose> alike_;        // its segments
  std::vector<BearingPoint> bearing_;
};

/// The clip in place, in its ranges; notes how far it was outside.
void ClipRiser::take_clip(LedGetUp& result) {
  for (std::size_t i = static_cast<std::size_t>(entry_.frame); i < clip_.frames.size(); ++i) {
    BodyPose pose = clip_.frames[i];
    for (Rigid& segment : pose) segment = entry_.world_from_clip * segment;
    const FigurePose figure = figure_pose(pose);
    const PerJoint<SwingTwist> charts = whole_.charts(figure.joints);
    for (int j = 0; j < kJointCount; ++j) {
      if (whole_.body().joints[j].fused) continue;
      const double outside = degrees(excess(range_.joints[j], charts[j]));
      if (outside <= result.clip_excess_deg) continue;
      result.clip_excess_deg = outside;
      result.clip_excess_joint = joint_at(j);
    }
    led_.push_back(whole_.inside(figure, kMargin));
  }
}

FigurePose ClipRiser::clip_at(double clip_s) const {
  const double at = std::clamp(clip_s * clip_.fps, 0.0, static_cast<double>(led_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), led_.size() - 1);
  if (i + 1 >= led_.size()) return led_.back();
  return between(whole_, led_[i], led_[i + 1], at - static_cast<double>(i));
}

/// Time of the clip after its entry: it stands still at first and runs as it was recorded when the difference
/// has faded.
double ClipRiser::clip_time(double time_s) const {
  const double starts_s = 0.35 * move_s_, ramp_s = move_s_ - starts_s;
  if (time_s <= starts_s) return 0.0;
  const double u = (time_s - starts_s) / ramp_s;
  if (u >= 1.0) return 0.5 * ramp_s + time_s - move_s_;
  return ramp_s * u * u * u * (1.0 - 0.5 * u);  // the integral of 3 u^2 - 2 u^3
}

std::vector<FigurePose> ClipRiser::references() const {
  const Charted was = charted(figure_pose(before_)), is = charted(figure_pose(lying_));
  const Charted first = charted(led_.front());
  const Fading place{is.figure.place - first.figure.place, fps_ * (is.figure.place - was.figure.place)};
  const Vec3 turn = log_rotation(is.figure.turn * first.figure.turn.conjugate());
  const Vec3 turning = fps_ * log_rotation(is.figure.turn * was.figure.turn.conjugate());
  const double clip_s = static_cast<double>(led_.size() - 1) / clip_.fps;
  std::vector<FigurePose> figures;
  for (int f = 0;; ++f) {
    const double time_s = f / fps_, carry_s = carried_s(time_s, std::min(move_s_, Fading::kCarryOn_s));
    const double left = 1.0 - min_jerk(time_s / move_s_);
    Charted now = charted(clip_at(clip_time(time_s)));
    now.figure.place += place.at(time_s, move_s_);
    now.figure.turn =
        (exp_rotation(left * turn) * exp_rotation(carry_s * turning) * now.figure.turn).normalized();
    for (int j = 0; j < kJointCount; ++j) {
      const auto fade = [&](auto part) -> decltype(part(is)) {
        return left * (part(is) - part(first)) + carry_s * fps_ * (part(is) - part(was));
      };
      now.charts[j].swing += fade([&](const Charted& c) { return Vec2(c.charts[j].swing); });
      now.charts[j].twist += fade([&](const Charted& c) { return c.charts[j].twist; });
    }
    now.figure.joints = whole_.joints(now.charts);
    figures.push_back(whole_.inside(now.figure, kBeyond));
    if (clip_time(time_s) >= clip_s) break;
  }
  return figures;
}

double ClipRiser::on_hands(const BodyPose& pose) const {
  const double over = lowest_of(support_, pose) - lowest_of(hands_, pose);
  return min_jerk((over / whole_.body().height_m - kHandsLower) / 0.08);
}

double ClipRiser::lowest_support(const BodyPose& pose) const {
  const double low = lowest_of(support_, pose);
  return low + on_hands(pose) * (lowest_of(hands_, pose) - low);
}

/// Something always bears in a get-up: figures are moved up or down until it does.
void ClipRiser::level(std::vector<FigurePose>& figures) const {
  const int last = static_cast<int>(figures.size()) - 1;
  std::vector<double> lift;
  for (int f = 0; f <= last; ++f)
    lift.push_back(settled(f) * std::min(0.02, lowest_support(lying_)) -
                   lowest_support(whole_.segments(figures[f])));
  const int reach = std::max(1, static_cast<int>(std::lround(kLevelling_s * fps_)));
  for (int f = 0; f <= last; ++f) {
    const int around = std::min({reach, f, last - f});
    double sum = 0.0;
    for (int k = f - around; k <= f + around; ++k) sum += lift[k];
    figures[f].place.y() += sum / (2 * around + 1);
  }
}

/// Parts that bear stay where they do; before and after they are led there and away.
void ClipRiser::add_bearing(int frame, const BodyPose& alike, PoseGoals& goals) const {
  const double ease = kEase_s * fps_, holds = kHolds_s * fps_;
  for (const BearingPoint& point : bearing_) {
    for (const Bearing& rest : point.rests) {
      const double outside = std::max({0.0, rest.first - static_cast<double>(frame) - holds,
                                       frame - static_cast<double>(rest.last) - holds});
      if (outside >= ease) continue;
      const double progress = 1.0 - outside / ease, share = min_jerk(progress);
      const Vec3 own = alike[index(point.segment)] * point.point;
      Vec3 target = (1.0 - share) * own + share * rest.place;
      // The segment as it is turned, on the floor with its lowest skin.
      const double over = own.y() - whole_.lowest(alike, point.segment);
      const double lies = settled(frame) * std::min(0.0, whole_.lowest(lying_, point.segment));
      target.y() = (1.0 - share) * own.y() + share * (over + lies);
      const double w = growing(progress);
      goals.points.push_back({point.segment, point.point, target, w * Vec3(kPin, kTouch, kPin)});
    }
  }
}

/// A hand or a foot that has a way to go into reach is lifted over the floor.
void ClipRiser::add_arcs(int frame, const BodyPose& alike, PoseGoals& goals) const {
  const double share = frame / fps_ / move_s_;
  if (share >= 1.0) return;
  const double h = whole_.body().height_m;
  const auto there = std::min(alike_.size() - 1, static_cast<std::size_t>(std::lround(move_s_ * fps_)));
  for (const Segment s : {Segment::hand_l, Segment::hand_r, Segment::foot_l, Segment::foot_r}) {
    const std::size_t i = static_cast<std::size_t>(index(s));
    const Vec2 way = on_ground(alike_[there][i].translation - alike_.front()[i].translation);
    if (way.norm() < kLongWay * h) continue;
    const double up = std::min(kArc * h, 0.25 * way.norm()) * std::pow(std::sin(kPi * share), 2.0);
    const double low = whole_.lowest(alike, s);
    if (!(low < up)) continue;
    const Vec3 place = alike[i].translation + (up - low) * Vec3::UnitY();
    goals.points.push_back({s, Vec3::Zero(), place, Vec3(0.0, 80.0, 0.0)});
  }
}

PoseGoals ClipRiser::goals_at(int frame, double likeness) const {
  const double time_s = frame / fps_;
  PoseGoals goals;
  goals.margin = kBeyond + (kMargin - kBeyond) * min_jerk(time_s / kSettles_s);
  goals.likeness = reference_[frame];
  goals.likeness_weight.fill(likeness);
  goals.place_weight = Vec3::Constant(likeness);
  goals.turn_weight = 1.5 * likeness;
  goals.floor_m = settled(frame) * std::min(0.0, whole_.lowest(lying_));
  const BodyPose& alike = alike_[frame];
  add_bearing(frame, alike, goals);
  add_arcs(frame, alike, goals);
  if (const double weight = kStands * (1.0 - on_hands(alike)); weight > 0.0)
    goals.touches.push_back(
        {&support_, weight, settled(frame) * std::min(0.02, lowest_of(support_, lying_))});
  const double h = whole_.body().height_m;
  const double over = (lowest_of(trunk_, alike) - 0.005 * h) / (0.03 * h);
  const double bears = 1.0 - min_jerk(over);
  if (bears > 0.0)
    goals.touches.push_back({&trunk_, 150.0 * bears, settled(frame) * lowest_of(trunk_, lying_)});
  return goals;
}

/// What was changed of the lying pose is given back, and fades.
void ClipRiser::begin_as_he_lies(std::vector<FigurePose>& figures) const {
  constexpr double kFades_s = 0.3;
  const Charted want = charted(figure_pose(lying_)), is = charted(figures.front());
  const Vec3 turn = log_rotation(want.figure.turn * is.figure.turn.conjugate());
  for (std::size_t f = 0; f < figures.size(); ++f) {
    const double left = 1.0 - min_jerk(static_cast<double>(f) / fps_ / kFades_s);
    if (left <= 0.0) break;
    Charted now = charted(figures[f]);
    now.figure.place += left * (want.figure.place - is.figure.place);
    now.figure.turn = (exp_rotation(left * turn) * now.figure.turn).normalized();
    for (int j = 0; j < kJointCount; ++j) {
      now.charts[j].swing += left * (want.charts[j].swing - is.charts[j].swing);
      now.charts[j].twist += left * (want.charts[j].twist - is.charts[j].twist);
    }
    now.figure.joints = whole_.joints(now.charts);
    figures[f] = now.figure;
  }
}

std::vector<GetUpPhase> ClipRiser::phases(const std::vector<BodyPose>& frames) const {
  const double end_s = static_cast<double>(frames.size() - 1) / fps_;
  double rises_s = move_s_;
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (frames[f][0].translation.y() < 0.16 * whole_.body().height_m)
      rises_s = std::max(move_s_, static_cast<double>(f) / fps_);
  return {{"shifts", 0.0}, {"follows", move_s_}, {"rises", rises_s}, {"stands", end_s}};
}

LedGetUp ClipRiser::rise() {
  LedGetUp result;
  take_clip(result);
  reference_ = references();
  level(reference_);
  for (const FigurePose& figure : reference_) alike_.push_back(whole_.segments(figure));
  bearing_ = bearing_points(whole_, alike_, fps_);
  const int last = static_cast<int>(reference_.size()) - 1;
  std::vector<FigurePose> figures;
  for (int f = 0; f <= last; ++f) {
    const FigurePose from =
        f == 0 ? reference_[0] : carried_on(reference_[f - 1], figures[f - 1], reference_[f]);
    figures.push_back(whole_.reach(goals_at(f, 20.0), from, f == 0 ? 12 : 6));
  }
  begin_as_he_lies(figures);
  figures = smoothed(whole_, figures, 0.045 * fps_);
  for (int f = 0; f <= last; ++f) {
    PoseGoals goals = goals_at(f, 40.0);
    goals.likeness = figures[f];
    goals.floor_weight = 800.0;
    figures[f] = whole_.inside(whole_.reach(goals, figures[f], 5), kBeyond);
  }
  begin_as_he_lies(figures);
  figures = smoothed(whole_, figures, 0.03 * fps_);
  GetUp& get_up = result.get_up;
  get_up.frames.push_back(lying_);
  for (int f = 1; f <= last; ++f)
    get_up.frames.push_back(whole_.segments(whole_.inside(figures[f], kBeyond)));
  get_up.fps = fps_;
  get_up.route = "clip";
  get_up.phases = phases(get_up.frames);
  for (const BearingPoint& point : bearing_)
    for (const Bearing& rest : point.rests)
      get_up.planted.push_back({point.segment, point.point, rest.place, rest.first, rest.last});
  return result;
}

}  // namespace

LedGetUp rise_by_clip(const WholeBody& whole, const RangeOfMotion& range, const BodyPose& before,
                      const BodyPose& lying, const RisingClip& clip, const ClipEntry& entry, double fps) {
  return ClipRiser(whole, range, before, lying, clip, entry, fps).rise();
}

}  // namespace ukemi
