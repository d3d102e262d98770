#include "fuzz/checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ukemi::fuzz {
namespace {

template <typename Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
}

void require_sound(const Skeleton& skeleton) {
  require(!skeleton.nodes.empty(), "a character has nodes");
  require(skeleton.order.size() == skeleton.nodes.size(), "every node is in the order once");
  std::vector<bool> seen(skeleton.nodes.size(), false);
  for (const int node : skeleton.order) {
    require(node >= 0 && node < skeleton.size() && !seen[node], "every node is in the order once");
    const int parent = skeleton.nodes[node].parent;
    require(parent == -1 || (parent >= 0 && parent < skeleton.size() && seen[parent]),
            "parents come before children");
    seen[node] = true;
    const LocalTransform& rest = skeleton.nodes[node].rest;
    require(rest.translation.allFinite() && rest.scale.allFinite() && rest.rotation.coeffs().allFinite(),
            "rest transforms are finite");
  }
}

void require_sound(const Animation& animation, int nodes) {
  for (const Track& track : animation.tracks) {
    const std::size_t width = (track.path == TrackPath::rotation ? 4u : 3u) *
                              (track.interpolation == Interpolation::cubic ? 3u : 1u);
    require(track.node >= 0 && track.node < nodes, "tracks move nodes that exist");
    require(!track.times.empty() && track.values.size() == width * track.times.size(),
            "tracks have a value per key");
    require(std::is_sorted(track.times.begin(), track.times.end(), std::less_equal<>()), "key times rise");
    require(all_finite(track.times) && all_finite(track.values), "keys are finite");
  }
}

void require_sound(const MeshPart& part, const Character& character) {
  const std::size_t vertices = part.positions.size();
  const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
  require(fits(part.normals.size()) && fits(part.uvs.size()) && fits(part.colors.size()) &&
              fits(part.joints.size()) && fits(part.weights.size()),
          "vertex arrays are as long as the positions");
  require(part.indices.size() % 3 == 0, "indices are triangles");
  require(
      std::all_of(part.indices.begin(), part.indices.end(), [&](std::uint32_t i) { return i < vertices; }),
      "indices are in range");
  require(part.node >= 0 && part.node < character.skeleton.size(), "meshes hang on nodes that exist");
  require(part.skin < static_cast<int>(character.skins.size()), "skins exist");
  require(part.material < static_cast<int>(character.materials.size()), "materials exist");
  for (std::size_t v = 0; v < part.joints.size(); ++v) {
    float sum = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
      require(part.joints[v][k] < character.skins[static_cast<std::size_t>(part.skin)].joints.size(),
              "vertices follow joints that exist");
      require(part.weights[v][k] >= 0.0f, "weights are not negative");
      sum += part.weights[v][k];
    }
    require(std::abs(sum - 1.0f) < 1e-3f, "weights sum to 1");
  }
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

void require_clear(const Error& error) {
  require(!error.what.empty() && !error.fix.empty(), "a refusal says what is wrong and what to do");
  require(error.kind != ErrorKind::internal, "a refusal is not a bug of ours");
}

void require_sound(const Character& character) {
  const int nodes = character.skeleton.size();
  require_sound(character.skeleton);
  for (const Animation& animation : character.animations) require_sound(animation, nodes);
  for (const Skin& skin : character.skins) {
    require(skin.joints.size() == skin.inverse_bind.size(), "every joint has its inverse-bind matrix");
    for (const int joint : skin.joints) require(joint >= 0 && joint < nodes, "skins name nodes that exist");
  }
  for (const MeshPart& part : character.parts) require_sound(part, character);
  for (const auto& [name, node] : character.vrm_bones)
    require(node >= 0 && node < nodes, "VRM bones are nodes that exist");
}

void require_sound(const RangeOfMotion& range) {
  for (const JointRange& joint : range.joints) {
    require(joint.polygon.size() >= 3, "a polygon has three corners");
    for (std::size_t i = 0; i < joint.polygon.size(); ++i) {
      const Vec2& a = joint.polygon[i];
      const Vec2& b = joint.polygon[(i + 1) % joint.polygon.size()];
      require(a.x() * b.y() - a.y() * b.x() > 0.0, "a polygon is star-shaped, counter-clockwise");
      require(a.norm() <= radians(170.0) + 1e-9, "corners lie within 170 degrees");
    }
    require(joint.twist_min <= 0.0 && joint.twist_max >= 0.0, "the twist's interval holds 0");
    require(joint.frame.parent_from_joint.coeffs().allFinite() && joint.frame.reference.coeffs().allFinite(),
            "frames are finite");
  }
}

}  // namespace ukemi::fuzz
