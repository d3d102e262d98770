#include "judge/events.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr double kPelvisDown = 0.20, kHandDown = 0.10, kKneeDown = 0.10, kHeadDown = 0.17;  // m
constexpr double kPelvisUp = 0.25;  // m: has left the floor
constexpr double kLying = 0.35;     // m: height of the pelvis of a body that lies at the start
constexpr double kHeadFallen = 0.35;
constexpr double kContactFilter_hz = 12.0, kContactFilterShare = 0.4;  // at most this share of the rate
constexpr double kComFilter_hz = 6.0, kFootFilter_hz = 10.0;
constexpr double kSinking = 0.3;                          // m/s
constexpr double kQuiet = 0.25, kQuietFor_s = 0.25;       // m/s
constexpr double kStepFast = 0.35, kStepSlow = 0.18;      // m/s
constexpr double kStepLength = 0.06, kStepTime_s = 0.06;  // m
constexpr double kBegun = 0.08;                           // m
constexpr double kUprightShare = 0.85, kUprightLean_deg = 25.0, kUprightFor_s = 0.2;

double contact_filter(const BodyCourse& body) {
  return std::min(kContactFilter_hz, kContactFilterShare * body.fps);
}

Course velocity(const BodyCourse& body, const Course& course, double cutoff_hz) {
  return rate_of(low_passed(course, body.fps, cutoff_hz), body.fps);
}

/// First frame of [begin, end) that is so.
template <typename Predicate>
std::optional<int> first_frame(int begin, int end, Predicate predicate) {
  for (int f = begin; f < end; ++f)
    if (predicate(f)) return f;
  return std::nullopt;
}

double fastest_down(const Course& velocity, int begin, int end) {
  double fastest = 0.0;
  const int last = std::min(end, static_cast<int>(velocity.size()));
  for (int f = std::max(begin, 0); f < last; ++f) fastest = std::max(fastest, -velocity[f].y());
  return fastest;
}

Contact contact_at(const BodyCourse& body, int frame, double speed_m_s) {
  return {frame, time_of(body, frame), speed_m_s};
}

void add_steps(const BodyCourse& body, int side, std::vector<Step>& steps) {
  const LimbCourse& leg = body.legs[side];
  Course middle = leg.end;
  for (int f = 0; f < body.frames; ++f) middle[f] = 0.5 * (leg.end[f] + leg.tip[f]);
  const std::vector<double> speed = horizontal_norms(velocity(body, middle, kFootFilter_hz));
  std::optional<int> lift;
  for (int f = 0; f < body.frames; ++f) {
    if (!lift && speed[f] > kStepFast) {
      for (lift = f; *lift > 0 && speed[*lift] > kStepSlow; --*lift) continue;
    } else if (lift && speed[f] < kStepSlow) {
      Step step{side, *lift, f, time_of(body, *lift), time_of(body, f), 0.0, 0.0};
      step.length_m = horizontal_norm(leg.end[f] - leg.end[*lift]);
      for (int i = *lift; i <= f; ++i) step.height_m = std::max(step.height_m, leg.end[i].y());
      step.height_m -= std::min(leg.end[*lift].y(), leg.end[f].y());
      if (step.length_m > kStepLength && f - *lift > kStepTime_s * body.fps) steps.push_back(step);
      lift.reset();
    }
  }
}

/// Fastest of pelvis, head, wrists, knees and ankles in every frame.
std::vector<double> liveliest(const BodyCourse& body) {
  std::vector<double> fastest(body.frames, 0.0);
  std::vector<const Course*> points = {&body.pelvis, &body.head};
  for (int side = 0; side < 2; ++side)
    for (const Course* course : {&body.arms[side].end, &body.legs[side].middle, &body.legs[side].end})
      points.push_back(course);
  for (const Course* point : points) {
    const std::vector<double> speed = norms(velocity(body, *point, contact_filter(body)));
    for (int f = 0; f < body.frames; ++f) fastest[f] = std::max(fastest[f], speed[f]);
  }
  return fastest;
}

/// Frame from which on every value stays below a limit for this many frames; `end` where there is none.
int calm_from(const std::vector<double>& values, int begin, int end, int frames, double limit) {
  int calm = begin;
  for (int f = begin; f < end; ++f) {
    if (values[f] >= limit) calm = f + 1;
    if (f - calm + 1 >= frames) return calm;
  }
  return calm < end - 3 ? calm : end;
}

int begin_of_descent(const BodyCourse& body, const Window& window, int contact) {
  constexpr int kBottom = 3;  // frames before contact in which the body may already be stopped
  const Course com = velocity(body, body.com, kComFilter_hz);
  int f = contact;
  while (f > window.begin && (com[f].y() <= -kSinking || f >= contact - kBottom)) --f;
  return f;
}

std::optional<Contact> head_contact(const BodyCourse& body, const Window& window, const FallEvents& fall) {
  const int end = std::min(window.end, fall.pelvis.frame + frames_of(body, 1.5));
  const auto hit = first_frame(fall.descent, end, [&](int f) { return body.head[f].y() < kHeadDown; });
  if (!hit) return std::nullopt;
  const Course head = velocity(body, body.head, contact_filter(body));
  return contact_at(body, *hit, fastest_down(head, *hit - frames_of(body, 0.1), *hit + 2));
}

void find_hand(const BodyCourse& body, const Window& window, FallEvents& fall) {
  for (const LimbCourse& arm : body.arms) {
    const auto hit =
        first_frame(fall.descent, window.end, [&](int f) { return hand_height(arm, f) < kHandDown; });
    if (!hit || (fall.hand && fall.hand->frame <= *hit)) continue;
    const Course wrist = velocity(body, arm.end, contact_filter(body));
    fall.hand = contact_at(body, *hit, fastest_down(wrist, *hit - frames_of(body, 0.1), *hit + 2));
    fall.elbow_deg = 180.0 - flexion_deg(arm, *hit);
  }
}

void find_knee(const BodyCourse& body, const Window& window, FallEvents& fall) {
  for (const LimbCourse& leg : body.legs) {
    const auto hit =
        first_frame(fall.descent, window.end, [&](int f) { return leg.middle[f].y() < kKneeDown; });
    if (!hit || (fall.knee && fall.knee->frame <= *hit)) continue;
    const Course knee = velocity(body, leg.middle, contact_filter(body));
    fall.knee = contact_at(body, *hit, fastest_down(knee, *hit - frames_of(body, 0.1), *hit + 2));
  }
}

/// Frame in which the pelvis comes down; of one that stays in the air, in which knee or head do.
std::optional<int> landing(const BodyCourse& body, const Window& window) {
  const auto down =
      first_frame(window.begin, window.end, [&](int f) { return body.pelvis[f].y() < kPelvisDown; });
  if (down) return down;
  return first_frame(window.begin, window.end, [&](int f) {
    return body.head[f].y() < kHeadDown || body.legs[0].middle[f].y() < kKneeDown ||
           body.legs[1].middle[f].y() < kKneeDown;
  });
}

double highest_pelvis(const BodyCourse& body, const Window& window) {
  double top = 0.0;
  for (int f = window.begin; f < window.end; ++f) top = std::max(top, body.pelvis[f].y());
  return top;
}

bool upright(const BodyCourse& body, int frame, double top) {
  return body.pelvis[frame].y() > kUprightShare * top && body.lean_deg[frame] < kUprightLean_deg;
}

}  // namespace

std::string_view name(ReactionKind kind) {
  constexpr std::string_view kNames[] = {"stand", "fall", "getup"};
  return kNames[static_cast<int>(kind)];
}

std::string_view name(JudgedOutcome outcome) {
  constexpr std::string_view kNames[] = {"stood", "stepped", "fell"};
  return kNames[static_cast<int>(outcome)];
}

std::string_view name(JudgedPose pose) {
  constexpr std::string_view kNames[] = {"standing", "kneeling",  "seated",    "supine",
                                         "prone",    "left_side", "right_side"};
  return kNames[static_cast<int>(pose)];
}

std::vector<Step> steps_in(const BodyCourse& body, const Window& window) {
  std::vector<Step> steps;
  for (int side = 0; side < 2; ++side) add_steps(body, side, steps);
  std::erase_if(steps, [&](const Step& s) { return s.lift < window.begin || s.lift >= window.end; });
  std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.lift < b.lift; });
  return steps;
}

FallEvents fall_events(const BodyCourse& body, const Window& window) {
  FallEvents fall;
  const int contact = landing(body, window).value_or(window.end - 1);
  fall.pelvis_down = body.pelvis[contact].y() < kPelvisDown;
  const Course pelvis = velocity(body, body.pelvis, contact_filter(body));
  const int before = std::max(window.begin, contact - frames_of(body, 0.2));
  fall.pelvis = contact_at(body, contact, fastest_down(pelvis, before, contact + 3));
  fall.descent = begin_of_descent(body, window, contact);
  fall.fall_begins_s = time_of(body, fall.descent);
  fall.front_up = body.front[contact].y();
  fall.head = head_contact(body, window, fall);
  find_hand(body, window, fall);
  find_knee(body, window, fall);
  fall.rest = calm_from(liveliest(body), contact, window.end, frames_of(body, kQuietFor_s), kQuiet);
  if (fall.rest < window.end && upright(body, fall.rest, highest_pelvis(body, window)))
    fall.rest = window.end;
  if (fall.rest < window.end) fall.rest_s = time_of(body, fall.rest);
  return fall;
}

GetUpEvents get_up_events(const BodyCourse& body, const Window& window) {
  const int a = window.begin;
  const auto moved = [&](int f) {
    return std::max((body.pelvis[f] - body.pelvis[a]).norm(), (body.head[f] - body.head[a]).norm()) > kBegun;
  };
  GetUpEvents events;
  events.begin = first_frame(a, window.end, moved).value_or(a);
  events.leaves_floor = a;
  for (int f = a; f < window.end; ++f)
    if (body.pelvis[f].y() < kPelvisUp) events.leaves_floor = f;
  const double top = highest_pelvis(body, window);
  events.upright =
      first_frame(events.leaves_floor + 1, window.end, [&](int f) { return upright(body, f, top); });
  events.begins_s = time_of(body, events.begin);
  if (events.upright) events.stands_s = time_of(body, *events.upright);
  return events;
}

std::optional<GetUpEvents> get_up_after(const BodyCourse& body, const Window& window,
                                        const FallEvents& fall) {
  const double top = highest_pelvis(body, window);
  const int held = std::max(1, frames_of(body, kUprightFor_s));
  if (window.end - held <= fall.pelvis.frame) return std::nullopt;
  for (int f = window.end - held; f < window.end; ++f)
    if (!upright(body, f, top)) return std::nullopt;
  const int lying = fall.rest < window.end - held ? fall.rest : fall.pelvis.frame;
  return get_up_events(body, {lying, window.end});
}

ReactionKind kind_of(const BodyCourse& body, const Window& window) {
  if (body.pelvis[window.begin].y() < kLying) return ReactionKind::get_up;
  const auto down = first_frame(window.begin, window.end, [&](int f) {
    return body.pelvis[f].y() < kPelvisDown || body.head[f].y() < kHeadFallen;
  });
  return down ? ReactionKind::fall : ReactionKind::stand;
}

int find_blow(const BodyCourse& body, const Window& window) {
  constexpr double kStruck = 0.5, kBefore = 0.1;  // shares of the top speed
  const Course head = velocity(body, body.head, contact_filter(body));
  std::vector<double> speed(body.frames, 0.0);
  double top = 0.0;
  for (int f = window.begin; f < window.end; ++f) {
    speed[f] = (head[f] - head[window.begin]).norm();
    top = std::max(top, speed[f]);
  }
  const auto struck = first_frame(window.begin, window.end, [&](int f) { return speed[f] >= kStruck * top; });
  int blow = struck.value_or(window.begin);
  while (blow > window.begin && speed[blow] > kBefore * top) --blow;
  return blow;
}

JudgedPose final_pose(const BodyCourse& body, int frame) {
  const double pelvis = body.pelvis[frame].y();
  const bool knee_down = std::min(body.legs[0].middle[frame].y(), body.legs[1].middle[frame].y()) < 0.15;
  const bool on_trunk = body.lean_deg[frame] > 50.0;
  if (pelvis < 0.30 && !on_trunk)
    return knee_down && pelvis > 0.25 ? JudgedPose::kneeling : JudgedPose::seated;
  if (pelvis >= 0.22 && knee_down) return JudgedPose::kneeling;
  if (pelvis >= 0.30) return JudgedPose::standing;
  const double front_up = body.front[frame].y();
  if (front_up > 0.5) return JudgedPose::supine;
  if (front_up < -0.5) return JudgedPose::prone;
  const bool left_below = body.arms[0].root[frame].y() < body.arms[1].root[frame].y();
  return left_below ? JudgedPose::left_side : JudgedPose::right_side;
}

bool folded_on_face(const BodyCourse& body, int frame) {
  const bool knee_down = std::min(body.legs[0].middle[frame].y(), body.legs[1].middle[frame].y()) < 0.15;
  return knee_down && body.pelvis[frame].y() > kPelvisDown && body.head[frame].y() < 0.25 &&
         body.front[frame].y() < 0.0;
}

}  // namespace ukemi
