#include "humanoid/assemble.h"

#include <algorithm>

#include "bones/names.h"

namespace ukemi {
namespace {

struct Assembler {
  const Character& character;
  const Skeleton& skeleton;
  const Bones& bones;
  Humanoid& humanoid;
  std::vector<std::vector<int>> children;
  std::vector<Vec3> rest;  // positions, file units

  Assembler(const Character& c, const Bones& b, Humanoid& h)
      : character(c), skeleton(c.skeleton), bones(b), humanoid(h), children(c.skeleton.children()) {
    for (const Affine& m : world_transforms(skeleton, rest_pose(skeleton))) rest.push_back(m.translation());
  }

  SegmentNodes& at(Segment s) { return humanoid.segments[index(s)]; }
  void single(Segment s) {
    if (bones[s] >= 0) at(s) = {{bones[s]}, false, bones.by[index(s)]};
  }

  /// The node that carries both arms.
  int arms_fork() const {
    const auto top = [&](Segment clavicle, Segment arm) {
      return bones[clavicle] >= 0 ? bones[clavicle] : bones[arm];
    };
    int left = top(Segment::clavicle_l, Segment::upperarm_l);
    int right = top(Segment::clavicle_r, Segment::upperarm_r);
    if (left == right) return left;
    return common_ancestor(skeleton, left, right);
  }

  /// Height in the rest pose along the trunk, from the hips (0) to the shoulders (1).
  double rise_of(int node) const {
    const auto middle = [&](Segment l, Segment r) { return Vec3(0.5 * (rest[bones[l]] + rest[bones[r]])); };
    const Vec3 hips = middle(Segment::thigh_l, Segment::thigh_r);
    const Vec3 trunk = middle(Segment::upperarm_l, Segment::upperarm_r) - hips;
    return trunk.squaredNorm() > 0.0 ? (rest[node] - hips).dot(trunk) / trunk.squaredNorm() : 0.0;
  }

  /// The bone of a neck by its name, or by lying above the shoulders.
  bool is_neck(int node) const {
    constexpr double kAboveShoulders = 1.06;
    const NameReading reading = read_name(skeleton.nodes[node].name);
    if (fit(reading, Part::spine) > 0) return false;
    return fit(reading, Part::neck) > 0 || rise_of(node) > kAboveShoulders;
  }

  /// Bones from the pelvis to the chest: up to where the arms hang, without necks that carry them; where the
  /// arms hang on the pelvis itself, up to the neck.
  std::vector<int> spine_bones() const {
    const int pelvis = bones[Segment::pelvis], user = bones[Segment::chest];
    const int fork = user >= 0 ? user : arms_fork();
    const auto between = [&](int top) {
      std::vector<int> path = path_below(skeleton, common_ancestor(skeleton, pelvis, top), top);
      std::erase_if(path, [&](int node) {
        return is_at_or_below(skeleton, node, pelvis) ||
               is_at_or_below(skeleton, node, bones[Segment::thigh_l]) ||
               is_at_or_below(skeleton, node, bones[Segment::thigh_r]) ||
               read_name(skeleton.nodes[node].name).helper;
      });
      return path;
    };
    std::vector<int> spine = fork >= 0 ? between(fork) : std::vector<int>();
    if (user >= 0) return spine;
    if (spine.empty()) {
      spine = between(bones[Segment::head]);
      std::erase(spine, bones[Segment::head]);
      while (!spine.empty() && is_neck(spine.back())) spine.pop_back();
    }
    while (spine.size() > 1 && is_neck(spine.back())) spine.pop_back();
    return spine;
  }

  void trunk() {
    const int pelvis = bones[Segment::pelvis];
    const std::vector<int> spine = spine_bones();
    humanoid.root = pelvis;
    for (const int node :
         {bones[Segment::thigh_l], bones[Segment::thigh_r], spine.empty() ? arms_fork() : spine.back()})
      if (const int above = common_ancestor(skeleton, humanoid.root, node); above >= 0) humanoid.root = above;
    single(Segment::pelvis);
    if (spine.empty()) return;
    auto split = spine.begin() + static_cast<std::ptrdiff_t>(spine.size() / 2);
    if (const auto user = std::find(spine.begin(), spine.end(), bones[Segment::abdomen]);
        user != spine.end() && user + 1 != spine.end())
      split = user + 1;
    if (split != spine.begin()) at(Segment::abdomen) = {{spine.begin(), split}, false, {}};
    at(Segment::chest) = {{split, spine.end()}, false, {}};
    for (const Segment s : {Segment::abdomen, Segment::chest}) at(s).by = source_of_spine(s);
  }

  /// How a part of the spine was found: what the user did not name is not by the user.
  std::string source_of_spine(Segment s) {
    if (at(s).fused()) return {};
    if (at(s).node() == bones[s]) return bones.by[index(s)];
    const std::string& pelvis = bones.by[index(Segment::pelvis)];
    if (pelvis != "user") return pelvis;
    return fit(read_name(skeleton.nodes[at(s).node()].name), Part::spine) > 0 ? "name" : "topology";
  }

  void head() {
    const int head = bones[Segment::head];
    const int chest = humanoid.carrier_node(Segment::chest);
    const int fork = common_ancestor(skeleton, chest, head);
    std::vector<int> chain = fork >= 0 ? path_below(skeleton, fork, head) : std::vector<int>{head};
    std::erase_if(chain, [&](int node) {
      return !is_neck(node) && (is_at_or_below(skeleton, node, bones[Segment::upperarm_l]) ||
                                is_at_or_below(skeleton, node, bones[Segment::upperarm_r]));
    });
    if (chain.empty()) chain = {head};
    at(Segment::head) = {chain, false, bones.by[index(Segment::head)]};
  }

  /// A second node in the same place that still belongs to the joint (CMU: LeftHand and LeftFingerBase).
  void extend_hand(Segment hand, Segment forearm) {
    if (at(hand).fused() || at(forearm).fused()) return;
    const double forearm_length = (rest[at(hand).node()] - rest[at(forearm).node()]).norm();
    for (const int child : children[at(hand).node()]) {
      const bool same_place = (rest[child] - rest[at(hand).node()]).norm() < 0.01 * forearm_length;
      if (same_place && fit(read_name(skeleton.nodes[child].name), Part::hand) > 0) {
        at(hand).chain.push_back(child);
        return;
      }
    }
  }

  /// A segment is detached where the one above does not carry it: it hangs elsewhere (IK-driven feet), or on
  /// a bone of a third segment (clavicles on a neck).
  void mark_detached() {
    std::vector<int> owner(skeleton.nodes.size(), -1);
    for (int s = 0; s < kSegmentCount; ++s)
      for (const int node : humanoid.segments[s].chain) owner[node] = s;
    for (int s = 1; s < kSegmentCount; ++s) {
      SegmentNodes& segment = humanoid.segments[s];
      if (segment.fused()) continue;
      const Segment above = humanoid.carrier(parent_of(segment_at(s)));
      const int holder = humanoid.holder_of(segment_at(s));
      int node = skeleton.nodes[segment.chain.front()].parent;
      while (node >= 0 && node != holder && (owner[node] < 0 || owner[node] == index(above)))
        node = skeleton.nodes[node].parent;
      segment.detached = node != holder;
    }
  }

  /// The best named node below `top` for a part; first in hierarchy order among equals.
  int best_below(int top, Part part) const {
    int best = -1, best_score = 0;
    for (const int node : skeleton.order) {
      if (!skeleton.is_ancestor(top, node)) continue;
      NameReading reading = read_name(skeleton.nodes[node].name);
      if (part == Part::head_top) reading.side = Side::none;
      const int score = fit(reading, part);
      if (score > best_score) best = node, best_score = score;
    }
    return best;
  }

  /// The only child, where it is an end or has no name; else -1 (a weapon, a mesh).
  int only_end_below(int node) const {
    if (children[node].size() != 1) return -1;
    const int child = children[node][0];
    return skeleton.nodes[child].name.empty() || read_name(skeleton.nodes[child].name).end ? child : -1;
  }

  void landmarks() {
    for (int side = 0; side < 2; ++side) {
      const Segment foot = side == 0 ? Segment::foot_l : Segment::foot_r;
      const Segment hand = side == 0 ? Segment::hand_l : Segment::hand_r;
      if (!at(foot).fused()) {
        humanoid.toes[side] = best_below(at(foot).node(), Part::toe);
        if (humanoid.toes[side] < 0 && read_name(skeleton.nodes[at(foot).node()].name).stem == "ankle")
          humanoid.toes[side] = best_below(at(foot).node(), Part::foot);
        if (humanoid.toes[side] < 0) humanoid.toes[side] = only_end_below(at(foot).node());
      }
      if (!at(hand).fused()) {
        humanoid.middle_finger[side] = best_below(at(hand).node(), Part::finger);
        if (humanoid.middle_finger[side] < 0) humanoid.middle_finger[side] = only_end_below(at(hand).node());
      }
    }
    humanoid.head_top = best_below(at(Segment::head).node(), Part::head_top);
  }

  /// End of the lower bone of a limb whose hand or foot is missing: where its children start, its BVH end
  /// site, or straight on by the upper bone's length times `ratio` (lower to upper bone, de Leva 1996).
  Vec3 limb_end(int upper, int middle, double ratio) const {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    const double upper_length = (rest[middle] - rest[upper]).norm();
    for (const int child : children[middle]) {
      if ((rest[child] - rest[middle]).norm() < 0.3 * upper_length) continue;
      sum += rest[child];
      ++count;
    }
    if (count > 0) return sum / count;
    return rest[middle] + ratio * (rest[middle] - rest[upper]);
  }

  Vec3 mean_of(const SegmentNodes& segment) const {
    Vec3 sum = Vec3::Zero();
    for (const int node : segment.chain) sum += rest[node];
    return sum / static_cast<double>(segment.chain.size());
  }

  /// Rest position of a fused segment's origin, file units.
  Vec3 fused_place(Segment s) {
    const Vec3 hips = 0.5 * (mean_of(at(Segment::thigh_l)) + mean_of(at(Segment::thigh_r)));
    const Vec3 neck = rest[at(Segment::head).chain.front()];
    switch (s) {
      case Segment::abdomen:
        return hips + (at(Segment::chest).fused() ? 0.3 : 0.5) *
                          ((at(Segment::chest).fused() ? neck : mean_of(at(Segment::chest))) - hips);
      case Segment::chest:
        return hips + 0.6 * (neck - hips);
      case Segment::clavicle_l:
      case Segment::clavicle_r: {
        const Segment arm = s == Segment::clavicle_l ? Segment::upperarm_l : Segment::upperarm_r;
        const Vec3 middle = 0.5 * (mean_of(at(Segment::upperarm_l)) + mean_of(at(Segment::upperarm_r)));
        return middle + 0.15 * (mean_of(at(arm)) - middle);
      }
      case Segment::hand_l:
        return limb_end(bones[Segment::upperarm_l], bones[Segment::forearm_l], 0.955);
      case Segment::hand_r:
        return limb_end(bones[Segment::upperarm_r], bones[Segment::forearm_r], 0.955);
      case Segment::foot_l:
        return limb_end(bones[Segment::thigh_l], bones[Segment::shank_l], 1.043);
      case Segment::foot_r:
        return limb_end(bones[Segment::thigh_r], bones[Segment::shank_r], 1.043);
      default:
        return rest[humanoid.carrier_node(s)];
    }
  }

  void fused_origins() {
    const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
    humanoid.fused_origin.fill(Vec3::Zero());
    for (int s = 0; s < kSegmentCount; ++s)
      if (humanoid.segments[s].fused())
        humanoid.fused_origin[s] =
            world[humanoid.carrier_node(segment_at(s))].inverse() * fused_place(segment_at(s));
  }
};

}  // namespace

Segment Humanoid::carrier(Segment s) const {
  while (s != Segment::pelvis && segments[index(s)].fused()) s = parent_of(s);
  return s;
}

int Humanoid::holder_of(Segment s) const {
  const Segment above = carrier(parent_of(s));
  return above == Segment::pelvis ? root : segments[index(above)].node();
}

void assemble(const Character& character, const Bones& bones, Humanoid& humanoid) {
  Assembler assembler(character, bones, humanoid);
  assembler.trunk();
  assembler.head();
  for (int s = index(Segment::clavicle_l); s < kSegmentCount; ++s) assembler.single(segment_at(s));
  assembler.extend_hand(Segment::hand_l, Segment::forearm_l);
  assembler.extend_hand(Segment::hand_r, Segment::forearm_r);
  assembler.mark_detached();
  assembler.landmarks();
  assembler.fused_origins();
}

int find_below(const Skeleton& skeleton, int top, std::string_view word) {
  for (const int node : skeleton.order)
    if (skeleton.is_ancestor(top, node) &&
        read_name(skeleton.nodes[node].name).stem.find(word) != std::string::npos)
      return node;
  return -1;
}

PerSegment<Vec3> origins_of(const Humanoid& humanoid, const std::vector<Affine>& world_from_node) {
  PerSegment<Vec3> origins;
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentNodes& segment = humanoid.segments[s];
    if (segment.fused()) {
      origins[s] = world_from_node[humanoid.carrier_node(segment_at(s))] * humanoid.fused_origin[s];
      continue;
    }
    Vec3 sum = Vec3::Zero();
    for (const int node : segment.chain) sum += world_from_node[node].translation();
    origins[s] = sum / static_cast<double>(segment.chain.size());
  }
  origins[index(Segment::pelvis)] =
      0.5 * (origins[index(Segment::thigh_l)] + origins[index(Segment::thigh_r)]);
  return origins;
}

void swap_sides(Humanoid& humanoid) {
  for (int s = 0; s < kSegmentCount; ++s) {
    const int m = index(mirror_of(segment_at(s)));
    if (m <= s) continue;
    std::swap(humanoid.segments[s], humanoid.segments[m]);
    std::swap(humanoid.fused_origin[s], humanoid.fused_origin[m]);
  }
  std::swap(humanoid.toes[0], humanoid.toes[1]);
  std::swap(humanoid.middle_finger[0], humanoid.middle_finger[1]);
}

}  // namespace ukemi
