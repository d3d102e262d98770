#include "judge/judge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "judge/stick_man.h"

namespace ukemi {
namespace {

constexpr double kFrame = 1.0 / 60.0;

JudgeSettings blow_at(double time_s) {
  JudgeSettings settings;
  settings.impact_s = time_s;
  return settings;
}

JudgeSettings blow_of(double momentum_n_s) {
  JudgeSettings settings = blow_at(0.0);
  settings.momentum_n_s = momentum_n_s;
  return settings;
}

std::optional<double> value(const Judgement& judgement, int number, std::string_view clause) {
  const Criterion* criterion = find_criterion(judgement, number);
  if (criterion == nullptr) return std::nullopt;
  for (const Clause& c : criterion->clauses)
    if (c.name == clause) return c.value;
  return std::nullopt;
}

std::optional<bool> passed(const Judgement& judgement, int number) {
  const Criterion* criterion = find_criterion(judgement, number);
  return criterion == nullptr ? std::nullopt : criterion->passed;
}

void stand_still(double, BodyPose&) {}

/// The left foot goes 0.30 m forward and 0.10 m up, from 0.30 to 0.60 s.
void step_forward(double time_s, BodyPose& pose) {
  const double way = eased(time_s, 0.30, 0.60);
  shift(pose, Segment::foot_l, Vec3(0.30 * way, 0.10 * std::sin(kPi * way), 0.0));
  shift(pose, Segment::shank_l, Vec3(0.15 * way, 0.0, 0.0));
  shift_upper_body(pose, Vec3(0.05 * way, 0.0, 0.0));
}

TEST(Judgement, AKnownStepIsFoundWithItsTimesLengthAndHeight) {
  const Judgement judgement = judge(stick_motion(1.5, step_forward), blow_at(0.0));
  EXPECT_EQ(judgement.kind, ReactionKind::stand);
  EXPECT_EQ(judgement.outcome, JudgedOutcome::stepped);
  ASSERT_EQ(judgement.steps.size(), 1u);
  const Step& step = judgement.steps[0];
  EXPECT_EQ(step.side, 0);
  EXPECT_NEAR(step.lift_s, 0.30, 3 * kFrame);
  EXPECT_NEAR(step.contact_s, 0.60, 3 * kFrame);
  EXPECT_NEAR(step.length_m, 0.30, 0.005);
  EXPECT_NEAR(step.height_m, 0.10, 0.002);
  EXPECT_EQ(passed(judgement, 4), true);
  EXPECT_EQ(value(judgement, 5, "length_m"), step.length_m);
  EXPECT_EQ(passed(judgement, 7), std::nullopt);
}

TEST(Judgement, AStepThatComesTooEarlyFailsItsCriterion) {
  const Judgement judgement = judge(stick_motion(1.5, step_forward), blow_at(0.25));
  EXPECT_NEAR(*value(judgement, 4, "lift_s"), 0.05, 3 * kFrame);
  EXPECT_EQ(passed(judgement, 4), false);
}

TEST(Judgement, AStepLongAfterABlowOfUnknownStrengthIsNoAnswerToIt) {
  const auto late = [](double time_s, BodyPose& pose) { step_forward(time_s - 1.2, pose); };
  EXPECT_EQ(judge(stick_motion(2.5, late), blow_at(0.0)).outcome, JudgedOutcome::stood);
  EXPECT_EQ(judge(stick_motion(2.5, late), blow_of(30.0)).outcome, JudgedOutcome::stepped);
}

TEST(Judgement, APlantedFootsSlideIsMeasured) {
  const auto slide = [](double time_s, BodyPose& pose) {
    shift(pose, Segment::foot_r, Vec3(0.06 * eased(time_s, 0.2, 1.4), 0.0, 0.0));
  };
  const Judgement judgement = judge(stick_motion(2.0, slide), blow_at(0.0));
  EXPECT_NEAR(*value(judgement, 9, "slide_m"), 0.06, 1e-6);
  EXPECT_EQ(passed(judgement, 9), false);
  EXPECT_EQ(passed(judge(stick_motion(2.0, stand_still), blow_at(0.0)), 9), true);
}

TEST(Judgement, LeanAndHeadAreMeasuredAgainstThePelvis) {
  const auto lean = [](double time_s, BodyPose& pose) {  // hips to shoulders: 0.50 m
    const double forward = 0.5 * std::sin(radians(30.0)) * std::sin(kPi * eased(time_s, 0.0, 1.0));
    const double down = 0.5 - std::sqrt(0.25 - forward * forward);
    shift_upper_body(pose, Vec3(forward, -down, 0.0));
  };
  const Judgement judgement = judge(stick_motion(1.2, lean), blow_at(0.0));
  EXPECT_NEAR(*value(judgement, 6, "lean_deg"), 30.0, 0.01);
  EXPECT_NEAR(*value(judgement, 6, "head_against_pelvis_m"), 0.5 * 2.0 * std::sin(radians(15.0)), 1e-4);
  EXPECT_NEAR(*value(judgement, 6, "head_peak_s"), 0.5, 1e-9);
  EXPECT_EQ(passed(judgement, 6), true);
  EXPECT_EQ(passed(judgement, 7), true);
  EXPECT_NEAR(*value(judgement, 7, "off_stance_m"), 0.0, 1e-9);
}

TEST(Judgement, AFlinchThatStaysWhereItWasKnockedToFails) {
  const auto knocked = [](double time_s, BodyPose& pose) {
    shift_upper_body(pose, Vec3(-0.20 * eased(time_s, 0.0, 0.4), 0.0, 0.0));
  };
  const Judgement judgement = judge(stick_motion(2.0, knocked), blow_of(15.0));
  EXPECT_EQ(passed(judgement, 7), false);
  EXPECT_EQ(value(judgement, 7, "back_s"), std::nullopt);
  EXPECT_NEAR(*value(judgement, 7, "off_stance_m"), 0.20, 1e-9);
}

TEST(Judgement, SwayIsTheWayOfTheCentreOfMassAndTheTimeBack) {
  const auto sway = [](double time_s, BodyPose& pose) {
    shift_above_knees(pose, Vec3(0.05 * (eased(time_s, 0.0, 0.6) - eased(time_s, 0.8, 1.6)), 0.0, 0.0));
  };
  const Judgement judgement = judge(stick_motion(3.0, sway), blow_of(6.0));
  // All of head, trunk and arms, 0.59 of the thighs: 0.770 of the mass.
  EXPECT_NEAR(*value(judgement, 2, "com_excursion_m"), 0.05 * 0.770, 1e-4);
  EXPECT_NEAR(*value(judgement, 2, "back_s"), 1.2, 0.1);
  EXPECT_EQ(passed(judgement, 2), true);
  EXPECT_EQ(passed(judge(stick_motion(0.9, sway), blow_of(6.0)), 2), false);  // not back yet
}

TEST(Judgement, CriteriaApplyToTheBlowsThatTheyAreMadeFor) {
  const JudgedMotion still = stick_motion(1.0, stand_still);
  const auto applies = [&](double momentum_n_s, int number) {
    return passed(judge(still, blow_of(momentum_n_s)), number).has_value();
  };
  EXPECT_TRUE(applies(6.0, 2));
  EXPECT_FALSE(applies(20.0, 2));
  for (const int number : {6, 7, 8}) EXPECT_FALSE(applies(6.0, number)) << number;
  for (const int number : {6, 7, 8}) EXPECT_TRUE(applies(20.0, number)) << number;
  EXPECT_FALSE(applies(40.0, 7));
  JudgeSettings on_the_hand = blow_of(20.0);
  on_the_hand.hit = Segment::hand_l;
  EXPECT_EQ(passed(judge(still, on_the_hand), 7), std::nullopt);
}

TEST(Judgement, MomentaAreScaledToTheBody) {
  JudgedMotion light = stick_motion(1.0, stand_still);
  light.mass_kg = 78.0 / 4.0;
  EXPECT_TRUE(passed(judge(light, blow_of(2.0)), 2).has_value());
  EXPECT_FALSE(passed(judge(light, blow_of(6.0)), 2).has_value());
}

TEST(Judgement, LengthsAreScaledToTheBody) {
  JudgedMotion giant = stick_motion(1.5, step_forward);
  for (BodyPose& frame : giant.frames)
    for (Rigid& segment : frame) segment.translation *= 2.0;
  giant.ends.crown *= 2.0;
  for (Vec3& end : giant.ends.ball_of_foot) end *= 2.0;
  giant.height_m *= 2.0;
  const Judgement judgement = judge(giant, blow_at(0.0));
  ASSERT_EQ(judgement.steps.size(), 1u);
  EXPECT_NEAR(judgement.steps[0].length_m, 0.30, 0.005);
}

TEST(Judgement, ArmsThatHangAreNotThoseOfAPersonWhoIsPushed) {
  const auto raise = [](double time_s, BodyPose& pose) {
    shift(pose, Segment::hand_l, Vec3(0.0, 0.30 * eased(time_s, 0.1, 0.5), 0.0));
  };
  EXPECT_EQ(passed(judge(stick_motion(1.0, stand_still), blow_of(50.0)), 8), false);
  const Judgement judgement = judge(stick_motion(1.0, raise), blow_of(50.0));
  EXPECT_NEAR(*value(judgement, 8, "wrist_out_share"), 2.0, 1e-9);
  EXPECT_EQ(passed(judgement, 8), true);
  EXPECT_EQ(value(judge(stick_motion(1.0, raise), blow_of(20.0)), 8, "wrist_out_share"), std::nullopt);
}

TEST(Judgement, FeetBearABodyAboveThemAndNoneBesideThem) {
  const auto beside = [](double, BodyPose& pose) { shift_above_knees(pose, Vec3(1.0, 0.0, 0.0)); };
  EXPECT_EQ(value(judge(stick_motion(1.0, stand_still), blow_at(0.0)), 10, "share_of_frames"), 1.0);
  EXPECT_EQ(value(judge(stick_motion(1.0, beside), blow_at(0.0)), 10, "share_of_frames"), 0.0);
}

TEST(Judgement, AMirrorImageIsNoPerson) {
  const auto bent = [](double, BodyPose& pose) {
    const auto bend = [&](Segment end, double length_m, double angle_deg) {
      const double a = radians(angle_deg);
      shift(pose, end, length_m * Vec3(std::sin(a), 1.0 - std::cos(a), 0.0));
    };
    bend(Segment::hand_l, 0.25, 20.0);
    bend(Segment::foot_l, 0.42, -5.0);
  };
  EXPECT_EQ(passed(judge(stick_motion(1.0, stand_still), blow_at(0.0)), 11), false);
  const Judgement judgement = judge(stick_motion(1.0, bent), blow_at(0.0));
  EXPECT_NEAR(*value(judgement, 11, "elbow_deg"), 20.0, 1e-6);
  EXPECT_NEAR(*value(judgement, 11, "knee_deg"), 5.0, 1e-6);
  EXPECT_EQ(passed(judgement, 11), true);
}

TEST(Judgement, JointSpeedIsThatOfTheSegmentAgainstItsNeighbour) {
  const auto turning = [](double deg_s) {
    return [deg_s](double time_s, BodyPose& pose) {
      pose[index(Segment::hand_l)].rotation = exp_rotation(Vec3(radians(deg_s) * time_s, 0.0, 0.0));
    };
  };
  const Judgement slow = judge(stick_motion(1.0, turning(1000.0)), blow_at(0.0));
  EXPECT_NEAR(*value(slow, 20, "wrist_deg_s"), 1000.0, 1e-6);
  EXPECT_EQ(passed(slow, 20), true);
  EXPECT_EQ(passed(judge(stick_motion(1.0, turning(1500.0)), blow_at(0.0)), 20), false);
  JudgedMotion fused = stick_motion(1.0, turning(1500.0));
  fused.fused[index(Segment::hand_l)] = fused.fused[index(Segment::hand_r)] = true;
  EXPECT_EQ(passed(judge(fused, blow_at(0.0)), 20), true);
}

TEST(Judgement, JerkOfASwingingHeadIsThatOfTheSine) {
  const double amplitude = 0.02, omega = 2.0 * kPi * 2.0;
  const auto swing = [&](double time_s, BodyPose& pose) {
    shift(pose, Segment::head, Vec3(amplitude * std::sin(omega * time_s), 0.0, 0.0));
  };
  const Judgement judgement = judge(stick_motion(4.0, swing, 120.0), blow_at(0.0));
  const double expected = amplitude * omega * omega * omega;
  EXPECT_NEAR(*value(judgement, 21, "head_m_s3"), expected, 0.03 * expected);
  EXPECT_NEAR(*value(judgement, 21, "pelvis_m_s3"), 0.0, 1e-6);
}

/// All above the knees sinks by 0.82 m at a steady speed from 0.5 s on; the knees go forward.
Move sink(double speed_m_s) {
  return [speed_m_s](double time_s, BodyPose& pose) {
    const double down = std::clamp(speed_m_s * (time_s - 0.5), 0.0, 0.82);
    shift_above_knees(pose, Vec3(0.0, -down, 0.0));
    for (const Segment knee : {Segment::shank_l, Segment::shank_r}) shift(pose, knee, Vec3(0.5 * down, 0, 0));
  };
}

TEST(Judgement, ContactTimeAndSpeedOfASteadyFallAreKnown) {
  const Judgement judgement = judge(stick_motion(3.0, sink(1.5)), blow_at(0.0));
  EXPECT_EQ(judgement.kind, ReactionKind::fall);
  EXPECT_EQ(judgement.outcome, JudgedOutcome::fell);
  EXPECT_EQ(judgement.final_pose, JudgedPose::seated);
  ASSERT_TRUE(judgement.fall && judgement.fall->pelvis_down);
  const double contact_s = 0.5 + (0.92 - 0.20) / 1.5;
  EXPECT_NEAR(judgement.fall->pelvis.time_s, contact_s, 1.01 * kFrame);
  EXPECT_NEAR(judgement.fall->pelvis.speed_m_s, 1.5, 0.08);  // the filter overshoots before the stop
  EXPECT_NEAR(judgement.fall->fall_begins_s, 0.5, 0.1);
  ASSERT_TRUE(judgement.fall->rest_s);
  EXPECT_NEAR(*judgement.fall->rest_s, 0.5 + 0.82 / 1.5, 0.1);
  EXPECT_NEAR(*value(judgement, 12, "pelvis_s"), contact_s, 1.01 * kFrame);
  EXPECT_EQ(value(judgement, 14, "head_speed_m_s"), 0.0);
}

TEST(Judgement, ContactSpeedIsThatBeforeTheFloorStopsThePelvis) {
  const auto stopped = [](double time_s, BodyPose& pose) {
    shift_above_knees(pose, Vec3(0.0, -std::clamp(1.5 * (time_s - 0.5), 0.0, 0.725), 0.0));
  };
  const Judgement judgement = judge(stick_motion(3.0, stopped), blow_at(0.0));
  ASSERT_TRUE(judgement.fall && judgement.fall->pelvis_down);
  EXPECT_NEAR(judgement.fall->pelvis.speed_m_s, 1.5, 0.15);
}

TEST(Judgement, AKnockedOutManNeedsNoHands) {
  const JudgedMotion motion = stick_motion(3.0, sink(1.5));
  EXPECT_TRUE(passed(judge(motion, blow_at(0.0)), 15).has_value());
  JudgeSettings knocked_out = blow_at(0.0);
  knocked_out.knock_out = true;
  EXPECT_FALSE(passed(judge(motion, knocked_out), 15).has_value());
}

TEST(Judgement, WhoSinksAndRisesHasFallenAndGotUp) {
  const auto down_and_up = [](double time_s, BodyPose& pose) {
    const double down = 0.82 * (eased(time_s, 0.2, 1.2) - eased(time_s, 3.0, 5.0));
    shift_above_knees(pose, Vec3(0.0, -down, 0.0));
  };
  const Judgement judgement = judge(stick_motion(6.0, down_and_up), blow_at(0.0));
  EXPECT_EQ(judgement.outcome, JudgedOutcome::fell);
  EXPECT_EQ(judgement.final_pose, JudgedPose::standing);
  ASSERT_TRUE(judgement.get_up && judgement.get_up->stands_s);
  EXPECT_NEAR(judgement.get_up->begins_s, 3.5, 0.2);
  EXPECT_NEAR(*judgement.get_up->stands_s, 4.4, 0.2);
  EXPECT_TRUE(passed(judgement, 19).has_value());
}

TEST(Judgement, TheBlowIsFoundWhereTheHeadSetsOut) {
  const auto struck = [](double time_s, BodyPose& pose) {
    shift_upper_body(pose, Vec3(0.3 * eased(time_s, 0.7, 1.1), 0.0, 0.0));
  };
  const Judgement judgement = judge(stick_motion(2.0, struck));
  EXPECT_TRUE(judgement.impact_found);
  EXPECT_NEAR(judgement.impact_s, 0.74, 0.05);
}

TEST(Judgement, TheScoreIsTheShareOfWhatApplies) {
  EXPECT_EQ(score_of({}), 1.0);
  EXPECT_EQ(score_of({{1, "", {}, true}, {2, "", {}, false}, {3, "", {}, std::nullopt}}), 0.5);
}

TEST(Judgement, AMotionOfOneFrameIsJudged) {
  const Judgement judgement = judge(stick_motion(0.0, stand_still));
  EXPECT_EQ(judgement.outcome, JudgedOutcome::stood);
  EXPECT_TRUE(std::isfinite(judgement.score));
}

}  // namespace
}  // namespace ukemi
