#include "judge/skin_on_floor.h"

#include <algorithm>
#include <map>

namespace ukemi {
namespace {

constexpr int kDirections = 256;  // half a step of 4 degrees leaves out 0.06 % of a part's size

/// Height over the floor as a function of a place: world_from_file's, a node's or a mesh's.
struct HeightOf {
  Vec3 direction = Vec3::Zero();
  double constant = 0.0;

  HeightOf of(const Affine& inner) const {
    return {inner.linear().transpose() * direction, constant + direction.dot(inner.translation())};
  }
  double at(const Eigen::Vector3f& place) const { return constant + direction.dot(place.cast<double>()); }
};

/// Heights of watched vertices in one pose.
class Heights {
 public:
  Heights(const Character& character, const Humanoid& humanoid, const Pose& pose) : character_(character) {
    const HeightOf up{
        humanoid.world_from_file.scale * (humanoid.world_from_file.rotation.conjugate() * Vec3::UnitY()),
        0.0};
    for (const Affine& file_from_node : world_transforms(character.skeleton, pose))
      nodes_.push_back(up.of(file_from_node));
    for (const Skin& skin : character.skins) {
      std::vector<HeightOf>& joints = joints_.emplace_back();
      for (std::size_t j = 0; j < skin.joints.size(); ++j)
        joints.push_back(nodes_[skin.joints[j]].of(skin.inverse_bind[j]));
    }
  }

  double of(const SkinVertex& v) const {
    const MeshPart& part = character_.parts[v.part];
    const Eigen::Vector3f& place = part.positions[v.vertex];
    if (part.skin < 0) return nodes_[part.node].at(place);
    double height = 0.0;
    for (int k = 0; k < 4; ++k)
      height += part.weights[v.vertex][k] * joints_[part.skin][part.joints[v.vertex][k]].at(place);
    return height;
  }

 private:
  const Character& character_;
  std::vector<HeightOf> nodes_;
  std::vector<std::vector<HeightOf>> joints_;  // per skin
};

void deepen(double depth_m, int node, double& deepest_m, int& deepest_node) {
  if (depth_m <= deepest_m) return;
  deepest_m = depth_m;
  deepest_node = node;
}

}  // namespace

SkinOverFloor::SkinOverFloor(const Character& character, const Humanoid& humanoid,
                             const ArticulatedBody& body, const Pose& pose, const BodyPose& segments)
    : character_(character), humanoid_(humanoid) {
  std::map<std::pair<int, bool>, std::vector<SkinVertex>> groups;
  for_each_skin_vertex(character, humanoid, pose, segments, [&](const SkinVertex& v) {
    groups[{v.node, is_body(v, body)}].push_back(v);
  });
  for (const auto& [key, vertices] : groups) {
    std::vector<Vec3> places;
    for (const SkinVertex& v : vertices) places.push_back(v.place);
    for (const std::size_t i : outermost(places, kDirections)) watched_.push_back({vertices[i], key.second});
  }
}

SkinDepth SkinOverFloor::depth(const Pose& frame) const {
  const Heights heights(character_, humanoid_, frame);
  SkinDepth deepest;
  for (const Watched& w : watched_) {
    const double depth_m = -heights.of(w.vertex);
    if (w.is_body)
      deepen(depth_m, w.vertex.node, deepest.body_m, deepest.body_node);
    else
      deepen(depth_m, w.vertex.node, deepest.other_m, deepest.other_node);
  }
  return deepest;
}

SkinOnFloor skin_on_floor(const SkinOverFloor& skin, const std::vector<Pose>& frames) {
  SkinOnFloor result;
  for (const Pose& frame : frames) {
    const SkinDepth now = skin.depth(frame);
    deepen(now.body_m, now.body_node, result.max.body_m, result.max.body_node);
    deepen(now.other_m, now.other_node, result.max.other_m, result.max.other_node);
    result.end_m = now.body_m;
  }
  return result;
}

}  // namespace ukemi
