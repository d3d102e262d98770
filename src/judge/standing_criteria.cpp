#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantile.h"
#include "body/on_ground.h"
#include "judge/criteria.h"

namespace ukemi {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kGravity = 9.81;
constexpr double kReaction_s = 1.0;  // in which the head's way peaks
// The momenta that the criteria name, with 5 % to either side.
constexpr double kLeastSway = 4.75, kMostSway = 10.5;     // N s: a man sways and keeps his feet
constexpr double kLeastFlinch = 7.6, kMostFlinch = 27.3;  // N s: a planted flinch
constexpr double kGentlePush = 0.15;                 // m/s of the centre of mass where no momentum is known
constexpr double kSwayed = 0.02, kSwaySpeed = 0.10;  // m, m/s: back again
constexpr double kFlinched = 0.25;                   // share of the peak: back again
constexpr double kHardPush = 0.5;                    // m/s: arms go out
constexpr double kArmRise = 0.15, kArmAside = 0.25;  // m
constexpr double kPlantedHeight = 0.03, kPlantedFor_s = 0.1;
constexpr double kFootOnFloor = 0.12, kHeel = 0.07, kToes = 0.08, kHalfFoot = 0.05, kAroundFeet = 0.05;  // m

/// The head's way against the pelvis since the blow.
std::vector<double> head_excursion(const BodyCourse& t, const Window& w) {
  std::vector<double> excursion;
  const Vec3 start = t.head[w.begin] - t.pelvis[w.begin];
  for (int f = w.begin; f < w.end; ++f) excursion.push_back((t.head[f] - t.pelvis[f] - start).norm());
  return excursion;
}

struct Peak {
  double value;
  int frame;  // since the blow
};

/// In the first second: later a person does something else.
Peak peak_of(const std::vector<double>& values, double fps) {
  const auto frames = std::min(values.size(), static_cast<std::size_t>(kReaction_s * fps) + 1);
  const auto top = std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(frames));
  return {*top, static_cast<int>(top - values.begin())};
}

/// Time after the blow from which on `held` is true to the end; nothing where it is not at the end.
template <typename Predicate>
std::optional<double> lasting_from(const BodyCourse& t, const Window& w, Predicate held) {
  int f = w.end;
  while (f > w.begin && held(f - 1)) --f;
  if (f == w.end) return std::nullopt;
  return (f - w.begin) / t.fps;
}

/// Largest change of the centre of mass's horizontal velocity in the first half second.
double push_of(const BodyCourse& t, const Window& w, const Course& com_velocity) {
  double push = 0.0;
  for (int f = w.begin; f < std::min(w.end, w.begin + frames_of(t, 0.5)); ++f)
    push = std::max(push, horizontal_norm(com_velocity[f] - com_velocity[w.begin]));
  return push;
}

Criterion sway(const Evidence& e, bool stepped, const Course& com_velocity) {
  constexpr std::string_view kName = "sways and returns";
  const BodyCourse& t = e.body;
  const auto momentum = e.momentum_n_s();
  const bool gentle = momentum ? *momentum >= kLeastSway && *momentum <= kMostSway
                               : !stepped && push_of(t, e.window, com_velocity) <= kGentlePush;
  if (!gentle) return not_applicable(2, kName);
  const auto away = [&](int f) { return horizontal_norm(t.com[f] - t.com[e.window.begin]); };
  double excursion = 0.0;
  for (int f = e.window.begin; f < e.window.end; ++f) excursion = std::max(excursion, away(f));
  const auto back = lasting_from(t, e.window, [&](int f) {
    return away(f) <= kSwayed && horizontal_norm(com_velocity[f]) < kSwaySpeed;
  });
  return judged(2, kName, {{"com_excursion_m", excursion, {0.01, 0.07}}, {"back_s", back, {0.0, 2.0}}});
}

Criterion step_times(const Evidence& e, const std::vector<Step>& steps) {
  constexpr std::string_view kName = "steps in time";
  if (steps.empty()) return not_applicable(4, kName);
  const double blow_s = time_of(e.body, e.window.begin);
  const Step& first = steps.front();
  return judged(4, kName,
                {{"lift_s", first.lift_s - blow_s, {0.18, 0.45}},
                 {"swing_s", first.contact_s - first.lift_s, {0.12, 0.45}},
                 {"contact_s", first.contact_s - blow_s, {0.33, 0.90}}});
}

/// How far the feet reach beyond the extrapolated centre of mass (Hof 2005: x + v sqrt(h / g), h the height
/// of the centre of mass), the way that it goes, metres.
double margin_of_stability(const BodyCourse& t, int frame, const Vec3& com_velocity) {
  const Vec3 ahead = t.com[frame] + com_velocity * std::sqrt(std::max(0.5, t.com[frame].y()) / kGravity);
  const Vec3 way = Vec3(com_velocity.x(), 0.0, com_velocity.z()).stableNormalized();
  double margin = -kUnlimited;
  for (const LimbCourse& leg : t.legs)
    for (const Vec3& point : {leg.end[frame], leg.tip[frame]})
      margin = std::max(margin, (point - ahead).dot(way));
  return margin;
}

Criterion step_places(const Evidence& e, const std::vector<Step>& steps, const Course& com_velocity) {
  constexpr std::string_view kName = "steps where they catch";
  if (steps.empty()) return not_applicable(5, kName);
  const int last = steps.back().contact;
  return judged(5, kName,
                {{"length_m", steps.front().length_m, {0.08, 0.80}},
                 {"ankle_rise_m", steps.front().height_m, {0.02, 0.25}},
                 {"margin_m", margin_of_stability(e.body, last, com_velocity[last]), {-0.02, 0.35}}});
}

Clause head_peak_clause(const Peak& peak) { return {"head_against_pelvis_m", peak.value, {0.05, 0.65}}; }
Clause head_peak_time_clause(const BodyCourse& t, const Peak& peak) {
  return {"head_peak_s", peak.frame / t.fps, {0.10, 0.90}};
}

Criterion giving(const Evidence& e, bool stepped) {
  constexpr std::string_view kName = "head and trunk give";
  if (const auto momentum = e.momentum_n_s(); momentum && *momentum < kLeastFlinch)
    return not_applicable(6, kName);
  const BodyCourse& t = e.body;
  const Peak peak = peak_of(head_excursion(t, e.window), t.fps);
  double lean = 0.0;
  for (int f = e.window.begin; f < e.window.end; ++f) lean = std::max(lean, t.lean_deg[f]);
  return judged(6, kName,
                {{"lean_deg", lean, {0.0, stepped ? 80.0 : 60.0}},
                 head_peak_clause(peak),
                 head_peak_time_clause(t, peak)});
}

bool on_a_limb(Segment s) {
  return s != Segment::pelvis && s != Segment::abdomen && s != Segment::chest && s != Segment::head;
}

/// Time after the blow, behind the peak, at which the excursion is down to a share of it.
std::optional<double> fallen_to(const std::vector<double>& excursion, const Peak& peak, double fps) {
  for (int f = peak.frame; f < static_cast<int>(excursion.size()); ++f)
    if (excursion[f] <= kFlinched * peak.value) return f / fps;
  return std::nullopt;
}

/// How far pelvis, chest, head and ankles are from where they were at the blow, at most.
double off_stance(const BodyCourse& t, const Window& w) {
  double off = 0.0;
  for (const Course* course : {&t.pelvis, &t.chest, &t.head, &t.legs[0].end, &t.legs[1].end})
    off = std::max(off, ((*course)[w.end - 1] - (*course)[w.begin]).norm());
  return off;
}

Criterion flinch(const Evidence& e, bool stepped) {
  constexpr std::string_view kName = "planted flinch returns";
  const auto momentum = e.momentum_n_s();
  const bool other_blow = (momentum && (*momentum < kLeastFlinch || *momentum > kMostFlinch)) ||
                          (e.settings.hit && on_a_limb(*e.settings.hit));
  if (stepped || other_blow) return not_applicable(7, kName);
  const std::vector<double> excursion = head_excursion(e.body, e.window);
  const Peak peak = peak_of(excursion, e.body.fps);
  return judged(7, kName,
                {head_peak_clause(peak),
                 head_peak_time_clause(e.body, peak),
                 {"back_s", fallen_to(excursion, peak, e.body.fps), {0.0, 1.4}},
                 {"off_stance_m", off_stance(e.body, e.window), {0.0, 0.05}}});
}

/// Largest speed of a wrist against the chest.
double wrist_speed(const BodyCourse& t, const Window& w) {
  double fastest = 0.0;
  for (const LimbCourse& arm : t.arms) {
    Course way = arm.end;
    for (int f = 0; f < t.frames; ++f) way[f] -= t.chest[f];
    const std::vector<double> speed = norms(rate_of(low_passed(way, t.fps, 8.0), t.fps));
    for (int f = w.begin; f < w.end; ++f) fastest = std::max(fastest, speed[f]);
  }
  return fastest;
}

/// How far one wrist rises, or goes sideways from the chest, 0.15 to 0.60 s after the blow: the larger share
/// of what it should.
double arm_balance(const BodyCourse& t, const Window& w) {
  const int a = w.begin;
  const Vec3 across = t.arms[1].root[a] - t.arms[0].root[a];
  const Vec3 aside = Vec3(across.x(), 0.0, across.z()).stableNormalized();
  double share = 0.0;
  for (const LimbCourse& arm : t.arms)
    for (int f = a + frames_of(t, 0.15); f < std::min(w.end, a + frames_of(t, 0.60) + 1); ++f) {
      const Vec3 from_chest = (arm.end[f] - t.chest[f]) - (arm.end[a] - t.chest[a]);
      share = std::max(
          {share, (arm.end[f].y() - arm.end[a].y()) / kArmRise, std::abs(from_chest.dot(aside)) / kArmAside});
    }
  return share;
}

Criterion arms(const Evidence& e) {
  constexpr std::string_view kName = "arms react";
  const auto momentum = e.momentum_n_s();
  if (momentum && *momentum < kLeastFlinch) return not_applicable(8, kName);
  std::vector<Clause> clauses = {{"wrist_speed_m_s", wrist_speed(e.body, e.window), {0.5, 7.0}}};
  const double push = e.settings.momentum_n_s.value_or(0.0) / e.motion.mass_kg;
  if (push > kHardPush)
    clauses.push_back({"wrist_out_share", arm_balance(e.body, e.window), {1.0, kUnlimited}});
  return judged(8, kName, std::move(clauses));
}

std::vector<double> heights(const Course& course) {
  std::vector<double> result;
  for (const Vec3& point : course) result.push_back(point.y());
  return result;
}

/// Largest way of a foot while ankle and ball are within 3 cm of their lowest and it is slow.
double slide_of(const BodyCourse& t, const Window& w, const LimbCourse& leg) {
  const double ankle = quantile(heights(leg.end), 0.05), ball = quantile(heights(leg.tip), 0.05);
  const std::vector<double> speed = horizontal_norms(rate_of(low_passed(leg.end, t.fps, 10.0), t.fps));
  const auto planted = [&](int f) {
    return speed[f] < kPlantedSpeed_m_s &&
           std::max(leg.end[f].y() - ankle, leg.tip[f].y() - ball) < kPlantedHeight;
  };
  double slide = 0.0;
  for (int from = w.begin, to = 0; from < w.end; from = std::max(to, from + 1)) {
    for (to = from; to < w.end && planted(to); ++to) continue;
    if (to - from < kPlantedFor_s * t.fps) continue;
    for (int f = from; f < to; ++f) slide = std::max(slide, horizontal_norm(leg.end[f] - leg.end[from]));
  }
  return slide;
}

Criterion planted_feet(const Evidence& e) {
  const double slide =
      std::max(slide_of(e.body, e.window, e.body.legs[0]), slide_of(e.body, e.window, e.body.legs[1]));
  return judged(9, "planted feet stay", {{"slide_m", slide, {0.0, 0.04}}});
}

/// Corners of the soles on the floor, along x and z.
std::vector<Vec2> soles_on_floor(const BodyCourse& t, int frame) {
  std::vector<Vec2> corners;
  for (const LimbCourse& leg : t.legs) {
    const Vec3& ankle = leg.end[frame];
    const Vec3& ball = leg.tip[frame];
    if (std::min(ankle.y(), ball.y()) >= kFootOnFloor) continue;
    const Vec2 along = Vec2(ball.x() - ankle.x(), ball.z() - ankle.z()).stableNormalized();
    const Vec2 across(-along.y(), along.x());
    for (const double side : {kHalfFoot, -kHalfFoot}) {
      corners.push_back(Vec2(ankle.x(), ankle.z()) - kHeel * along + side * across);
      corners.push_back(Vec2(ball.x(), ball.z()) + kToes * along + side * across);
    }
  }
  return corners;
}

/// The centre of pressure is where gravity and the centre of mass's acceleration meet the floor; the spin is
/// left out.
Criterion pressure(const Evidence& e) {
  constexpr std::string_view kName = "feet bear what the body does";
  constexpr int kEdge = 4;           // frames of which the acceleration is not known well
  constexpr double kAirborne = 3.0;  // m/s^2 that the floor gives at least
  const BodyCourse& t = e.body;
  const Course com = low_passed(t.com, t.fps, 4.0);
  const Course acceleration = rate_of(rate_of(com, t.fps), t.fps);
  int borne = 0, all = 0;
  const int begin = std::max(e.window.begin + frames_of(t, 0.1), kEdge);
  for (int f = begin; f < std::min(e.window.end, t.frames - kEdge); ++f) {
    const double lift = kGravity + acceleration[f].y();
    if (lift < kAirborne) continue;
    ++all;
    const std::vector<Vec2> soles = soles_on_floor(t, f);
    if (soles.empty()) continue;
    const Vec3 point = com[f] - acceleration[f] * (com[f].y() / lift);
    borne += beyond(convex_hull(soles), Vec2(point.x(), point.z())) < kAroundFeet;
  }
  if (all == 0) return not_applicable(10, kName);
  return judged(10, kName, {{"share_of_frames", static_cast<double>(borne) / all, {0.85, 1.0}}});
}

}  // namespace

std::vector<Criterion> standing_criteria(const Evidence& evidence, const std::vector<Step>& steps) {
  const BodyCourse& t = evidence.body;
  const Course com_velocity = rate_of(low_passed(t.com, t.fps, 6.0), t.fps);
  const bool stepped = !steps.empty();
  return {sway(evidence, stepped, com_velocity),
          step_times(evidence, steps),
          step_places(evidence, steps, com_velocity),
          giving(evidence, stepped),
          flinch(evidence, stepped),
          arms(evidence),
          planted_feet(evidence),
          pressure(evidence)};
}

}  // namespace ukemi
