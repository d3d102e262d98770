#include "render/drawn_character.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

/// Two bones along y; one vertex of each kind of weight at (1, 1.5, 0).
struct Arm {
  Character character;
  Clip clip;
  Shot shot;

  Arm() {
    character.skeleton.nodes = {{"upper", -1, {}}, {"lower", 0, {}}};
    character.skeleton.nodes[1].rest.translation = {0.0, 1.0, 0.0};
    EXPECT_TRUE(character.skeleton.sort());
    character.skins = {{{0, 1}, {Affine::Identity(), Affine(Eigen::Translation3d(0.0, -1.0, 0.0))}}};
    MeshPart part;
    part.skin = 0;
    part.positions.assign(3, {1.0f, 1.5f, 0.0f});
    part.normals.assign(3, {1.0f, 0.0f, 0.0f});
    part.joints.assign(3, {0, 1, 0, 0});
    part.weights = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}};
    part.indices = {0, 1, 2};
    character.parts = {part};
    Pose pose = rest_pose(character.skeleton);
    pose[1].rotation = Quat(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitZ()));
    clip.frames = {pose};
    shot.character = &character;
    shot.clip = &clip;
  }
};

TEST(DrawnCharacter, skins_as_the_formula_says) {
  const Arm arm;
  const Geometry body = DrawnCharacter(arm.shot, {}).body(0);
  ASSERT_EQ(body.vertices.size(), 3u);
  // A quarter turn about z at (0, 1, 0) takes (1, 1.5) to (-0.5, 2).
  const Eigen::Vector3f still(1.0f, 1.5f, 0.0f);
  const Eigen::Vector3f turned(-0.5f, 2.0f, 0.0f);
  EXPECT_LT((body.vertices[0].position - still).norm(), 1e-6f);
  EXPECT_LT((body.vertices[1].position - turned).norm(), 1e-6f);
  EXPECT_LT((body.vertices[2].position - 0.5f * (still + turned)).norm(), 1e-6f);
  EXPECT_LT((body.vertices[1].normal.normalized() - Eigen::Vector3f::UnitY()).norm(), 1e-6f);
}

TEST(DrawnCharacter, stands_in_metres_with_y_up) {
  Arm arm;
  arm.character.metres_per_unit = 0.01;
  arm.character.yup_from_file = Quat(Eigen::AngleAxisd(-0.5 * kPi, Vec3::UnitX()));
  const DrawnCharacter figure(arm.shot, {});
  EXPECT_LT((figure.body(0).vertices[0].position - Eigen::Vector3f(0.01f, 0.0f, -0.015f)).norm(), 1e-7f);
  EXPECT_LT((figure.joints(0)[1] - Vec3(0.0, 0.0, -0.01)).norm(), 1e-12);
}

TEST(DrawnCharacter, shows_the_bones_beside_a_mesh_that_shows_little) {
  Arm arm;
  arm.character.parts[0].node = 0;
  const std::size_t whole = DrawnCharacter(arm.shot, {}).body(0).vertices.size();
  EXPECT_EQ(whole, 3u) << "the mesh alone";
  for (Eigen::Vector3f& p : arm.character.parts[0].positions) p *= 0.001f;
  arm.character.skins.clear();
  arm.character.parts[0].skin = -1;
  arm.character.parts[0].positions[1].x() += 0.5f;
  EXPECT_GT(DrawnCharacter(arm.shot, {}).body(0).vertices.size(), whole) << "a sliver";
}

TEST(DrawnCharacter, hangs_rigid_parts_on_their_nodes) {
  Arm arm;
  arm.character.parts[0].skin = -1;
  arm.character.parts[0].node = 1;
  const Geometry body = DrawnCharacter(arm.shot, {}).body(0);
  for (const Vertex& vertex : body.vertices)
    EXPECT_LT((vertex.position - Eigen::Vector3f(-1.5f, 2.0f, 0.0f)).norm(), 1e-6f);
}

TEST(DrawnCharacter, keeps_normals_perpendicular_under_uneven_scale) {
  Arm arm;
  arm.character.parts[0].skin = -1;
  arm.character.parts[0].node = 0;
  arm.character.parts[0].normals.assign(3, Eigen::Vector3f(1.0f, 1.0f, 0.0f));
  arm.clip.frames[0][0].scale = {2.0, 1.0, 1.0};
  const Eigen::Vector3f normal = DrawnCharacter(arm.shot, {}).body(0).vertices[0].normal;
  // The plane's direction (1, -1, 0) becomes (2, -1, 0).
  EXPECT_NEAR(normal.dot(Eigen::Vector3f(2.0f, -1.0f, 0.0f)), 0.0f, 1e-6f);
}

TEST(DrawnCharacter, says_when_a_part_is_mirrored) {
  Arm arm;
  EXPECT_FALSE(DrawnCharacter(arm.shot, {}).body(0).pieces.at(0).surface.mirrored);
  arm.clip.frames[0][0].scale = {-1.0, 1.0, 1.0};
  EXPECT_TRUE(DrawnCharacter(arm.shot, {}).body(0).pieces.at(0).surface.mirrored);
}

TEST(DrawnCharacter, without_mesh_and_body_is_drawn_as_bones) {
  Arm arm;
  arm.character.parts.clear();
  const Geometry body = DrawnCharacter(arm.shot, {}).body(0);
  ASSERT_FALSE(body.indices.empty());
  float top = 0.0f;
  for (const Vertex& vertex : body.vertices) top = std::max(top, vertex.position.y());
  EXPECT_NEAR(top, 1.0f, 1e-5f);
}

TEST(DrawnCharacter, draws_no_bone_from_the_file_s_origin_to_the_hips) {
  Arm arm;
  arm.character.parts.clear();
  Humanoid humanoid;
  humanoid.root = 1;
  arm.shot.humanoid = &humanoid;
  EXPECT_TRUE(DrawnCharacter(arm.shot, {}).body(0).indices.empty());
  humanoid.root = 0;
  EXPECT_FALSE(DrawnCharacter(arm.shot, {}).body(0).indices.empty());
}

TEST(DrawnCharacter, of_a_skin_without_joints_stays_on_its_node) {
  Arm arm;
  arm.character.skins[0].joints.clear();
  arm.character.parts[0].node = 0;
  arm.character.parts[0].joints.clear();
  EXPECT_LT(
      (DrawnCharacter(arm.shot, {}).body(0).vertices[0].position - Eigen::Vector3f(1.0f, 1.5f, 0.0f)).norm(),
      1e-6f);
}

TEST(DrawnCharacter, shows_segments_instead_of_bones_and_over_a_mesh) {
  Arm arm;
  ArticulatedBody body;
  body.segments[0].shapes = {{ShapeKind::capsule, {}, 0.1, 0.5, Vec3::Zero()}};
  const std::vector<BodyPose> segments(1);
  arm.shot.body = &body;
  arm.shot.segments = &segments;
  EXPECT_TRUE(DrawnCharacter(arm.shot, {}).geometry(0).overlay.indices.empty());
  EXPECT_FALSE(DrawnCharacter(arm.shot, {.shapes = true}).geometry(0).overlay.indices.empty());

  arm.character.parts.clear();
  const FrameGeometry alone = DrawnCharacter(arm.shot, {}).geometry(0);
  EXPECT_TRUE(alone.overlay.indices.empty());
  float top = 0.0f;
  for (const Vertex& vertex : alone.solid.vertices) top = std::max(top, vertex.position.y());
  EXPECT_NEAR(top, 0.35f, 1e-5f) << "half the length and the cap";
}

TEST(Geometry, pieces_cover_the_indices_in_order) {
  const Arm arm;
  std::vector<Prop> props(2);
  props[0].radius = 0.1;
  props[0].poses.resize(1);
  props[1].kind = Prop::Kind::box;
  props[1].size = Vec3::Ones();
  props[1].poses.resize(1);
  Shot shot = arm.shot;
  shot.props = &props;
  const Geometry solid = DrawnCharacter(shot, {}).geometry(0).solid;
  ASSERT_EQ(solid.pieces.size(), 3u);
  std::uint32_t next = 0;
  for (const Piece& piece : solid.pieces) {
    EXPECT_EQ(piece.first, next);
    next += piece.count;
  }
  EXPECT_EQ(next, solid.indices.size());
}

TEST(Geometry, fronts_point_outwards) {
  Geometry geometry;
  geometry.begin({});
  add_capsule(geometry, {}, 0.2, 0.4, {});
  add_ball(geometry, {}, 0.3, {}, {});
  add_box(geometry, {}, Vec3::Constant(0.5), {});
  add_octahedron(geometry, -0.5 * Vec3::UnitY(), 0.5 * Vec3::UnitY(), 0.1, {});
  int looked_at = 0;
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
    const auto corner = [&](int k) { return geometry.vertices[geometry.indices[i + k]].position; };
    const Eigen::Vector3f normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (normal.norm() < 1e-9f) continue;  // at the poles
    EXPECT_GT(normal.dot(corner(0) + corner(1) + corner(2)), 0.0f);
    ++looked_at;
  }
  EXPECT_GT(looked_at, 1000);
}

}  // namespace
}  // namespace ukemi
