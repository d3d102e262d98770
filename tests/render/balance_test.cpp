// Foot prints, support and capture point of motions made by hand.
#include "render/balance.h"

#include <gtest/gtest.h>

#include "simulate/standing_man.h"

namespace ukemi::test {
namespace {

constexpr double kFps = 60.0;

/// A man of whom only what the floor marks look at is there.
struct Walker {
  StandingMan man;
  Clip clip;
  std::vector<BodyPose> poses;
  Shot shot;

  /// Stands still for `frames` frames, moved by `at`; with `right_foot_ahead` m between his feet.
  void stand(int frames, const Vec3& at, double right_foot_ahead) {
    BodyPose pose = man.segments;
    for (Rigid& segment : pose) segment.translation += at;
    pose[index(Segment::foot_r)].translation += right_foot_ahead * (pose[0].rotation * Vec3::UnitX());
    poses.insert(poses.end(), static_cast<std::size_t>(frames), pose);
  }
  FloorMarks marks() {
    clip.fps = kFps;
    clip.frames.resize(poses.size());
    shot.clip = &clip;
    shot.body = &man.body;
    shot.segments = &poses;
    return FloorMarks(shot);
  }
};

std::size_t triangles(const Geometry& geometry) { return geometry.indices.size() / 3; }

std::size_t prints_at(const FloorMarks& marks, int frame) {
  Geometry geometry;
  marks.add_prints(geometry, frame);
  return triangles(geometry) / 2;
}

TEST(FloorMarks, AFootThatMovesOnLeavesAPrintWhereItStood) {
  Walker walker;
  walker.stand(20, Vec3::Zero(), 0.0);
  walker.stand(20, Vec3::Zero(), 0.3);
  const FloorMarks marks = walker.marks();
  EXPECT_EQ(prints_at(marks, 0), 2u);
  EXPECT_EQ(prints_at(marks, 39), 3u);
}

TEST(FloorMarks, WhoIsInTheAirLeavesNone) {
  Walker walker;
  walker.stand(20, Vec3(0.0, 0.5, 0.0), 0.0);
  EXPECT_EQ(prints_at(walker.marks(), 19), 0u);
}

/// Middle of the capture ring: the last piece's last 24 squares.
Vec3 capture_point(const Geometry& geometry) {
  constexpr std::size_t kRing = 24 * 6;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = geometry.vertices.size() - kRing; i < geometry.vertices.size(); ++i)
    sum += geometry.vertices[i].position;
  return (sum / static_cast<float>(kRing)).cast<double>();
}

TEST(FloorMarks, TheCapturePointIsAheadOfAMovingBody) {
  constexpr double kSpeed_m_s = 1.0;
  Walker walker;
  for (int f = 0; f < 3; ++f) walker.stand(1, Vec3(kSpeed_m_s * f / kFps, 0.0, 0.0), 0.0);
  const FloorMarks marks = walker.marks();
  Geometry moving;
  marks.add_support(moving, walker.shot, 1);
  Walker still;
  still.stand(3, Vec3(kSpeed_m_s / kFps, 0.0, 0.0), 0.0);
  const FloorMarks still_marks = still.marks();
  Geometry resting;
  still_marks.add_support(resting, still.shot, 1);
  const Vec3 ahead = capture_point(moving) - capture_point(resting);
  // His centre of mass is 0.9 to 1.05 m above the floor.
  EXPECT_GT(ahead.x(), std::sqrt(0.90 / 9.81));
  EXPECT_LT(ahead.x(), std::sqrt(1.05 / 9.81));
  EXPECT_NEAR(ahead.z(), 0.0, 1e-4);
}

}  // namespace
}  // namespace ukemi::test
