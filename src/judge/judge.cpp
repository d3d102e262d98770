#include "judge/judge.h"

#include <algorithm>
#include <cmath>

#include "judge/criteria.h"

namespace ukemi {
namespace {

constexpr double kEarly_s = 0.05;     // a foot may be off that long before the blow
constexpr double kLastStep_s = 0.25;  // of the descent, in which a step still counts
constexpr double kAnswer_s = 0.9;     // within which a foot lifts that answers a blow, or follows such a one
constexpr double kMan_kg = 78.0, kMan_m = 1.78;  // the man that momenta are scaled to

int frame_at(const BodyCourse& body, double time_s, int low, int high) {
  return std::clamp(frames_of(body, time_s), low, high);
}

/// From the blow to the end of what is judged; fills the impact.
Window window_of(const BodyCourse& body, const JudgeSettings& settings, Judgement& judgement) {
  Window window{0, body.frames};
  if (settings.to_s) window.end = frame_at(body, *settings.to_s, 0, body.frames - 1) + 1;
  if (settings.from_s) window.begin = frame_at(body, *settings.from_s, 0, window.end - 1);
  judgement.impact_found = !settings.impact_s;
  if (settings.impact_s)
    window.begin = frame_at(body, *settings.impact_s, 0, window.end - 1);
  else if (settings.kind.value_or(kind_of(body, window)) != ReactionKind::get_up)
    window.begin = find_blow(body, window);
  judgement.impact_s = settings.impact_s.value_or(time_of(body, window.begin));
  return window;
}

std::vector<Step> steps_after_blow(const BodyCourse& body, const Window& window) {
  return steps_in(body, {std::max(0, window.begin - frames_of(body, kEarly_s)), window.end});
}

/// The first step that is no answer to the blow: it comes late, or long after the one before.
std::optional<int> own_step(const BodyCourse& body, const Window& window) {
  double answered_s = time_of(body, window.begin);
  for (const Step& step : steps_after_blow(body, window)) {
    if (step.lift_s - answered_s > kAnswer_s) return step.lift;
    answered_s = std::max(answered_s, step.contact_s);
  }
  return std::nullopt;
}

void add(std::vector<Criterion> more, Judgement& judgement) {
  for (Criterion& criterion : more) judgement.criteria.push_back(std::move(criterion));
}

void judge_standing(const Evidence& e, Judgement& judgement) {
  judgement.steps = steps_after_blow(e.body, e.window);
  judgement.outcome = judgement.steps.empty() ? JudgedOutcome::stood : JudgedOutcome::stepped;
  add(standing_criteria(e, judgement.steps), judgement);
  add({asymmetry_criterion(e.body, e.window), jerk_criterion(e.body, {{ReactionKind::stand, e.window}})},
      judgement);
}

void judge_fall(const Evidence& e, Judgement& judgement) {
  const FallEvents fall = fall_events(e.body, e.window);
  judgement.fall = fall;
  judgement.outcome = JudgedOutcome::fell;
  const int last_step = fall.descent + frames_of(e.body, kLastStep_s);
  judgement.steps = steps_after_blow(e.body, e.window);
  std::erase_if(judgement.steps, [&](const Step& step) { return step.lift >= last_step; });
  const int landed = std::max(fall.pelvis.frame, e.window.begin + 2);
  add({asymmetry_criterion(e.body, {e.window.begin, std::min(landed, e.window.end)})}, judgement);
  add(fall_criteria(e, fall), judgement);
  std::vector<Phase> phases = {{ReactionKind::fall, e.window}};
  judgement.get_up = get_up_after(e.body, e.window, fall);
  if (judgement.get_up) {
    const int begin = judgement.get_up->begin;
    phases = {{ReactionKind::fall, {e.window.begin, begin}}, {ReactionKind::get_up, {begin, e.window.end}}};
    add({get_up_criterion(e.body, e.window, *judgement.get_up)}, judgement);
  }
  add({jerk_criterion(e.body, phases)}, judgement);
}

void judge_get_up(const Evidence& e, Judgement& judgement) {
  judgement.get_up = get_up_events(e.body, e.window);
  judgement.outcome = judgement.get_up->upright ? JudgedOutcome::stood : JudgedOutcome::fell;
  add({get_up_criterion(e.body, e.window, *judgement.get_up),
       jerk_criterion(e.body, {{ReactionKind::get_up, e.window}})},
      judgement);
}

}  // namespace

std::optional<double> Evidence::momentum_n_s() const {
  if (!settings.momentum_n_s) return std::nullopt;
  return *settings.momentum_n_s / ((motion.mass_kg / kMan_kg) * std::sqrt(motion.height_m / kMan_m));
}

Judgement judge(const JudgedMotion& motion, const JudgeSettings& settings) {
  const BodyCourse body = body_course_of(motion);
  Judgement judgement;
  Window window = window_of(body, settings, judgement);
  judgement.kind = settings.kind.value_or(kind_of(body, window));
  // Where nothing is known of a clip, a late step belongs to something else.
  if (judgement.kind == ReactionKind::stand && !settings.momentum_n_s)
    window.end = own_step(body, window).value_or(window.end);
  const Evidence evidence{motion, body, settings, window};
  if (judgement.kind == ReactionKind::stand) judge_standing(evidence, judgement);
  if (judgement.kind == ReactionKind::fall) judge_fall(evidence, judgement);
  if (judgement.kind == ReactionKind::get_up) judge_get_up(evidence, judgement);
  add({joint_speed_criterion(motion, window)}, judgement);
  std::stable_sort(judgement.criteria.begin(), judgement.criteria.end(),
                   [](const Criterion& a, const Criterion& b) { return a.number < b.number; });
  judgement.final_pose = final_pose(body, window.end - 1);
  judgement.score = score_of(judgement.criteria);
  return judgement;
}

}  // namespace ukemi
