// Feet that stand apart from their legs, as where inverse kinematics holds them, and say no name.
#include <algorithm>
#include <cmath>

#include "bones/bones.h"

namespace ukemi {
namespace {

constexpr double kNear = 0.25;   // of the leg's length: a foot from where its leg ends
constexpr double kSmall = 0.5;   // of the leg's length: a foot's mesh
constexpr double kAlike = 0.25;  // of the leg's length: how differently both feet may lie under their legs

struct LegSegments {
  Segment thigh, shank, foot;
};
constexpr LegSegments kLegs[] = {{Segment::thigh_l, Segment::shank_l, Segment::foot_l},
                                 {Segment::thigh_r, Segment::shank_r, Segment::foot_r}};

/// Largest extent of the meshes on each node without a skin, in its own axes times the node's scale.
std::vector<double> mesh_sizes(const Character& character, const std::vector<Affine>& world) {
  std::vector<double> sizes(world.size(), 0.0);
  for (const MeshPart& part : character.parts) {
    if (part.node < 0 || (part.skin >= 0 && !part.joints.empty()) || part.positions.empty()) continue;
    Vec3 low = part.positions.front().cast<double>(), high = low;
    for (const auto& position : part.positions) {
      low = low.cwiseMin(position.cast<double>());
      high = high.cwiseMax(position.cast<double>());
    }
    const double scale = world[part.node].linear().norm() / std::sqrt(3.0);
    sizes[part.node] = std::max(sizes[part.node], scale * (high - low).maxCoeff());
  }
  return sizes;
}

class FeetApart {
 public:
  FeetApart(const Character& character, const Bones& bones)
      : skeleton_(character.skeleton),
        bones_(bones),
        world_(world_transforms(character.skeleton, rest_pose(character.skeleton))),
        carries_(carries_skin(character)),
        size_(mesh_sizes(character, world_)) {}

  Vec3 place(int node) const { return world_[node].translation(); }
  double length(const LegSegments& leg) const {
    return 2.0 * (place(bones_[leg.shank]) - place(bones_[leg.thigh])).norm();
  }
  /// Shanks are about as long as thighs.
  Vec3 end(const LegSegments& leg) const { return 2.0 * place(bones_[leg.shank]) - place(bones_[leg.thigh]); }

  /// The nearest to where the leg ends; -1 where there is none near.
  int foot(const LegSegments& leg) const {
    int found = -1;
    double nearest = kNear * length(leg);
    for (const int node : skeleton_.order) {
      const double distance = (place(node) - end(leg)).norm();
      if (distance >= nearest || !may_be_foot(node, length(leg))) continue;
      nearest = distance;
      found = node;
    }
    return found;
  }

 private:
  /// What moves skin, is no larger than a foot, and neither hangs on a bone nor holds one.
  bool may_be_foot(int node, double leg_length) const {
    if (!carries_[node] || size_[node] > kSmall * leg_length) return false;
    return std::none_of(bones_.node.begin(), bones_.node.end(), [&](int bone) {
      if (bone < 0) return false;
      const bool hangs_on_it = bone != bones_[Segment::pelvis] && is_at_or_below(skeleton_, bone, node);
      return hangs_on_it || is_at_or_below(skeleton_, node, bone);
    });
  }

  const Skeleton& skeleton_;
  const Bones& bones_;
  std::vector<Affine> world_;
  std::vector<char> carries_;
  std::vector<double> size_;
};

}  // namespace

void add_feet_apart(const Character& character, Bones& bones) {
  const FeetApart apart(character, bones);
  const auto& [left, right] = kLegs;
  if (bones[left.foot] >= 0 || bones[right.foot] >= 0) return;
  const int foot_l = apart.foot(left), foot_r = apart.foot(right);
  if (foot_l < 0 || foot_r < 0 || foot_l == foot_r) return;
  const Vec3 between_ends = apart.end(right) - apart.end(left);
  const Vec3 between_feet = apart.place(foot_r) - apart.place(foot_l);
  if ((between_feet - between_ends).norm() > kAlike * apart.length(left)) return;
  bones.set(left.foot, foot_l, "topology");
  bones.set(right.foot, foot_r, "topology");
}

}  // namespace ukemi
