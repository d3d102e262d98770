#include "render/camera.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace ukemi {
namespace {

Camera some_camera(double aspect) {
  Camera camera;
  camera.world_from_camera = look(radians(40.0), radians(15.0));
  camera.aspect = aspect;
  return camera;
}

TEST(Camera, looks_down_from_the_side_of_its_azimuth) {
  const Quat turn = look(radians(90.0), radians(30.0));
  const Vec3 back = turn * Vec3::UnitZ();
  EXPECT_NEAR((back - Vec3(std::cos(radians(30.0)), 0.5, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((turn * Vec3::UnitX()).y(), 0.0, 1e-12) << "the horizon is level";
}

TEST(Camera, projects_as_its_matrix_does) {
  Camera camera = some_camera(1.3);
  camera.eye = {1.0, 2.0, 5.0};
  const Vec3 point(0.3, 0.7, -0.2);
  const Eigen::Vector4f clip = camera.clip_from_world() * point.cast<float>().homogeneous();
  const Vec3 projected = camera.project(point);
  EXPECT_NEAR(clip.x() / clip.w(), projected.x(), 1e-5);
  EXPECT_NEAR(clip.y() / clip.w(), projected.y(), 1e-5);
  EXPECT_NEAR(clip.w(), projected.z(), 1e-5);
}

TEST(Framing, holds_every_point_and_touches_the_margin) {
  Random random(7);
  for (const double aspect : {0.4, 0.9, 2.5}) {
    Framing framing(some_camera(aspect), {0.1, 0.1, 0.1, 0.3});
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) {
      points.push_back(test::random_vector(random, 2.0).cwiseProduct(Vec3(1.0, 0.5, 1.0)));
      framing.add(points.back());
    }
    const Camera camera = framing.fit();
    double closest = 1.0;  // to a margin
    for (const Vec3& point : points) {
      const Vec3 p = camera.project(point);
      ASSERT_GT(p.z(), 0.0);
      closest = std::min({closest, 0.9 - std::abs(p.x()), p.y() + 0.9, 0.7 - p.y()});
    }
    EXPECT_NEAR(closest, 0.0, 1e-9);
  }
}

TEST(Framing, of_a_sphere_touches_its_outline) {
  Camera camera;  // looks along -z, aspect 1
  Framing framing(camera, {});
  framing.add(Vec3::Zero(), 0.5);
  // The cone of half angle a about a sphere of radius r has its tip at r / sin a.
  EXPECT_NEAR(framing.fit().eye.z(), 0.5 / std::sin(0.5 * camera.vertical_fov), 1e-12);
}

}  // namespace
}  // namespace ukemi
