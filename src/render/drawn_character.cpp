#include "render/drawn_character.h"

#include <algorithm>
#include <cmath>

#include "humanoid/skin.h"
#include "render/overlays.h"

namespace ukemi {
namespace {

const Rgba kClay = srgb(0xCDBFB0);    // a mesh without material
const Rgba kMiddle = srgb(0xC9B79F);  // segments: trunk and head
const Rgba kLeft = srgb(0x6FA3A8);    // the subject's left
const Rgba kRight = srgb(0xC98263);   // the subject's right
const Rgba kJointBall = srgb(0x5E5348);
const Rgba kBall = srgb(0xE07A3F);
const Rgba kBallBand = srgb(0x7A3B1D);
const Rgba kBox = srgb(0xD9A441);
constexpr float kOverlayAlpha = 0.5f;
constexpr float kGhostAlpha = 0.3f;

Affine file_to_world(const Shot& shot) {
  if (shot.humanoid != nullptr) return shot.humanoid->world_from_file.affine();
  Similarity similarity;
  similarity.scale = shot.character->metres_per_unit.value_or(1.0);
  similarity.rotation = shot.character->yup_from_file.value_or(Quat::Identity());
  return similarity.affine();
}

void add_unique(std::vector<int>& nodes, int node) {
  if (node >= 0 && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
}

std::vector<int> joint_nodes(const Shot& shot) {
  std::vector<int> nodes;
  if (shot.humanoid != nullptr) {
    for (const SegmentNodes& segment : shot.humanoid->segments)
      for (const int node : segment.chain) add_unique(nodes, node);
    add_unique(nodes, shot.humanoid->head_top);
    for (const int node : shot.humanoid->toes) add_unique(nodes, node);
    for (const int node : shot.humanoid->middle_finger) add_unique(nodes, node);
  }
  if (nodes.empty())
    for (const Skin& skin : shot.character->skins)
      for (const int node : skin.joints) add_unique(nodes, node);
  if (nodes.empty())
    for (int node = 0; node < shot.character->skeleton.size(); ++node) nodes.push_back(node);
  return nodes;
}

/// A joint's linear map for positions and the matching one for normals.
struct JointMap {
  Eigen::Matrix<float, 3, 4> position;
  Eigen::Matrix3f normal;

  explicit JointMap(const Affine& world_from_mesh)
      : position(world_from_mesh.matrix().topRows<3>().cast<float>()) {
    // Cofactors are the inverse transpose up to a factor, and exist for flat matrices too.
    const Mat3 m = world_from_mesh.linear();
    Mat3 cofactor;
    cofactor << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
    const double size = cofactor.norm();
    const double sign = m.determinant() < 0.0 ? -1.0 : 1.0;
    normal = (size > 0.0 ? Mat3(sign / size * cofactor) : Mat3(Mat3::Identity())).cast<float>();
  }
};

/// Maps of a part: one per joint of its skin, or the node's alone.
std::vector<JointMap> joint_maps(const Character& character, const MeshPart& part,
                                 const Affine& world_from_file, const std::vector<Affine>& file_from_node) {
  std::vector<JointMap> maps;
  if (part.skin < 0 || character.skins[part.skin].joints.empty()) {
    maps.emplace_back(part.node < 0 ? world_from_file : world_from_file * file_from_node[part.node]);
    return maps;
  }
  const Skin& skin = character.skins[part.skin];
  for (std::size_t i = 0; i < skin.joints.size(); ++i)
    maps.emplace_back(world_from_file * file_from_node[skin.joints[i]] * skin.inverse_bind[i]);
  return maps;
}

Surface surface_of(const Character& character, const MeshPart& part, bool mirrored) {
  Surface surface;
  surface.mirrored = mirrored;
  if (part.material < 0) {
    if (part.colors.empty()) surface.color = kClay;
    return surface;
  }
  const Material& material = character.materials[part.material];
  surface.color = material.base_color;
  surface.texture = part.uvs.empty() ? -1 : material.base_color_image;
  surface.alpha = material.alpha;
  surface.alpha_cutoff = material.alpha_cutoff;
  surface.double_sided = material.double_sided;
  return surface;
}

/// Linear blend skinning: position = sum w_j world_from_joint_j inverse_bind_j p.
void add_skinned_vertices(Geometry& geometry, const MeshPart& part, const std::vector<JointMap>& maps) {
  geometry.vertices.reserve(geometry.vertices.size() + part.positions.size());
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    Eigen::Matrix<float, 3, 4> position = maps[0].position;
    Eigen::Matrix3f normal = maps[0].normal;
    if (part.skin >= 0 && !part.joints.empty()) {
      position.setZero();
      normal.setZero();
      for (int k = 0; k < 4; ++k) {
        const float weight = part.weights[i][k];
        if (weight == 0.0f) continue;
        position += weight * maps[part.joints[i][k]].position;
        normal += weight * maps[part.joints[i][k]].normal;
      }
    }
    Vertex vertex;
    vertex.position = position * part.positions[i].homogeneous();
    vertex.normal =
        part.normals.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f(normal * part.normals[i]);
    vertex.uv = part.uvs.empty() ? Eigen::Vector2f::Zero() : part.uvs[i];
    vertex.color = part.colors.empty() ? Rgba{1, 1, 1, 1} : part.colors[i];
    geometry.vertices.push_back(vertex);
  }
}

const Rgba& side_color(Segment segment) {
  const std::string_view text = name(segment);
  if (text.ends_with("_l")) return kLeft;
  return text.ends_with("_r") ? kRight : kMiddle;
}

/// Each node in the colour of the segment that it moves with.
std::vector<Rgba> bone_colors(const Shot& shot) {
  const Skeleton& skeleton = shot.character->skeleton;
  std::vector<Rgba> colors(skeleton.nodes.size(), kMiddle);
  for (const int node : skeleton.order) {
    if (skeleton.nodes[node].parent >= 0) colors[node] = colors[skeleton.nodes[node].parent];
    if (shot.humanoid == nullptr) continue;
    for (int i = 0; i < kSegmentCount; ++i) {
      const std::vector<int>& chain = shot.humanoid->segments[i].chain;
      if (std::find(chain.begin(), chain.end(), node) != chain.end())
        colors[node] = side_color(segment_at(i));
    }
  }
  return colors;
}

/// A mesh that shows little of the body, as a head or a sliver does: two of its three extents are far smaller
/// than the skeleton.
bool is_sliver(const Character& character, const std::vector<Affine>& file_from_node,
               const std::vector<int>& joints) {
  constexpr double kThin = 0.15;  // of the skeleton's largest extent: a man is 0.27 wide at the shoulders
  Vec3 sizes;
  Eigen::AlignedBox3d skeleton;
  for (const int joint : joints) skeleton.extend(Vec3(file_from_node[joint].translation()));
  for (int axis = 0; axis < 3; ++axis) {
    const SkinExtent extent = skin_extent(character, file_from_node, Vec3::Unit(axis));
    if (!extent.found) return false;
    sizes[axis] = extent.max - extent.min;
  }
  std::sort(sizes.begin(), sizes.end());
  return !skeleton.isEmpty() && sizes[2] > 0.0 && sizes[1] < kThin * skeleton.sizes().maxCoeff();
}

}  // namespace

DrawnCharacter::DrawnCharacter(const Shot& shot, const Overlays& overlays)
    : shot_(shot),
      world_from_file_(file_to_world(shot)),
      joint_nodes_(joint_nodes(shot)),
      bone_colors_(bone_colors(shot)),
      overlays_(overlays) {
  const auto visible = [](const MeshPart& part) { return !part.indices.empty(); };
  mesh_ = std::any_of(shot.character->parts.begin(), shot.character->parts.end(), visible);
  covers_ = mesh_ && !is_sliver(*shot.character, world(0), joint_nodes_);
  const bool can_show_shapes =
      shot.body != nullptr && shot.segments != nullptr && shot.segments->size() == shot.clip->frames.size();
  shapes_ = can_show_shapes && (overlays.shapes || !covers_);
  overlays_.axes = overlays.axes && can_show_shapes;
  overlays_.ranges = overlays.ranges && can_show_shapes && shot.range != nullptr;
  overlays_.shapes = overlays.shapes && can_show_shapes;
  overlays_.prints = (overlays.prints || overlays.shapes) && can_show_shapes;
  if (overlays_.prints) floor_marks_ = FloorMarks(shot);
  if (!overlays.trail) return;
  for (std::size_t frame = 0; frame < shot.clip->frames.size(); ++frame)
    hips_.push_back(world_from_file_ * world(static_cast<int>(frame))[joint_nodes_.front()].translation());
}

std::vector<Affine> DrawnCharacter::world(int frame) const {
  return world_transforms(shot_.character->skeleton, shot_.clip->frames[frame]);
}

std::vector<Vec3> DrawnCharacter::joints(int frame) const {
  const std::vector<Affine> file_from_node = world(frame);
  std::vector<Vec3> places;
  for (const int node : joint_nodes_) places.push_back(world_from_file_ * file_from_node[node].translation());
  return places;
}

Vec3 DrawnCharacter::facing(int frame) const {
  if (shot_.humanoid == nullptr) return Vec3::Zero();
  const int node = shot_.humanoid->segments[index(Segment::pelvis)].node();
  if (node < 0) return Vec3::Zero();
  const Affine world_from_node = world_from_file_ * world(frame)[node];
  const Quat& node_from_segment = shot_.humanoid->node_from_segment[index(Segment::pelvis)];
  Vec3 forward = rotation_part(world_from_node.linear()) * (node_from_segment * Vec3::UnitX());
  forward.y() = 0.0;
  return forward.norm() > 0.1 ? Vec3(forward.normalized()) : Vec3(Vec3::Zero());
}

Geometry DrawnCharacter::body(int frame) const {
  Geometry geometry;
  const std::vector<Affine> file_from_node = world(frame);
  if (mesh_) add_mesh(geometry, file_from_node);
  if (covers_) return geometry;
  if (shapes_)
    add_shapes(geometry, frame, 1.0f);
  else
    add_bones(geometry, file_from_node);
  return geometry;
}

Geometry DrawnCharacter::ghost(int frame) const {
  Geometry geometry = body(frame);
  for (Piece& piece : geometry.pieces) {
    piece.surface.alpha = Material::Alpha::blend;
    piece.surface.color[3] = kGhostAlpha;
    piece.surface.casts_shadow = false;
    piece.surface.takes_shadow = false;
    piece.surface.gloss = 0.0f;
  }
  return geometry;
}

FrameGeometry DrawnCharacter::geometry(int frame) const {
  FrameGeometry result{body(frame)};
  if (covers_ && shapes_) add_shapes(result.overlay, frame, kOverlayAlpha);
  add_props(result.solid, frame);
  if (overlays_.prints) floor_marks_.add_prints(result.solid, frame);
  if (overlays_.shapes) floor_marks_.add_support(result.solid, shot_, frame);
  if (overlays_.trail) add_trail(result.solid, hips_, frame);
  if (overlays_.axes) add_joint_axes(result.overlay, shot_, frame);
  if (overlays_.ranges) add_range_cones(result.overlay, shot_, frame);
  return result;
}

void DrawnCharacter::add_mesh(Geometry& geometry, const std::vector<Affine>& file_from_node) const {
  const Character& character = *shot_.character;
  // Blended surfaces last: they are seen through.
  for (const bool blended : {false, true})
    for (const MeshPart& part : character.parts) {
      if (part.indices.empty()) continue;
      const std::vector<JointMap> maps = joint_maps(character, part, world_from_file_, file_from_node);
      const bool mirrored = maps[0].position.leftCols<3>().determinant() < 0.0f;
      const Surface surface = surface_of(character, part, mirrored);
      if ((surface.alpha == Material::Alpha::blend) != blended) continue;
      const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
      geometry.begin(surface);
      add_skinned_vertices(geometry, part, maps);
      for (const std::uint32_t i : part.indices) geometry.indices.push_back(first + i);
      geometry.pieces.back().count = static_cast<std::uint32_t>(part.indices.size());
    }
}

void DrawnCharacter::add_shapes(Geometry& geometry, int frame, float alpha) const {
  Surface surface;
  surface.alpha = alpha < 1.0f ? Material::Alpha::blend : Material::Alpha::opaque;
  surface.takes_shadow = alpha >= 1.0f;
  geometry.begin(surface);
  const BodyPose& pose = (*shot_.segments)[frame];
  for (int i = 0; i < kSegmentCount; ++i) {
    Rgba color = side_color(segment_at(i));
    color[3] = alpha;
    for (const Shape& shape : shot_.body->segments[i].shapes) {
      const Rigid world_from_shape = pose[i] * shape.segment_from_shape;
      if (shape.kind == ShapeKind::capsule)
        add_capsule(geometry, world_from_shape, shape.radius, shape.length, color);
      else
        add_box(geometry, world_from_shape, shape.size, color);
    }
  }
}

/// Nodes that only place the figure in the file are no bones.
bool DrawnCharacter::is_above_figure(int node) const {
  const int root = shot_.humanoid != nullptr ? shot_.humanoid->root : -1;
  return root >= 0 && node != root && shot_.character->skeleton.is_ancestor(node, root);
}

void DrawnCharacter::add_bones(Geometry& geometry, const std::vector<Affine>& file_from_node) const {
  const Skeleton& skeleton = shot_.character->skeleton;
  const auto place = [&](int node) { return Vec3(world_from_file_ * file_from_node[node].translation()); };
  const auto add_bone = [&](int node, const Vec3& to) {
    const Vec3 from = place(node);
    const double length = (to - from).norm();
    if (length < 1e-6) return;
    const double radius = std::clamp(0.16 * length, std::min(0.022, 0.35 * length), 0.048);
    add_octahedron(geometry, from, to, radius, bone_colors_[node]);
    add_capsule(geometry, {Quat::Identity(), from}, 0.5 * radius, 0.0, kJointBall);
  };
  Surface surface;
  surface.double_sided = true;
  geometry.begin(surface);
  for (const int node : skeleton.order) {
    const int parent = skeleton.nodes[node].parent;
    if (parent >= 0 && !is_above_figure(parent)) add_bone(parent, place(node));
  }
  add_head(geometry, file_from_node);
  if (!shot_.character->bvh) return;
  const auto& ends = shot_.character->bvh->end_site;
  for (int node = 0; node < std::min(skeleton.size(), static_cast<int>(ends.size())); ++node)
    if (ends[node]) add_bone(node, world_from_file_ * (file_from_node[node] * *ends[node]));
}

/// Bones show no head: an egg of natural size in its place.
void DrawnCharacter::add_head(Geometry& geometry, const std::vector<Affine>& file_from_node) const {
  if (shot_.humanoid == nullptr) return;
  const int node = shot_.humanoid->segments[index(Segment::head)].node();
  if (node < 0) return;
  const double size = shot_.humanoid->height_m / 1.75;
  const Affine world_from_node = world_from_file_ * file_from_node[node];
  const Quat turn =
      rotation_part(world_from_node.linear()) * shot_.humanoid->node_from_segment[index(Segment::head)];
  add_capsule(geometry, {turn, world_from_node.translation() + turn * Vec3(0.02, 0.11, 0.0) * size},
              0.078 * size, 0.075 * size, kMiddle);
}

void DrawnCharacter::add_props(Geometry& geometry, int frame) const {
  if (shot_.props == nullptr) return;
  for (const Prop& prop : *shot_.props) {
    if (prop.poses.empty()) continue;
    const Rigid& pose = prop.poses[std::min<std::size_t>(frame, prop.poses.size() - 1)];
    Surface surface;
    surface.gloss = 0.35f;
    geometry.begin(surface);
    if (prop.kind == Prop::Kind::ball)
      add_ball(geometry, pose, prop.radius, kBall, kBallBand);
    else
      add_box(geometry, pose, prop.size, kBox);
  }
}

}  // namespace ukemi
