// What is read out of a gait.
#include "feet/gait.h"

#include <gtest/gtest.h>

#include "body/on_ground.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

constexpr double kStep_s = 1.0 / 120.0, kSpeed_m_s = 1.2, kStride_s = 0.5, kLong_s = 2.0;

/// A man who glides along x at 1.2 m/s while his feet take turns: each stands for half a second, and goes
/// twice as fast 10 cm above the ground for the next half. `floats_m`: all of it so far above the ground.
Gait gliding(double floats_m = 0.0) {
  const test::StandingMan man;
  const PerSide<Leg> legs{Leg(man.body, man.segments, BodySide::left),
                          Leg(man.body, man.segments, BodySide::right)};
  std::vector<BodyPose> frames;
  for (int f = 0; f * kStep_s < kLong_s; ++f) {
    const double time_s = f * kStep_s;
    BodyPose pose = man.segments;
    for (Rigid& segment : pose) segment.translation += Vec3(kSpeed_m_s * time_s, floats_m, 0.0);
    for (const BodySide side : kSides) {
      const double turn_s = std::fmod(time_s + (side == BodySide::left ? 0.0 : kStride_s), 2.0 * kStride_s);
      const bool stands = turn_s < kStride_s;
      Rigid& foot = pose[index(legs[index(side)].foot)];
      foot.translation.x() += stands ? -kSpeed_m_s * turn_s : kSpeed_m_s * (turn_s - 2.0 * kStride_s);
      if (!stands) foot.translation.y() += 0.1;
    }
    frames.push_back(pose);
  }
  return Gait(man.body, legs, frames, kStep_s, 9.81);
}

TEST(Gait, SaysWhenAndWhereFeetStand) {
  const Gait gait = gliding();
  EXPECT_NEAR(gait.speed(), kSpeed_m_s, 0.15);
  ASSERT_EQ(gait.stands(BodySide::left).size(), 2u);
  ASSERT_EQ(gait.stands(BodySide::right).size(), 2u);
  const Stand& left = gait.stands(BodySide::left)[1];
  EXPECT_NEAR(left.from_s, 1.0, 0.02);
  EXPECT_NEAR(left.until_s, 1.5, 0.02);
  const Stand& right = gait.stands(BodySide::right)[0];
  EXPECT_NEAR(right.from_s, 0.5, 0.02);
  EXPECT_NEAR(right.until_s, 1.0, 0.02);
  const Vec2 apart = left.sole - right.sole;
  EXPECT_NEAR(apart.x(), kSpeed_m_s * kStride_s, 0.02) << "a step";
  EXPECT_GT(gait.stands(BodySide::right)[1].until_s, 100.0) << "stands when the gait ends";
}

TEST(Gait, GoesEvenly) {
  const Gait gait = gliding();
  EXPECT_NEAR(gait.velocity(0.7).x(), kSpeed_m_s, 0.1);
  const double half = gait.pose(0.75 + 0.5 * kStep_s)[0].translation.x();
  EXPECT_NEAR(half - gait.pose(0.75)[0].translation.x(), 0.5 * kStep_s * kSpeed_m_s, 1e-6);
}

TEST(Gait, ThatFloatsIsBroughtToTheFloorAfterAMoment) {
  const Gait level = gliding(), floats = gliding(0.03);
  EXPECT_NEAR(floats.pose(0.0)[0].translation.y() - level.pose(0.0)[0].translation.y(), 0.03, 1e-6);
  EXPECT_NEAR(floats.pose(1.0)[0].translation.y() - level.pose(1.0)[0].translation.y(), 0.0, 0.002);
  EXPECT_EQ(floats.stands(BodySide::left).size(), 2u);
}

}  // namespace
}  // namespace ukemi
