#include "body/body.h"

#include <Eigen/Eigenvalues>

#include "body/anthropometry.h"
#include "body/ground.h"
#include "body/shapes.h"
#include "simulate/standing_man.h"
#include "support/random.h"

namespace ukemi {
namespace {

TEST(Anthropometry, MassFractionsSumToTheWholeBody) {
  for (const Sex sex : {Sex::male, Sex::female}) {
    double sum = 0.0;
    for (int s = 0; s < kSegmentCount; ++s) sum += segment_table(segment_at(s), sex).mass_fraction;
    EXPECT_NEAR(sum, 1.0, 2e-4) << "the female column of the source sums to 0.9999";
  }
}

TEST(Anthropometry, MassesOfBothSexesGrowWithTheCubeOfTheHeight) {
  EXPECT_NEAR(default_mass_kg(1.741, Sex::male), 73.0, 1e-12);
  EXPECT_NEAR(default_mass_kg(1.735, Sex::female), 61.9, 1e-12);
  EXPECT_NEAR(default_mass_kg(2.0 * 1.741, Sex::male), 8.0 * 73.0, 1e-10);
}

TEST(Body, SegmentsHaveDeLevasMassesAndInertias) {
  const test::StandingMan man;
  const BodySegment& thigh = man.body.segments[index(Segment::thigh_l)];
  EXPECT_NEAR(thigh.mass_kg, 0.1416 * man.body.mass_kg, 1e-12);
  const double length =
      (man.segments[index(Segment::shank_l)].translation - man.segments[index(Segment::thigh_l)].translation)
          .norm();
  EXPECT_NEAR(thigh.inertia(0, 0), thigh.mass_kg * std::pow(0.329 * length, 2), 1e-9);
  EXPECT_NEAR(thigh.inertia(1, 1), thigh.mass_kg * std::pow(0.149 * length, 2), 1e-9);
  for (const BodySegment& segment : man.body.segments) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(segment.inertia);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0.0);
    EXPECT_LE(solver.eigenvalues()[2], solver.eigenvalues()[0] + solver.eigenvalues()[1] + 1e-12);
  }
}

TEST(Body, LeftAndRightAreMirrored) {
  const test::StandingMan man;
  for (int s = 0; s < kSegmentCount; ++s) {
    const BodySegment& here = man.body.segments[s];
    const BodySegment& there = man.body.segments[index(mirror_of(segment_at(s)))];
    EXPECT_DOUBLE_EQ(here.mass_kg, there.mass_kg);
    const Vec3 c = there.centre_of_mass;
    EXPECT_LT((here.centre_of_mass - Vec3(c.x(), c.y(), -c.z())).norm(), 1e-12);
    EXPECT_NEAR(here.shapes[0].radius, there.shapes[0].radius, 1e-12);
  }
}

TEST(Shapes, ACapsuleRecoversTheRadiusOfACylindricalLimb) {
  Random random(1);
  std::vector<Vec3> skin;
  const Vec3 end(0.0, -0.4, 0.0);
  for (int i = 0; i < 500; ++i) {
    const double angle = random.uniform(0.0, 2.0 * kPi);
    skin.push_back({0.06 * std::cos(angle), -random.uniform(0.0, 0.4), 0.06 * std::sin(angle)});
  }
  const Shape shape = fit_shapes(Segment::thigh_l, end, 1.75, skin).front();
  EXPECT_EQ(shape.kind, ShapeKind::capsule);
  EXPECT_NEAR(shape.radius, 0.06, 2e-4);
  EXPECT_NEAR(shape.length, 0.4, 1e-12);
  EXPECT_LT((shape.segment_from_shape * Vec3(0, 0.2, 0) - end).norm(), 5e-4);
}

TEST(Shapes, AFootBoxStandsOnItsSole) {
  std::vector<Vec3> skin;
  for (const double x : {-0.06, 0.0, 0.1, 0.2})
    for (const double y : {-0.08, -0.04, 0.0})
      for (const double z : {-0.04, 0.04}) skin.push_back({x, y, z});
  const Shape shape = fit_shapes(Segment::foot_l, {0.14, -0.05, 0.0}, 1.75, skin).front();
  EXPECT_NEAR(shape.segment_from_shape.translation.y() - 0.5 * shape.size.y(), -0.08, 1e-12);
  EXPECT_NEAR(shape.size.x(), 0.26, 1e-12);
}

TEST(Ground, FramesBelowTheFloorAreRaisedSmoothlyAndTheFirstStays) {
  PerSegment<std::vector<Vec3>> skin;
  skin[index(Segment::chest)] = {Vec3(0.0, -0.1, 0.0), Vec3(0.0, 0.1, 0.0)};
  std::vector<BodyPose> frames(121);
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (Rigid& segment : frames[i])
      segment.translation.y() = i < 60 ? 0.2 : 0.08;  // the skin is then 20 mm too low
  EXPECT_NEAR(lift_skin_above_floor(frames, 60.0, skin), 0.015, 1e-12);
  EXPECT_EQ(frames[0][0].translation.y(), 0.2);
  EXPECT_EQ(frames[30][0].translation.y(), 0.2);
  for (std::size_t i = 60; i < frames.size(); ++i) EXPECT_NEAR(frames[i][0].translation.y(), 0.095, 1e-12);
  for (std::size_t i = 40; i < 60; ++i)
    EXPECT_LT(frames[i][0].translation.y() - frames[i - 1][0].translation.y(), 0.0025) << "no pop";
}

TEST(Ground, NothingIsRaisedByMoreThanFourCentimetres) {
  PerSegment<std::vector<Vec3>> skin;
  skin[index(Segment::chest)] = {Vec3(0.0, -0.1, 0.0)};
  std::vector<BodyPose> frames(61);  // the first at the floor, then all 0.3 m below it
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (Rigid& segment : frames[i]) segment.translation.y() = i == 0 ? 0.1 : -0.2;
  EXPECT_NEAR(lift_skin_above_floor(frames, 60.0, skin), 0.040, 1e-12);
  EXPECT_NEAR(frames.back()[0].translation.y(), -0.16, 1e-12);
}

TEST(Ground, SkinThatSinksRightAfterTheStartIsLiftedAsFast) {
  std::vector<double> depth(60, 0.0);
  for (int i = 0; i < 8; ++i) depth[i] = 0.009 * i;  // a tail that swings into the floor at 0.54 m/s
  const std::vector<double> up = lifts(depth, 0.009, 0.25, 60.0);
  EXPECT_EQ(up[0], 0.0);
  for (int i = 0; i < 60; ++i) EXPECT_LT(depth[i] - up[i], 0.0191) << i;
  for (int i = 1; i < 60; ++i) EXPECT_LT(std::abs(up[i] - up[i - 1]), 0.009 + 1e-9) << i;
}

TEST(Ground, DeepSkinIsLiftedAsFastAsItIsDeep) {
  const std::vector<double> depth(60, 0.109);
  const std::vector<double> little = lifts(depth, 0.009, 0.04, 60.0), all = lifts(depth, 0.009, 0.25, 60.0);
  EXPECT_NEAR(little.back(), 0.04, 1e-9);
  EXPECT_NEAR(little[12], 0.02, 1e-9);
  EXPECT_NEAR(all.back(), 0.1, 1e-9);
  EXPECT_NEAR(all[12], 0.05, 1e-9);
  EXPECT_EQ(all[0], 0.0);
}

}  // namespace
}  // namespace ukemi
