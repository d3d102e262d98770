// Criteria of every kind of clip.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/quantile.h"
#include "judge/criteria.h"

namespace ukemi {
namespace {

constexpr double kSpeedFilter_hz = 8.0, kJerkFilter_hz = 8.0;
constexpr int kEdge = 3;  // frames at a clip's ends whose third difference is not known

/// Joints of one kind and how fast one may turn, deg/s: the highest of captured falls and hits, and a little.
struct SpeedLimit {
  std::string_view name;
  std::array<std::pair<Segment, Segment>, 2> pairs;  // child, parent
  double most;
};

constexpr std::pair<Segment, Segment> kSpine{Segment::abdomen, Segment::pelvis};
constexpr std::pair<Segment, Segment> kTrunk{Segment::chest, Segment::pelvis};
constexpr std::pair<Segment, Segment> kNeck{Segment::head, Segment::chest};
constexpr std::array<SpeedLimit, 9> kSpeedLimits = {{
    {"spine_deg_s", {kSpine, kSpine}, 350.0},
    {"trunk_deg_s", {kTrunk, kTrunk}, 600.0},
    {"neck_deg_s", {kNeck, kNeck}, 1050.0},
    {"shoulder_deg_s",
     {{{Segment::upperarm_l, Segment::chest}, {Segment::upperarm_r, Segment::chest}}},
     1100.0},
    {"elbow_deg_s",
     {{{Segment::forearm_l, Segment::upperarm_l}, {Segment::forearm_r, Segment::upperarm_r}}},
     1150.0},
    {"wrist_deg_s", {{{Segment::hand_l, Segment::forearm_l}, {Segment::hand_r, Segment::forearm_r}}}, 1400.0},
    {"hip_deg_s", {{{Segment::thigh_l, Segment::pelvis}, {Segment::thigh_r, Segment::pelvis}}}, 780.0},
    {"knee_deg_s", {{{Segment::shank_l, Segment::thigh_l}, {Segment::shank_r, Segment::thigh_r}}}, 1080.0},
    {"ankle_deg_s", {{{Segment::foot_l, Segment::shank_l}, {Segment::foot_r, Segment::shank_r}}}, 930.0},
}};

double fastest_turn_deg_s(const JudgedMotion& motion, const Window& window,
                          const std::pair<Segment, Segment>& pair) {
  const auto relative = [&](std::size_t f) -> Quat {
    const BodyPose& frame = motion.frames[f];
    return frame[index(pair.second)].rotation.conjugate() * frame[index(pair.first)].rotation;
  };
  Course turns;
  turns.reserve(motion.frames.size());
  for (std::size_t f = 0; f + 1 < motion.frames.size(); ++f)
    turns.push_back(log_rotation(relative(f).conjugate() * relative(f + 1)) * motion.fps);
  const std::vector<double> speeds = norms(low_passed(turns, motion.fps, kSpeedFilter_hz));
  double fastest = 0.0;
  const int end = std::min(window.end, static_cast<int>(speeds.size()));
  for (int f = std::max(0, window.begin - 2); f < end; ++f) fastest = std::max(fastest, speeds[f]);
  return degrees(fastest);
}

double mean_difference(const BodyCourse& t, const Window& w, const std::array<LimbCourse, 2>& limbs) {
  double sum = 0.0;
  for (int f = w.begin; f < w.end; ++f) sum += std::abs(flexion_deg(limbs[0], f) - flexion_deg(limbs[1], f));
  return sum / std::max(1, std::min(w.end, t.frames) - w.begin);
}

struct JerkLimits {
  double pelvis, head;  // m/s^3
};

JerkLimits jerk_limits(ReactionKind kind) {
  switch (kind) {
    case ReactionKind::fall:
      return {800.0, 1300.0};
    case ReactionKind::get_up:
      return {500.0, 500.0};
    case ReactionKind::stand:
      break;
  }
  return {750.0, 1100.0};
}

std::vector<double> jerk_of(const BodyCourse& t, const Course& course) {
  const Course smooth = low_passed(course, t.fps, kJerkFilter_hz);
  return norms(rate_of(rate_of(rate_of(smooth, t.fps), t.fps), t.fps));
}

double p99_in(const std::vector<double>& jerk, const Window& w) {
  const int begin = w.begin + kEdge, end = std::min(w.end, static_cast<int>(jerk.size()) - kEdge);
  if (end <= begin) return 0.0;
  return quantile({jerk.begin() + begin, jerk.begin() + end}, 0.99);
}

/// The phase that is nearest to its limit speaks for the clip.
Clause jerk_clause(std::string_view name, const std::vector<double>& jerk, const std::vector<Phase>& phases,
                   double JerkLimits::*limit) {
  Clause worst{name, std::nullopt, {0.0, 0.0}};
  for (const Phase& phase : phases) {
    const double value = p99_in(jerk, phase.window), most = jerk_limits(phase.kind).*limit;
    if (!worst.value || value * worst.band.high > *worst.value * most) worst = {name, value, {0.0, most}};
  }
  return worst;
}

}  // namespace

Criterion judged(int number, std::string_view name, std::vector<Clause> clauses) {
  Criterion criterion{number, name, std::move(clauses)};
  criterion.passed = std::all_of(criterion.clauses.begin(), criterion.clauses.end(),
                                 [](const Clause& clause) { return clause.holds(); });
  return criterion;
}

Criterion not_applicable(int number, std::string_view name) { return {number, name, {}}; }

Criterion asymmetry_criterion(const BodyCourse& body, const Window& window) {
  return judged(11, "left differs from right",
                {{"knee_deg", mean_difference(body, window, body.legs), {2.0, 180.0}},
                 {"elbow_deg", mean_difference(body, window, body.arms), {3.0, 180.0}}});
}

Criterion joint_speed_criterion(const JudgedMotion& motion, const Window& window) {
  std::vector<Clause> clauses;
  for (const SpeedLimit& limit : kSpeedLimits) {
    double fastest = 0.0;
    bool moves = false;
    for (const auto& pair : limit.pairs) {
      if (motion.fused[index(pair.first)]) continue;
      moves = true;
      fastest = std::max(fastest, fastest_turn_deg_s(motion, window, pair));
    }
    if (moves) clauses.push_back({limit.name, fastest, {0.0, limit.most}});
  }
  return judged(20, "joints turn as fast as people's", std::move(clauses));
}

Criterion jerk_criterion(const BodyCourse& body, const std::vector<Phase>& phases) {
  return judged(21, "moves smoothly",
                {jerk_clause("pelvis_m_s3", jerk_of(body, body.pelvis), phases, &JerkLimits::pelvis),
                 jerk_clause("head_m_s3", jerk_of(body, body.head), phases, &JerkLimits::head)});
}

}  // namespace ukemi
