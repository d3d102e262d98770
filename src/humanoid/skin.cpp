#include "humanoid/skin.h"

#include <algorithm>

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

std::vector<char> carries_skin(const Character& character) {
  std::vector<char> carries(character.skeleton.nodes.size(), 0);
  for (const MeshPart& part : character.parts) {
    if (part.skin < 0 || part.joints.empty()) {
      if (part.node >= 0) carries[part.node] = 1;
      continue;
    }
    for (std::size_t v = 0; v < part.weights.size(); ++v) {
      const auto& weights = part.weights[v];
      const auto strongest = std::max_element(weights.begin(), weights.end()) - weights.begin();
      carries[character.skins[part.skin].joints[part.joints[v][strongest]]] = 1;
    }
  }
  return carries;
}

}  // namespace ukemi
