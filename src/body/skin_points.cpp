#include "body/skin_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "humanoid/skin.h"

namespace ukemi {
namespace {

constexpr double kFarOut = 0.023;     // over stature: 40 mm of a man
constexpr double kHandLength = 0.13;  // over stature, with room for long fingers

double distance_from(const Shape& shape, const Vec3& point) {
  const Vec3 p = shape.segment_from_shape.inverse() * point;
  if (shape.kind == ShapeKind::box) return (p.cwiseAbs() - 0.5 * shape.size).cwiseMax(0.0).norm();
  const double along = std::clamp(p.y(), -0.5 * shape.length, 0.5 * shape.length);
  return (p - Vec3(0.0, along, 0.0)).norm() - shape.radius;
}

bool is_hand(Segment s) { return s == Segment::hand_l || s == Segment::hand_r; }
bool is_foot(Segment s) { return s == Segment::foot_l || s == Segment::foot_r; }

/// Which nodes carry skin of their own segment.
class BoneNodes {
 public:
  BoneNodes(const Character& character, const Humanoid& humanoid)
      : owner_(segments_of_nodes(character.skeleton, humanoid)),
        skeleton_(character.skeleton),
        reach_(kHandLength * humanoid.height_m),
        is_bone_(character.skeleton.nodes.size(), 0) {
    if (humanoid.root >= 0) is_bone_[humanoid.root] = 1;
    for (const SegmentNodes& segment : humanoid.segments)
      for (const int node : segment.chain) mark_up_to_the_body(node);
    for (const Segment hand : {Segment::hand_l, Segment::hand_r})
      if (humanoid.segments[index(hand)].fused()) is_handless_[index(parent_of(hand))] = true;
    for (const TwistBone& bone : humanoid.twist_bones) is_bone_[bone.node] = 1;
  }

  const std::optional<Segment>& owner(int node) const { return owner_[node]; }

  /// `place`: segment frame.
  bool carries(int node, bool rigid, const Vec3& place) const {
    const Segment segment = *owner_[node];
    const int bone = rigid && !is_bone_[node] ? skeleton_.nodes[node].parent : node;
    if (is_hand(segment)) return is_bone_[node] || place.norm() < reach_;
    if (is_handless_[index(segment)] && place.norm() < 2.2 * reach_) return true;
    return is_foot(segment) || (bone >= 0 && is_bone_[bone]);
  }

 private:
  /// With the bones between it and the segment above.
  void mark_up_to_the_body(int node) {
    std::vector<int> between;
    for (; node >= 0 && !is_bone_[node]; node = skeleton_.nodes[node].parent) between.push_back(node);
    if (node < 0) between.resize(std::min<std::size_t>(between.size(), 1));
    for (const int bone : between) is_bone_[bone] = 1;
  }

  std::vector<std::optional<Segment>> owner_;
  const Skeleton& skeleton_;
  double reach_;
  std::vector<char> is_bone_;
  PerSegment<bool> is_handless_{};  // a forearm that the hand is one with
};

/// Nodes whose skin the bind pose throws far away.
std::vector<char> astray_nodes(const Character& character, const Humanoid& humanoid,
                               const std::vector<Affine>& world) {
  std::vector<char> astray(world.size(), 0);
  const double height = humanoid.height_m / humanoid.world_from_file.scale;
  for (const CarriedSkin& skin : carried_skin(character, world))
    astray[static_cast<std::size_t>(skin.node)] = is_astray(skin.distance, height) ? 1 : 0;
  return astray;
}

/// A vertex as its part's matrices move it, and the node of its largest weight.
std::pair<Vec3, int> posed(const MeshPart& part, const Skin& skin, const std::vector<Affine>& world_from_mesh,
                           std::size_t v) {
  Vec3 p = Vec3::Zero();
  int heaviest = 0;
  for (int k = 0; k < 4; ++k) {
    p += static_cast<double>(part.weights[v][k]) *
         (world_from_mesh[part.joints[v][k]] * part.positions[v].cast<double>());
    if (part.weights[v][k] > part.weights[v][heaviest]) heaviest = k;
  }
  return {p, skin.joints[part.joints[v][heaviest]]};
}

}  // namespace

double distance_from(const std::vector<Shape>& shapes, const Vec3& point) {
  double nearest = 1e300;
  for (const Shape& shape : shapes) nearest = std::min(nearest, distance_from(shape, point));
  return nearest;
}

void for_each_skin_vertex(const Character& character, const Humanoid& humanoid, const Pose& pose,
                          const BodyPose& segments, const std::function<void(const SkinVertex&)>& see) {
  const BoneNodes bones(character, humanoid);
  const std::vector<Affine> world = world_transforms(character.skeleton, pose);
  const std::vector<char> astray = astray_nodes(character, humanoid, world);
  PerSegment<Rigid> segment_from_world;
  for (int s = 0; s < kSegmentCount; ++s) segment_from_world[s] = segments[s].inverse();
  for (std::size_t m = 0; m < character.parts.size(); ++m) {
    const MeshPart& part = character.parts[m];
    if (is_scenery(character.skeleton, humanoid, part)) continue;
    const bool rigid = part.skin < 0;
    std::vector<Affine> world_from_mesh;
    for (std::size_t j = 0; !rigid && j < character.skins[part.skin].joints.size(); ++j)
      world_from_mesh.push_back(world[character.skins[part.skin].joints[j]] *
                                character.skins[part.skin].inverse_bind[j]);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const auto [p, node] =
          rigid ? std::pair<Vec3, int>(world[part.node] * part.positions[v].cast<double>(), part.node)
                : posed(part, character.skins[part.skin], world_from_mesh, v);
      const auto& s = bones.owner(node);
      if (!s) continue;
      const Vec3 place = segment_from_world[index(*s)] * (humanoid.world_from_file * p);
      const bool on_bone = !astray[static_cast<std::size_t>(node)] && bones.carries(node, rigid, place);
      see({static_cast<int>(m), static_cast<int>(v), node, *s, place, on_bone});
    }
  }
}

Vec3 direction(int i, int count) {
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  const double y = 1.0 - (2.0 * i + 1.0) / count;
  const double ring = std::sqrt(1.0 - y * y);
  return {ring * std::cos(golden * i), y, ring * std::sin(golden * i)};
}

bool is_body(const SkinVertex& vertex, const ArticulatedBody& body) {
  return vertex.on_bone ||
         distance_from(body.segments[index(vertex.segment)].shapes, vertex.place) < kFarOut * body.height_m;
}

std::vector<std::size_t> outermost(const std::vector<Vec3>& points, int directions) {
  std::vector<char> chosen(points.size(), 0);
  for (int i = 0; i < directions && !points.empty(); ++i) {
    const Vec3 d = direction(i, directions);
    const auto best = std::max_element(points.begin(), points.end(),
                                       [&](const Vec3& a, const Vec3& b) { return a.dot(d) < b.dot(d); });
    chosen[static_cast<std::size_t>(best - points.begin())] = 1;
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (chosen[i]) result.push_back(i);
  return result;
}

}  // namespace ukemi
