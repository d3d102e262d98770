#include "humanoid/skin.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

std::vector<Affine> joint_matrices(const Skin& skin, const std::vector<Affine>& world) {
  std::vector<Affine> result;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Affine bind = j < skin.inverse_bind.size() ? skin.inverse_bind[j] : Affine::Identity();
    result.push_back(world[skin.joints[j]] * bind);
  }
  return result;
}

void add(SkinExtent& extent, double value) {
  extent.min = extent.found ? std::min(extent.min, value) : value;
  extent.max = extent.found ? std::max(extent.max, value) : value;
  extent.found = true;
}

/// Where the vertices of a part are, and the nodes that carry them.
struct PosedPart {
  std::vector<Vec3> places;
  std::vector<int> nodes;
};

PosedPart posed(const Character& character, const MeshPart& part,
                const std::vector<Affine>& world_from_node) {
  PosedPart result;
  if (part.node < 0) return result;
  const bool rigid = part.skin < 0 || part.joints.empty();
  const std::vector<Affine> matrices =
      rigid ? std::vector<Affine>() : joint_matrices(character.skins[part.skin], world_from_node);
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    const Vec3 p = part.positions[v].cast<double>();
    if (rigid) {
      result.places.push_back(world_from_node[part.node] * p);
      result.nodes.push_back(part.node);
      continue;
    }
    const auto& weights = part.weights[v];
    const auto strongest = std::max_element(weights.begin(), weights.end()) - weights.begin();
    Vec3 place = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
      if (weights[k] > 0.0f) place += weights[k] * (matrices[part.joints[v][k]] * p);
    result.places.push_back(place);
    result.nodes.push_back(character.skins[part.skin].joints[part.joints[v][strongest]]);
  }
  return result;
}

void add_edge(const Vec3& a, const Vec3& b, double spacing, std::vector<Vec3>& points) {
  constexpr double kMost = 100.0;
  const double count = std::clamp(std::ceil((b - a).norm() / spacing), 1.0, kMost);
  for (double i = 0.0; i < count; ++i) points.push_back(a + (i / count) * (b - a));
}

}  // namespace

SkinExtent skin_extent(const Character& character, const std::vector<Affine>& world_from_node,
                       const Vec3& direction, const std::function<bool(int node)>& counts) {
  SkinExtent extent;
  for (const MeshPart& part : character.parts) {
    if (part.node < 0) continue;
    if (part.skin < 0 || part.joints.empty()) {
      if (counts && !counts(part.node)) continue;
      for (const Eigen::Vector3f& p : part.positions)
        add(extent, direction.dot(world_from_node[part.node] * p.cast<double>()));
      continue;
    }
    const Skin& skin = character.skins[part.skin];
    const std::vector<Affine> matrices = joint_matrices(skin, world_from_node);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const auto& weights = part.weights[v];
      const auto strongest = std::max_element(weights.begin(), weights.end()) - weights.begin();
      if (counts && !counts(skin.joints[part.joints[v][strongest]])) continue;
      const Vec3 p = part.positions[v].cast<double>();
      double value = 0.0;
      for (int k = 0; k < 4; ++k)
        if (weights[k] > 0.0f) value += weights[k] * direction.dot(matrices[part.joints[v][k]] * p);
      add(extent, value);
    }
  }
  return extent;
}

std::vector<CarriedSkin> carried_skin(const Character& character,
                                      const std::vector<Affine>& world_from_node) {
  std::vector<double> sum(world_from_node.size(), 0.0), count(world_from_node.size(), 0.0);
  for (const MeshPart& part : character.parts) {
    if (part.skin < 0 || part.joints.empty()) continue;
    const PosedPart skin = posed(character, part, world_from_node);
    for (std::size_t v = 0; v < skin.places.size(); ++v) {
      const auto node = static_cast<std::size_t>(skin.nodes[v]);
      sum[node] += (skin.places[v] - world_from_node[node].translation()).norm();
      ++count[node];
    }
  }
  std::vector<CarriedSkin> carried;
  for (std::size_t node = 0; node < sum.size(); ++node)
    if (count[node] > 0.0) carried.push_back({static_cast<int>(node), sum[node] / count[node]});
  return carried;
}

std::vector<Vec3> surface_points(const Character& character, const std::vector<Affine>& world_from_node,
                                 double spacing, const std::function<bool(int node)>& counts) {
  std::vector<Vec3> points;
  for (const MeshPart& part : character.parts) {
    const PosedPart skin = posed(character, part, world_from_node);
    for (std::size_t i = 0; !skin.places.empty() && i + 2 < part.indices.size(); i += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = part.indices[i + k], b = part.indices[i + (k + 1) % 3];
        if (counts(skin.nodes[a]) && counts(skin.nodes[b]))
          add_edge(skin.places[a], skin.places[b], spacing, points);
      }
  }
  return points;
}

std::vector<std::optional<Segment>> segments_of_nodes(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::vector<std::optional<Segment>> segments(skeleton.nodes.size());
  for (int node = humanoid.root; node >= 0; node = skeleton.nodes[node].parent)
    segments[node] = Segment::pelvis;
  std::vector<char> own(segments.size(), 0);
  for (int s = 0; s < kSegmentCount; ++s)
    for (const int node : humanoid.segments[s].chain) {
      segments[node] = segment_at(s);
      own[node] = 1;
    }
  std::vector<char> in_body(own);
  if (humanoid.root >= 0) in_body[humanoid.root] = 1;
  for (const int node : skeleton.order) {
    const int parent = skeleton.nodes[node].parent;
    if (parent < 0 || own[node] || !in_body[parent]) continue;
    segments[node] = segments[parent];
    in_body[node] = 1;
  }
  return segments;
}

bool is_scenery(const Skeleton& skeleton, const Humanoid& humanoid, const MeshPart& part) {
  if (part.skin >= 0 && !part.joints.empty()) return false;
  std::vector<char> in_body(skeleton.nodes.size(), 0);
  for (const SegmentNodes& segment : humanoid.segments)
    for (const int node : segment.chain) in_body[node] = 1;
  if (humanoid.root >= 0) in_body[humanoid.root] = 1;
  for (int node = part.node; node >= 0; node = skeleton.nodes[node].parent)
    if (in_body[node]) return false;
  return true;
}

}  // namespace ukemi
