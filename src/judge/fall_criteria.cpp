#include <algorithm>
#include <cmath>

#include "judge/criteria.h"

namespace ukemi {
namespace {

constexpr double kOnBack = 0.3;      // of front_up: the fall went backward
constexpr double kRestTime_s = 2.5;  // within which a body comes to rest

Criterion timing(const Evidence& e, const FallEvents& fall) {
  const double blow_s = time_of(e.body, e.window.begin);
  return judged(12, "falls in time",
                {{"pelvis_s", fall.pelvis.time_s - blow_s, {0.6, 3.0}},
                 {"descent_s", fall.pelvis.time_s - fall.fall_begins_s, {0.15, 0.80}}});
}

Criterion head_landing(const Evidence& e, const FallEvents& fall) {
  const double most = e.settings.knock_out ? 5.0 : 2.2;
  return judged(14, "head is spared",
                {{"head_speed_m_s", fall.head ? fall.head->speed_m_s : 0.0, {0.0, most}}});
}

Criterion catching(const Evidence& e, const FallEvents& fall) {
  constexpr std::string_view kName = "hands catch";
  if (e.settings.knock_out) return not_applicable(15, kName);
  std::optional<double> after, elbow;
  if (fall.hand) after = fall.hand->time_s - fall.pelvis.time_s, elbow = fall.elbow_deg;
  return judged(15, kName,
                {{"hand_after_pelvis_s", after, {-0.40, 0.15}}, {"elbow_deg", elbow, {80.0, 165.0}}});
}

Criterion yielding(const Evidence& e, const FallEvents& fall) {
  const BodyCourse& t = e.body;
  double knee = 0.0, hip = 0.0;
  for (int f = fall.descent; f <= fall.pelvis.frame; ++f)
    for (const LimbCourse& leg : t.legs) {
      knee = std::max(knee, flexion_deg(leg, f));
      hip = std::max(hip, flexion_deg(t.shoulders[f], t.hips[f], leg.middle[f]));
    }
  const bool limp = e.settings.knock_out;
  return judged(
      16, "knees and hips yield",
      {{"knee_deg", knee, {limp ? 20.0 : 80.0, 180.0}}, {"hip_deg", hip, {limp ? 20.0 : 50.0, 180.0}}});
}

/// The head's direction against the trunk's, forward, degrees.
double tuck_deg(const BodyCourse& t, int f) {
  const Vec3 head = t.crown[f] - t.head[f];
  return degrees(std::atan2(head.dot(t.front[f]), head.dot(t.up[f])));
}

Criterion tucking(const Evidence& e, const FallEvents& fall) {
  constexpr std::string_view kName = "chin is tucked";
  if (e.settings.knock_out || fall.front_up < kOnBack) return not_applicable(17, kName);
  const double tuck = tuck_deg(e.body, fall.pelvis.frame) - tuck_deg(e.body, e.window.begin);
  return judged(17, kName, {{"tuck_deg", tuck, {5.0, 180.0}}});
}

/// A clip that ends before the body rests says nothing about rest, unless the body still moves long after
/// the fall.
Criterion resting(const Evidence& e, const FallEvents& fall) {
  constexpr std::string_view kName = "comes to rest";
  const double folded = folded_on_face(e.body, e.window.end - 1) ? 1.0 : 0.0;
  const double seen_s = time_of(e.body, e.window.end - 1) - fall.pelvis.time_s;
  std::vector<Clause> clauses;
  if (fall.rest_s)
    clauses.push_back({"rest_s", *fall.rest_s - fall.pelvis.time_s, {0.6, kRestTime_s}});
  else if (seen_s > kRestTime_s)
    clauses.push_back({"rest_s", std::nullopt, {0.6, kRestTime_s}});
  if (!clauses.empty() || folded > 0.0) clauses.push_back({"folded_on_face", folded, {0.0, 0.0}});
  if (clauses.empty()) return not_applicable(18, kName);
  return judged(18, kName, std::move(clauses));
}

/// Share of the frames before the pelvis leaves the floor in which a hand is down.
double hand_bears(const BodyCourse& t, const GetUpEvents& g) {
  double most = 0.0;
  const int end = std::max(g.leaves_floor, g.begin + 1);
  for (const LimbCourse& arm : t.arms) {
    int down = 0;
    for (int f = g.begin; f < end; ++f) down += hand_height(arm, f) < 0.10;
    most = std::max(most, static_cast<double>(down) / (end - g.begin));
  }
  return most;
}

/// Half kneel, all fours or squat.
bool halfway(const BodyCourse& t, int f) {
  const double pelvis = t.pelvis[f].y();
  if (pelvis < 0.20 || pelvis > 0.75) return false;
  const double knee = std::min(t.legs[0].middle[f].y(), t.legs[1].middle[f].y());
  const double bend = std::min(flexion_deg(t.legs[0], f), flexion_deg(t.legs[1], f));
  return knee < 0.15 || bend > 80.0;
}

double halfway_s(const BodyCourse& t, const GetUpEvents& g, int end) {
  int frames = 0;
  for (int f = g.begin; f < end; ++f) frames += halfway(t, f);
  return frames / t.fps;
}

}  // namespace

std::vector<Criterion> fall_criteria(const Evidence& evidence, const FallEvents& fall) {
  return {timing(evidence, fall),   head_landing(evidence, fall), catching(evidence, fall),
          yielding(evidence, fall), tucking(evidence, fall),      resting(evidence, fall)};
}

Criterion get_up_criterion(const BodyCourse& body, const Window& window, const GetUpEvents& get_up) {
  const Course com = rate_of(low_passed(body.com, body.fps, 6.0), body.fps);
  double rise = 0.0;
  for (int f = get_up.begin; f < window.end; ++f) rise = std::max(rise, com[f].y());
  std::optional<double> duration, from_floor;
  const int end = get_up.upright.value_or(window.end);
  if (get_up.upright) {
    duration = (end - get_up.begin) / body.fps;
    from_floor = (end - get_up.leaves_floor) / body.fps;
  }
  return judged(19, "gets up",
                {{"duration_s", duration, {1.0, 6.0}},
                 {"pelvis_to_upright_s", from_floor, {0.6, 2.4}},
                 {"com_rise_m_s", rise, {0.4, 1.5}},
                 {"hand_bears_share", hand_bears(body, get_up), {0.15, 1.0}},
                 {"halfway_s", halfway_s(body, get_up, end), {0.1, 6.0}}});
}

}  // namespace ukemi
