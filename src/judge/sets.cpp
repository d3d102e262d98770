#include "judge/sets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "judge/criteria.h"

namespace ukemi {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 0.05;  // of the momenta that criteria name
constexpr double kSame = 0.01;       // m: of joints that move alike

enum class BlowSide { front, back, side };

BlowSide side_of(const SetMember& member) {
  const double ahead = std::cos(radians(member.azimuth_deg));
  if (ahead > 0.70) return BlowSide::front;
  return ahead < -0.70 ? BlowSide::back : BlowSide::side;
}

bool about(const SetMember& member, double low, double high) {
  return member.momentum_n_s >= low * (1.0 - kTolerance) && member.momentum_n_s <= high * (1.0 + kTolerance);
}

bool fell(const SetMember& member) { return member.judgement.outcome == JudgedOutcome::fell; }

/// How many of those that count are as they should be.
struct Tally {
  int good = 0, all = 0;

  void count(bool is_good) {
    good += is_good;
    ++all;
  }
  Clause clause(std::string_view name, double least) const {
    return {name, static_cast<double>(good) / all, {least, 1.0}};
  }
};

Criterion of(int number, std::string_view name, std::vector<Clause> clauses) {
  return clauses.empty() ? not_applicable(number, name) : judged(number, name, std::move(clauses));
}

Criterion feet_stay(const std::vector<SetMember>& members) {
  Tally gentle, at_the_limit;
  for (const SetMember& member : members) {
    const bool stood = member.judgement.outcome == JudgedOutcome::stood;
    if (about(member, 0.0, side_of(member) == BlowSide::front ? 6.0 : 10.0))
      gentle.count(stood);
    else if (about(member, 10.0, 10.0))
      at_the_limit.count(stood);
  }
  std::vector<Clause> clauses;
  if (gentle.all > 0) clauses.push_back(gentle.clause("gentle_stood_share", 1.0));
  if (at_the_limit.all > 0) clauses.push_back(at_the_limit.clause("front_10_n_s_stood_share", 0.5));
  return of(1, "gentle blows move no foot", std::move(clauses));
}

Criterion strength_shows(const std::vector<SetMember>& members) {
  Tally push, shove, blast;
  for (const SetMember& member : members) {
    const int steps = static_cast<int>(member.judgement.steps.size());
    const BlowSide side = side_of(member);
    if (side == BlowSide::front ? about(member, 20.0, 25.0) : about(member, 30.0, 30.0))
      push.count(!fell(member) && steps >= 1 && steps <= (side == BlowSide::side ? 2 : 3));
    if (about(member, 60.0, 80.0)) shove.count(fell(member) || (steps >= 2 && steps <= 5));
    if (about(member, 150.0, 1000.0)) blast.count(fell(member));
  }
  std::vector<Clause> clauses;
  if (push.all > 0) clauses.push_back(push.clause("push_stepped_share", 1.0));
  if (shove.all > 0) clauses.push_back(shove.clause("shove_stepped_or_fell_share", 1.0));
  if (blast.all > 0) clauses.push_back(blast.clause("blast_fell_share", 1.0));
  return of(3, "strength shows", std::move(clauses));
}

std::vector<const SetMember*> falls_of(const std::vector<SetMember>& members) {
  std::vector<const SetMember*> falls;
  for (const SetMember& member : members)
    if (fell(member) && member.judgement.fall) falls.push_back(&member);
  return falls;
}

struct Spread {
  double mean = 0.0, deviation = 0.0;  // of a sample
};

Spread spread_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Spread spread;
  for (const double value : values) spread.mean += value / n;
  for (const double value : values) spread.deviation += (value - spread.mean) * (value - spread.mean);
  spread.deviation = n > 1.0 ? std::sqrt(spread.deviation / (n - 1.0)) : 0.0;
  return spread;
}

Criterion landing_speed(const std::vector<const SetMember*>& falls) {
  constexpr std::string_view kName = "pelvis lands softly";
  std::vector<double> speeds;
  Tally each;
  bool knock_out = false;
  for (const SetMember* member : falls) {
    if (!member->judgement.fall->pelvis_down) continue;
    const double speed = member->judgement.fall->pelvis.speed_m_s;
    knock_out = knock_out || member->knock_out;
    each.count(speed >= 0.3 && speed <= (member->knock_out ? 3.6 : 2.8));
    speeds.push_back(speed);
  }
  if (speeds.empty()) return not_applicable(13, kName);
  const Band mean = knock_out ? Band{1.0, 3.6} : Band{1.3, 2.4};
  return judged(13, kName, {each.clause("in_band_share", 1.0), {"mean_m_s", spread_of(speeds).mean, mean}});
}

Criterion heads_off_floor(const std::vector<const SetMember*>& falls) {
  constexpr std::string_view kName = "heads stay off the floor";
  Tally off;
  for (const SetMember* member : falls) off.count(!member->judgement.fall->head);
  return off.all == 0 ? not_applicable(14, kName)
                      : judged(14, kName, {off.clause("no_contact_share", 1.0 / 3.0)});
}

Criterion hands(const std::vector<const SetMember*>& falls) {
  constexpr std::string_view kName = "hands catch";
  Tally in_time;
  std::vector<double> elbows;
  for (const SetMember* member : falls) {
    if (member->knock_out) continue;
    const FallEvents& fall = *member->judgement.fall;
    const double after = fall.hand ? fall.hand->time_s - fall.pelvis.time_s : kUnlimited;
    in_time.count(after >= -0.40 && after <= 0.15);
    if (fall.hand) elbows.push_back(fall.elbow_deg);
  }
  if (in_time.all == 0) return not_applicable(15, kName);
  std::vector<Clause> clauses = {in_time.clause("in_time_share", 2.0 / 3.0)};
  if (!elbows.empty()) clauses.push_back({"elbow_mean_deg", spread_of(elbows).mean, {115.0, 145.0}});
  return judged(15, kName, std::move(clauses));
}

Criterion knees(const std::vector<const SetMember*>& falls) {
  constexpr std::string_view kName = "knees first";
  constexpr double kOnBelly = -0.3;
  Tally first;
  for (const SetMember* member : falls) {
    const FallEvents& fall = *member->judgement.fall;
    if (member->knock_out || fall.front_up > kOnBelly) continue;
    const double before = fall.knee ? fall.pelvis.time_s - fall.knee->time_s : -kUnlimited;
    first.count(before >= 0.05 && before <= 0.35);
  }
  return first.all == 0 ? not_applicable(16, kName) : judged(16, kName, {first.clause("forward_share", 0.7)});
}

/// Largest distance between the joints of two frames.
double apart(const BodyPose& a, const BodyPose& b) {
  double most = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) most = std::max(most, (a[s].translation - b[s].translation).norm());
  return most;
}

}  // namespace

std::vector<Criterion> set_criteria(const std::vector<SetMember>& members) {
  const std::vector<const SetMember*> falls = falls_of(members);
  return {feet_stay(members),   strength_shows(members),
          landing_speed(falls), heads_off_floor(falls),
          hands(falls),         knees(falls)};
}

Criterion latency_criterion(const JudgedMotion& living, const JudgedMotion& limp, double impact_s) {
  constexpr double kPassive_s = 0.08, kActive_s = 0.15;
  double early = 0.0, late = 0.0;
  const std::size_t frames = std::min(living.frames.size(), limp.frames.size());
  for (std::size_t f = 0; f < frames; ++f) {
    const double since_s = static_cast<double>(f) / living.fps - impact_s;
    const double distance = apart(living.frames[f], limp.frames[f]) * kJudgedHeight / living.height_m;
    if (since_s <= kPassive_s + 1e-9) early = std::max(early, distance);
    if (since_s > kActive_s) late = std::max(late, distance);
  }
  return judged(22, "passive at first",
                {{"apart_early_m", early, {0.0, kSame}}, {"apart_later_m", late, {kSame, kUnlimited}}});
}

Criterion spread_criterion(const std::vector<Judgement>& seeds) {
  constexpr std::string_view kName = "seeds differ";
  std::vector<double> lifts, lengths;
  int left = 0;
  for (const Judgement& judgement : seeds) {
    if (judgement.steps.empty()) continue;
    const Step& first = judgement.steps.front();
    lifts.push_back(first.lift_s - judgement.impact_s);
    lengths.push_back(first.length_m);
    left += first.side == 0;
  }
  if (lifts.size() < 2) return not_applicable(23, kName);
  const auto steps = static_cast<double>(lifts.size());
  return judged(23, kName,
                {{"lift_deviation_s", spread_of(lifts).deviation, {0.015, 0.060}},
                 {"length_deviation_m", spread_of(lengths).deviation, {0.03, 0.10}},
                 {"rarer_foot_share", std::min<double>(left, steps - left) / steps, {0.2, 0.5}}});
}

}  // namespace ukemi
