// How long steps are, which are taken back, what lies between them, and when rest is told.
#include "simulate/stepping.h"

#include <gtest/gtest.h>

#include "simulate/frames.h"
#include "simulate/rest.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

TEST(StepLength, IsLongOnlyAfterEightCalmStepsAndShortAgainAtOnce) {
  const Stepping stepping;
  StepLength length(stepping);
  for (int i = 0; i < 7; ++i) length.observe(2.9);
  EXPECT_EQ(length.next(8), stepping.base_ticks);
  length.observe(2.9);
  EXPECT_EQ(length.next(8), stepping.calm_ticks);
  EXPECT_EQ(length.next(12), stepping.base_ticks) << "long steps begin on their own grid";
  length.observe(3.1);
  EXPECT_EQ(length.next(8), stepping.base_ticks);
}

TEST(StepResult, IsBadFromSixMillimetresOrHalfADegreeOn) {
  EXPECT_FALSE((StepResult{{0.0, radians(0.49)}, 0.0059}).is_bad());
  EXPECT_TRUE((StepResult{{0.0, radians(0.51)}, 0.0}).is_bad());
  EXPECT_TRUE((StepResult{{0.0, 0.0}, 0.0061}).is_bad());
}

/// Whether a pair sinks that goes from one depth to another.
class Sinking : public ::testing::Test {
 protected:
  Sinking() {
    scene_.kind = SceneKind::none;
    scene_.direction = Vec3::UnitX();
    physics_.emplace(man_.body, man_.range, *load_active_thresholds(""), MuscleStrength{}, man_.start(),
                     scene_, PhysicsSettings{});
    pairs_ = physics_->find_contacts().depth.size();
    while (!physics_->is_floor(floor_)) ++floor_;
    while (physics_->is_floor(self_)) ++self_;
  }
  bool sinks(std::size_t pair, double from_m, double to_m) const {
    Contacts before, after;
    before.depth.assign(pairs_, 0.0);
    after.depth = before.depth;
    before.depth[pair] = from_m;
    after.depth[pair] = to_m;
    return ukemi::sinks(*physics_, before, after);
  }

  test::StandingMan man_;
  Scene scene_;
  std::optional<Physics> physics_;
  std::size_t pairs_ = 0, floor_ = 0, self_ = 0;
};

TEST_F(Sinking, OfAnyPairIsMoreThanEightMillimetresInAStep) {
  EXPECT_FALSE(sinks(self_, 0.010, 0.0179));
  EXPECT_TRUE(sinks(self_, 0.010, 0.0181));
  EXPECT_FALSE(sinks(self_, 0.030, 0.010)) << "rises";
}

TEST_F(Sinking, IntoTheFloorIsMoreThanTwoMillimetresOnceItIsFiveDeep) {
  EXPECT_FALSE(sinks(floor_, 0.0010, 0.0049));
  EXPECT_TRUE(sinks(floor_, 0.0030, 0.0051));
  EXPECT_FALSE(sinks(floor_, 0.0035, 0.0051));
}

TEST(Rest, IsSinceTheBeginningOfAQuarterOfASecondInWhichNothingMoves) {
  constexpr double kStep_s = 0.01;
  RestWatch rest;
  for (int i = 1; i <= 20; ++i) rest.observe(kStep_s * i, kStep_s, 0.019, 0.09);
  rest.observe(0.21, kStep_s, 0.0, 0.11);  // turns once
  for (int i = 22; i <= 45; ++i) {
    rest.observe(kStep_s * i, kStep_s, 0.019, 0.09);
    EXPECT_FALSE(rest.since_s()) << i;
  }
  for (int i = 46; i <= 47; ++i) rest.observe(kStep_s * i, kStep_s, 0.019, 0.09);
  ASSERT_TRUE(rest.since_s());
  EXPECT_NEAR(*rest.since_s(), 0.21, kStep_s + 1e-9);
}

/// A body and a ball a way along x, turned about y.
FrameWriter::State at(double x) {
  FrameWriter::State state;
  for (Rigid& segment : state.segments) segment = {exp_rotation(Vec3(0.0, x, 0.0)), Vec3(x, 0.0, 0.0)};
  state.props = {{exp_rotation(Vec3(0.0, x, 0.0)), Vec3(10.0 + x, 0.0, 0.0)}};
  return state;
}

TEST(Frames, LieBetweenTheStepsAndTheLastStateIsHeldToTheEnd) {
  FrameWriter frames(10.0, 0.5, 1.0 / 960.0, {Prop{}}, at(0.0));
  frames.add(0.04, at(0.4));
  frames.add(0.14, at(1.4));  // frame 1 lies 0.6 of the way
  frames.add(0.20, at(2.0));  // frame 2 on its end
  frames.hold();
  const double expected[] = {0.0, 1.0, 2.0, 2.0, 2.0, 2.0};
  ASSERT_EQ(frames.trajectory.frames.size(), 6u);
  ASSERT_EQ(frames.trajectory.props[0].poses.size(), 6u);
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_NEAR(frames.trajectory.frames[f][3].translation.x(), expected[f], 1e-12) << f;
    EXPECT_NEAR(log_rotation(frames.trajectory.frames[f][3].rotation).y(), expected[f], 1e-12) << f;
    EXPECT_NEAR(frames.trajectory.props[0].poses[f].translation.x(), 10.0 + expected[f], 1e-12) << f;
  }
}

}  // namespace
}  // namespace ukemi
