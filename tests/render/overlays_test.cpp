#include "render/overlays.h"

#include <gtest/gtest.h>

#include <set>

#include "render/boxy.h"
#include "render/drawn_character.h"

namespace ukemi {
namespace {

constexpr double kHalf = radians(40.0);

/// Every joint: a square of 40 degrees to all sides, twist 30 degrees to both, links along x.
RangeOfMotion square_ranges() {
  RangeOfMotion range;
  for (JointRange& joint : range.joints) {
    joint.polygon = {{kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}, {-kHalf, -kHalf}};
    joint.twist_min = radians(-30.0);
    joint.twist_max = radians(30.0);
  }
  return range;
}

/// Colour of the neck's cone when the head is turned by `chart`.
Rgba neck_color(const SwingTwist& chart) {
  const RangeOfMotion range = square_ranges();
  std::vector<BodyPose> segments(1);
  segments[0][index(Segment::head)].rotation = joint_rotation(chart);
  segments[0][index(Segment::head)].translation = {0.0, 5.0, 0.0};
  BoxyScene scene;
  scene.shot.segments = &segments;
  scene.shot.range = &range;
  Geometry geometry;
  add_range_cones(geometry, scene.shot, 0);
  for (const Vertex& vertex : geometry.vertices)
    if (vertex.position.y() > 4.0f) return vertex.color;
  return {};
}

TEST(Overlays, cone_is_amber_near_the_edge_and_red_outside) {
  const Rgba inside = neck_color({{radians(5.0), 0.0}, 0.0});
  const Rgba near = neck_color({{radians(38.0), radians(10.0)}, 0.0});
  const Rgba outside = neck_color({{radians(42.0), 0.0}, 0.0});
  EXPECT_GT(inside[1], inside[0]) << "green";
  EXPECT_GT(near[0], 0.6f);
  EXPECT_GT(near[1], 0.2f);
  EXPECT_GT(outside[0], 0.5f);
  EXPECT_LT(outside[1], 0.1f);
  EXPECT_EQ(neck_color({Vec2::Zero(), radians(29.0)}), near) << "twist counts too";
  EXPECT_EQ(neck_color({Vec2::Zero(), radians(-33.0)}), outside);
  EXPECT_EQ(neck_color({Vec2::Zero(), radians(20.0)}), inside);
}

TEST(Overlays, cone_reaches_as_far_as_the_polygon) {
  const RangeOfMotion range = square_ranges();
  std::vector<BodyPose> segments(1);
  BoxyScene scene;
  scene.shot.segments = &segments;
  scene.shot.range = &range;
  Geometry geometry;
  add_range_cones(geometry, scene.shot, 0);
  double widest = 0.0;
  for (const Vertex& vertex : geometry.vertices) {
    const Vec3 p = vertex.position.cast<double>();
    if (p.norm() > 0.15 && vertex.normal.isZero())
      widest = std::max(widest, std::acos(std::clamp(p.x() / p.norm(), -1.0, 1.0)));
  }
  EXPECT_NEAR(widest, std::sqrt(2.0) * kHalf, 1e-4) << "a corner's swing";
}

TEST(Overlays, fused_joints_have_none) {
  const RangeOfMotion range = square_ranges();
  const std::vector<BodyPose> segments(1);
  ArticulatedBody body;
  for (BodyJoint& joint : body.joints) joint.fused = true;
  BoxyScene scene;
  scene.shot.segments = &segments;
  scene.shot.range = &range;
  scene.shot.body = &body;
  Geometry geometry;
  add_range_cones(geometry, scene.shot, 0);
  add_joint_axes(geometry, scene.shot, 0);
  EXPECT_TRUE(geometry.indices.empty());
}

TEST(Overlays, axes_point_along_the_segment) {
  std::vector<BodyPose> segments(1);
  const Quat turn(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitY()));
  segments[0][index(Segment::head)] = {turn, {0.0, 5.0, 0.0}};
  BoxyScene scene;
  scene.shot.segments = &segments;
  Geometry geometry;
  add_joint_axes(geometry, scene.shot, 0);
  float forward = 0.0f;
  for (const Vertex& vertex : geometry.vertices)
    if (vertex.position.y() > 4.9f && vertex.color[0] > 2.0f * vertex.color[1])
      forward = std::min(forward, vertex.position.z());
  EXPECT_NEAR(forward, -0.085f, 0.006f) << "x turned by 90 degrees about y looks along -z";
}

TEST(Overlays, trail_leads_from_the_start_to_the_frame) {
  BoxyScene scene;
  const DrawnCharacter plain(scene.shot, {});
  const DrawnCharacter trailed(scene.shot, {.trail = true});
  EXPECT_EQ(trailed.geometry(0).solid.indices.size(), plain.geometry(0).solid.indices.size());
  const std::size_t ten = trailed.geometry(10).solid.indices.size() - plain.geometry(10).solid.indices.size();
  const std::size_t twenty =
      trailed.geometry(20).solid.indices.size() - plain.geometry(20).solid.indices.size();
  EXPECT_GT(ten, 0u);
  EXPECT_EQ(twenty, 2 * ten);
}

TEST(Geometry, tube_has_its_radius_and_follows_the_points) {
  Geometry geometry;
  geometry.begin({});
  add_tube(geometry, {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 0.1, {1, 1, 1, 1});
  for (const Vertex& vertex : geometry.vertices) {
    EXPECT_NEAR(std::hypot(vertex.position.x(), vertex.position.z()), 0.1, 1e-6);
    EXPECT_NEAR(vertex.normal.y(), 0.0, 1e-6);
  }
  EXPECT_EQ(geometry.pieces.back().count, geometry.indices.size());
  EXPECT_EQ(geometry.indices.size(), 2u * 7u * 6u);
}

}  // namespace
}  // namespace ukemi
