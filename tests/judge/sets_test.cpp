#include "judge/sets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "judge/stick_man.h"

namespace ukemi {
namespace {

std::optional<bool> passed(const std::vector<Criterion>& criteria, int number) {
  for (const Criterion& criterion : criteria)
    if (criterion.number == number) return criterion.passed;
  return std::nullopt;
}

SetMember stepped(double momentum_n_s, double azimuth_deg, int steps) {
  SetMember member;
  member.momentum_n_s = momentum_n_s;
  member.azimuth_deg = azimuth_deg;
  member.judgement.outcome = steps > 0 ? JudgedOutcome::stepped : JudgedOutcome::stood;
  for (int i = 0; i < steps; ++i) member.judgement.steps.push_back({i % 2, 0, 0, 0.3, 0.5, 0.3, 0.1});
  return member;
}

/// Onto the belly, a knee and a hand first.
SetMember fallen(double pelvis_m_s, bool head) {
  SetMember member = stepped(150.0, 180.0, 2);
  member.judgement.outcome = JudgedOutcome::fell;
  FallEvents fall;
  fall.pelvis = {60, 1.0, pelvis_m_s};
  fall.pelvis_down = true;
  fall.hand = Contact{54, 0.9, 1.0};
  fall.knee = Contact{48, 0.8, 1.0};
  fall.elbow_deg = 130.0;
  fall.front_up = -0.8;
  if (head) fall.head = Contact{66, 1.1, 1.0};
  member.judgement.fall = fall;
  return member;
}

TEST(Sets, GentleBlowsMoveNoFoot) {
  EXPECT_EQ(passed(set_criteria({}), 1), std::nullopt);
  EXPECT_EQ(passed(set_criteria({stepped(6, 0, 0), stepped(10, 180, 0), stepped(10, 90, 0)}), 1), true);
  EXPECT_EQ(passed(set_criteria({stepped(6, 0, 0), stepped(6, 270, 1)}), 1), false);
  EXPECT_EQ(passed(set_criteria({stepped(10, 0, 0), stepped(10, 0, 1)}), 1), true);
  EXPECT_EQ(passed(set_criteria({stepped(10, 0, 0), stepped(10, 0, 1), stepped(10, 0, 1)}), 1), false);
}

TEST(Sets, StrengthShows) {
  EXPECT_EQ(passed(set_criteria({stepped(15, 0, 1)}), 3), std::nullopt);
  EXPECT_EQ(passed(set_criteria({stepped(25, 0, 3), stepped(30, 90, 2), stepped(70, 0, 5)}), 3), true);
  EXPECT_EQ(passed(set_criteria({stepped(30, 90, 3)}), 3), false);
  EXPECT_EQ(passed(set_criteria({stepped(25, 0, 0)}), 3), false);
  EXPECT_EQ(passed(set_criteria({stepped(150, 0, 4)}), 3), false);
  EXPECT_EQ(passed(set_criteria({fallen(2.0, false)}), 3), true);
}

TEST(Sets, FallsAreJudgedTogether) {
  const auto soft = set_criteria({fallen(1.5, false), fallen(2.5, true), fallen(2.0, true)});
  for (const int number : {13, 14, 15, 16}) EXPECT_EQ(passed(soft, number), true) << number;
  const auto hard = set_criteria({fallen(2.6, true), fallen(2.7, true)});
  EXPECT_EQ(passed(hard, 13), false);  // each in its band, the mean is not
  EXPECT_EQ(passed(hard, 14), false);
  SetMember late = fallen(2.0, false);
  late.judgement.fall->hand.reset();
  late.judgement.fall->knee->time_s = 0.98;
  EXPECT_EQ(passed(set_criteria({late}), 15), false);
  EXPECT_EQ(passed(set_criteria({late}), 16), false);
}

TEST(Sets, ALivingBodyIsPassiveAtFirstAndNotLater) {
  const auto moved_from = [](double begin_s) {
    return stick_motion(1.0, [begin_s](double time_s, BodyPose& pose) {
      shift(pose, Segment::head, Vec3(0.2 * eased(time_s, begin_s, begin_s + 0.3), 0.0, 0.0));
    });
  };
  const JudgedMotion limp = moved_from(5.0);
  EXPECT_EQ(latency_criterion(moved_from(0.60), limp, 0.5).passed, true);
  EXPECT_EQ(latency_criterion(moved_from(0.45), limp, 0.5).passed, false);  // before anyone can
  EXPECT_EQ(latency_criterion(limp, limp, 0.5).passed, false);              // never
}

TEST(Sets, SeedsDifferLikePeople) {
  const auto seeds = [](double lift_spread_s, double length_spread_m, int left_of_ten) {
    std::vector<Judgement> judgements;
    for (int i = 0; i < 10; ++i) {
      const double off = (i % 2 == 0 ? -1.0 : 1.0) * std::sqrt(0.9);  // standard deviation 1
      Judgement judgement;
      judgement.impact_s = 0.1;
      judgement.steps = {
          {i < left_of_ten ? 0 : 1, 0, 0, 0.4 + lift_spread_s * off, 0.7, 0.3 + length_spread_m * off, 0.1}};
      judgements.push_back(judgement);
    }
    return spread_criterion(judgements);
  };
  EXPECT_NEAR(*seeds(0.03, 0.05, 4).clauses[0].value, 0.03, 1e-12);
  EXPECT_EQ(seeds(0.03, 0.05, 4).passed, true);
  EXPECT_EQ(seeds(0.005, 0.05, 4).passed, false);
  EXPECT_EQ(seeds(0.03, 0.01, 4).passed, false);
  EXPECT_EQ(seeds(0.03, 0.05, 1).passed, false);
  EXPECT_EQ(spread_criterion({}).passed, std::nullopt);
}

}  // namespace
}  // namespace ukemi
