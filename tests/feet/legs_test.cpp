#include "feet/legs.h"

#include <gtest/gtest.h>

#include "simulate/standing_man.h"

namespace ukemi {
namespace {

Vec3 ankle_of(const Leg& leg, const LegPosture& posture, const Vec3& hip, const BodyPose& home) {
  const Rigid thigh = home[index(leg.thigh)];
  const Rigid shank = home[index(leg.shank)];
  const Vec3 knee = hip + posture.thigh * (thigh.inverse() * shank.translation);
  return knee + posture.shank * (shank.inverse() * home[index(leg.foot)].translation);
}

TEST(Legs, ReachReproducesTheHomePosture) {
  const test::StandingMan man;
  for (const BodySide side : kSides) {
    const Leg leg(man.body, man.segments, side);
    const LegPosture posture = leg.reach(man.segments[index(leg.thigh)].translation,
                                         man.segments[index(leg.foot)].translation, 0.0, 0.0);
    EXPECT_LT(angle_between(posture.thigh, man.segments[index(leg.thigh)].rotation), 1e-6);
    EXPECT_LT(angle_between(posture.shank, man.segments[index(leg.shank)].rotation), 1e-6);
  }
}

TEST(Legs, ReachPutsTheAnkleWhereItIsWanted) {
  const test::StandingMan man;
  const Leg leg(man.body, man.segments, BodySide::right);
  const Vec3 hip = man.segments[index(leg.thigh)].translation - Vec3(0.0, 0.12, 0.0);
  const Vec3 ankle = man.segments[index(leg.foot)].translation + Vec3(0.2, 0.05, 0.1);
  const LegPosture posture = leg.reach(hip, ankle, 0.0, 0.3);
  EXPECT_LT((ankle_of(leg, posture, hip, man.segments) - ankle).norm(), 0.005);
  // The knee bends forwards.
  EXPECT_GT((posture.thigh * -Vec3::UnitY()).x(), (ankle - hip).normalized().x());
}

TEST(Legs, ReachOfWhatIsTooFarStretchesTowardsIt) {
  const test::StandingMan man;
  const Leg leg(man.body, man.segments, BodySide::left);
  const Vec3 hip = man.segments[index(leg.thigh)].translation;
  const Vec3 ankle = hip + Vec3(0.0, -3.0, 0.0);
  const Vec3 reached = ankle_of(leg, leg.reach(hip, ankle, 0.0, 0.0), hip, man.segments);
  EXPECT_NEAR((reached - hip).norm(), leg.length_m(), 0.002);
}

TEST(Legs, SolesLieBelowTheFootAndShrinkByTheirMargin) {
  const test::StandingMan man;
  const Leg leg(man.body, man.segments, BodySide::right);
  Senses senses;
  senses.pose = man.segments;
  const auto whole = leg.sole_corners(senses, 0.0);
  const auto shrunk = leg.sole_corners(senses, 0.01);
  EXPECT_NEAR((whole[0] - whole[1]).norm() - (shrunk[0] - shrunk[1]).norm(), 0.02, 1e-6);
  EXPECT_GT((whole[0] - whole[1]).norm(), 0.15);
  EXPECT_NEAR(leg.lowest_corner(senses), 0.0, 0.03);
}

}  // namespace
}  // namespace ukemi
