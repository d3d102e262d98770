// The humanoid in an unnamed hierarchy: a fork with two mirrored legs, a second one further up with two
// mirrored arms and a head between them.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bones/bones.h"
#include "bones/names.h"

namespace ukemi {
namespace {

/// The three joints of a limb and its two bone lengths. Without an ankle (`end` and `last` are -1) the lower
/// bone is taken to go straight on and to be as long as the upper one.
struct LimbShape {
  int upper = -1, middle = -1, end = -1, last = -1;
  double upper_length = 0.0, lower_length = 0.0;
  Vec3 end_place = Vec3::Zero();
  double length() const { return upper_length + lower_length; }
};

struct Tree {
  const Skeleton& skeleton;
  std::vector<Vec3> position;
  std::vector<std::vector<int>> children;  // only nodes that may be bones
  std::vector<double> reach;               // length of the longest path below
  std::vector<char> carries_skin;

  Tree(const Character& character, const Pose& pose, const std::vector<char>& allowed)
      : skeleton(character.skeleton), carries_skin(ukemi::carries_skin(character)) {
    const std::vector<Affine> world = world_transforms(skeleton, pose);
    for (const Affine& m : world) position.push_back(m.translation());
    children.resize(skeleton.nodes.size());
    reach.assign(skeleton.nodes.size(), 0.0);
    for (auto it = skeleton.order.rbegin(); it != skeleton.order.rend(); ++it) {
      const int parent = skeleton.nodes[*it].parent;
      if (parent < 0 || !allowed[*it]) continue;
      children[parent].push_back(*it);
      reach[parent] = std::max(reach[parent], reach[*it] + (position[*it] - position[parent]).norm());
    }
    for (auto& list : children) std::sort(list.begin(), list.end());
  }

  double between(int a, int b) const { return (position[a] - position[b]).norm(); }

  /// From `node` down along the branch that reaches farthest.
  std::vector<int> main_path(int node) const {
    std::vector<int> path{node};
    while (!children[node].empty()) {
      node = *std::max_element(children[node].begin(), children[node].end(), [&](int a, int b) {
        return reach[a] + between(a, path.back()) < reach[b] + between(b, path.back());
      });
      path.push_back(node);
    }
    return path;
  }
};

/// From `node` down, without the nodes that lie in the same place as the one before.
std::vector<int> joints_below(const Tree& tree, int node) {
  std::vector<int> path;
  for (const int next : tree.main_path(node))
    if (path.empty() || tree.between(path.back(), next) > 0.01 * tree.reach[node]) path.push_back(next);
  return path;
}

/// How like a limb two bones are: the more, the longer they are and the closer in length.
double limb_score(double upper, double lower) {
  return std::min(upper, lower) - 0.5 * std::abs(upper - lower);
}

LimbShape limb_of(const Tree& tree, int upper, int middle, int end, int last) {
  return {
      upper, middle, end, last, tree.between(upper, middle), tree.between(middle, end), tree.position[end]};
}

/// A limb of two joints with nothing below them.
std::optional<LimbShape> limb_without_end(const Tree& tree, const std::vector<int>& path) {
  if (path.size() != 2) return std::nullopt;
  const Vec3 upper = tree.position[path[1]] - tree.position[path[0]];
  return LimbShape{path[0], path[1], -1, -1, upper.norm(), upper.norm(), tree.position[path[1]] + upper};
}

/// Of all neighbouring triples along the path the one whose two bones are long and of like length: shoulder,
/// elbow, wrist beat clavicle, shoulder, elbow and elbow, wrist, finger.
std::optional<LimbShape> limb_at(const Tree& tree, int node, LegEnds ends) {
  const std::vector<int> path = joints_below(tree, node);
  if (ends == LegEnds::may_be_missing && path.size() == 2) return limb_without_end(tree, path);
  std::optional<LimbShape> best;
  double best_score = 0.0;
  for (std::size_t i = 0; i + 2 < path.size(); ++i) {
    const double a = tree.between(path[i], path[i + 1]), b = tree.between(path[i + 1], path[i + 2]);
    if (limb_score(a, b) <= best_score) continue;
    best_score = limb_score(a, b);
    best = limb_of(tree, path[i], path[i + 1], path[i + 2], path.back());
  }
  return best;
}

/// The same of a limb whose upper bone is known; other bones (of twist) may lie between its joints.
std::optional<LimbShape> limb_from(const Tree& tree, int upper) {
  const std::vector<int> path = joints_below(tree, upper);
  std::optional<LimbShape> best;
  double best_score = 0.0;
  for (std::size_t j = 1; j < path.size(); ++j)
    for (std::size_t k = j + 1; k < path.size(); ++k) {
      const double a = tree.between(upper, path[j]), b = tree.between(path[j], path[k]);
      if (limb_score(a, b) <= best_score + 1e-9 * a) continue;
      best_score = limb_score(a, b);
      best = limb_of(tree, upper, path[j], path[k], path.back());
    }
  return best;
}

struct Pair {
  LimbShape a, b;
  double length() const { return a.length() + b.length(); }
  bool has_ends() const { return a.end >= 0 && b.end >= 0; }
};

bool alike(double a, double b) { return std::abs(a - b) <= 0.08 * std::max(a, b); }

/// The longest two branches of a fork that mirror each other.
std::vector<Pair> mirrored_pairs(const Tree& tree, int fork, LegEnds ends) {
  std::vector<LimbShape> limbs;
  for (const int child : tree.children[fork])
    if (const auto limb = limb_at(tree, child, ends)) limbs.push_back(*limb);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < limbs.size(); ++i)
    for (std::size_t j = i + 1; j < limbs.size(); ++j) {
      const LimbShape &a = limbs[i], &b = limbs[j];
      const bool apart = tree.between(a.upper, b.upper) > 0.05 * a.length();
      if (apart && alike(a.upper_length, b.upper_length) && alike(a.lower_length, b.lower_length))
        pairs.push_back({a, b});
    }
  return pairs;
}

/// The far end of the chain that rises from the arms' fork and is not a limb.
int end_above(const Tree& tree, int fork, const Pair& arms, const Pair& legs) {
  const auto carries_limb = [&](int node) {
    for (const LimbShape* limb : {&arms.a, &arms.b, &legs.a, &legs.b})
      if (is_at_or_below(tree.skeleton, node, limb->upper)) return true;
    return false;
  };
  int at = fork, head = -1;
  for (;;) {
    std::vector<int> next;
    for (const int child : tree.children[at])
      if (!carries_limb(child)) next.push_back(child);
    if (next.empty() || (head >= 0 && next.size() > 1)) return head;
    at = head = *std::max_element(next.begin(), next.end(),
                                  [&](int a, int b) { return tree.reach[a] < tree.reach[b]; });
  }
}

/// That end, or the bone before it where the end carries no skin and only marks the crown.
int head_above(const Tree& tree, int fork, const Pair& arms, const Pair& legs) {
  const int end = end_above(tree, fork, arms, legs);
  if (end < 0 || tree.carries_skin[end]) return end;
  const int before = tree.skeleton.nodes[end].parent;
  return before != fork && tree.carries_skin[before] ? before : end;
}

struct BodyPlan {
  int pelvis = -1, head = -1;
  Pair legs, arms;
  double score = 0.0;
};

/// Legs point away from the trunk, arms do not reach as far down as the legs, all limbs have human
/// proportions.
bool plausible(const Tree& tree, const BodyPlan& shape) {
  const auto& p = tree.position;
  const Vec3 hips = 0.5 * (p[shape.legs.a.upper] + p[shape.legs.b.upper]);
  const Vec3 feet = 0.5 * (shape.legs.a.end_place + shape.legs.b.end_place);
  const Vec3 shoulders = 0.5 * (p[shape.arms.a.upper] + p[shape.arms.b.upper]);
  const Vec3 up = (hips - feet).normalized();
  const double trunk = (shoulders - hips).norm();
  const double legs = 0.5 * shape.legs.length(), arms = 0.5 * shape.arms.length();
  return (shoulders - hips).dot(up) > 0.7 * trunk && (p[shape.head] - hips).dot(up) > 0.5 * trunk &&
         legs > 0.3 * trunk && arms > 0.3 * trunk && arms < 2.5 * legs && legs < 6.0 * trunk;
}

/// True when a is on the subject's left: the feet point forward, else glTF's +z (z up: -y) is forward.
bool first_is_left(const Tree& tree, const BodyPlan& shape) {
  const auto& p = tree.position;
  const Vec3 hips = 0.5 * (p[shape.legs.a.upper] + p[shape.legs.b.upper]);
  const Vec3 ankles = 0.5 * (shape.legs.a.end_place + shape.legs.b.end_place);
  const Vec3 up = (hips - ankles).normalized();
  Vec3 forward = Vec3::Zero();
  if (shape.legs.a.last >= 0 && shape.legs.b.last >= 0)
    forward = 0.5 * (p[shape.legs.a.last] + p[shape.legs.b.last]) - ankles;
  forward -= forward.dot(up) * up;
  if (forward.norm() < 0.02 * shape.legs.length())
    forward = std::abs(up.z()) > std::abs(up.y()) ? Vec3(0, -1, 0) : Vec3(0, 0, 1);
  const Vec3 right = forward.cross(up);
  return (p[shape.legs.a.upper] - p[shape.legs.b.upper]).dot(right) < 0.0;
}

bool share_a_bone(const Pair& a, const Pair& b) {
  return a.a.upper == b.a.upper || a.a.upper == b.b.upper || a.b.upper == b.a.upper || a.b.upper == b.b.upper;
}

/// Whether a trunk may lead from the fork of the legs to that of the arms: further up the same branch, on the
/// same node, or on a branch that begins beside the pelvis (upper body and lower body).
bool may_be_trunk(const Tree& tree, int lower, const Pair& legs, int upper, const Pair& arms) {
  const Skeleton& skeleton = tree.skeleton;
  const int meets = common_ancestor(skeleton, lower, upper);
  if (meets < 0 || meets != lower) {
    if (meets < 0 || meets == upper || tree.between(meets, lower) > 0.3 * legs.a.length()) return false;
  }
  for (const LimbShape* leg : {&legs.a, &legs.b})
    if (is_at_or_below(skeleton, leg->upper, upper)) return false;
  for (const LimbShape* arm : {&arms.a, &arms.b})
    if (is_at_or_below(skeleton, arm->upper, lower)) return false;
  return !share_a_bone(legs, arms);
}

std::optional<BodyPlan> best_shape(const Tree& tree, LegEnds ends) {
  std::vector<std::pair<int, Pair>> forks;
  for (const int node : tree.skeleton.order)
    for (const Pair& pair : mirrored_pairs(tree, node, ends)) forks.emplace_back(node, pair);
  std::optional<BodyPlan> best;
  for (const auto& [lower, legs] : forks)
    for (const auto& [upper, arms] : forks) {
      if (!arms.has_ends() || !may_be_trunk(tree, lower, legs, upper, arms)) continue;
      BodyPlan shape{lower, head_above(tree, upper, arms, legs), legs, arms, legs.length() + arms.length()};
      if (shape.head < 0 || !plausible(tree, shape)) continue;
      if (!best || shape.score > best->score) best = shape;
    }
  return best;
}

/// Of the joints of the skin, or of all nodes where the skin covers only part of the limbs; what is named the
/// end of a bone is none.
std::optional<BodyPlan> shape_of(const Character& character, const Tree& all, const Pose& pose,
                                 const std::vector<char>& allowed, LegEnds ends) {
  constexpr double kClearlyMore = 1.1;
  if (character.skins.empty()) return best_shape(all, ends);
  std::vector<char> joints = skin_joints(character), bones = allowed;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] = joints[i] && allowed[i];
    bones[i] = bones[i] && (joints[i] || !read_name(character.skeleton.nodes[i].name).end);
  }
  const auto of_skin = best_shape(Tree(character, pose, joints), ends);
  const auto of_all = best_shape(Tree(character, pose, bones), ends);
  return of_skin && (!of_all || of_all->score < kClearlyMore * of_skin->score) ? of_skin : of_all;
}

void set_limb(Bones& bones, const LimbShape& limb, Segment upper, Segment middle, Segment end) {
  bones.set(upper, limb.upper, "topology");
  bones.set(middle, limb.middle, "topology");
  if (limb.end >= 0) bones.set(end, limb.end, "topology");
}

/// Whether a limb that is given goes through `limb`.
bool is_given(const Bones& given, Segment upper, const LimbShape& limb) {
  return given[upper] >= 0 && (given[upper] == limb.upper || given[upper] == limb.middle);
}

/// The limbs of a shape; left and right agree with the limbs that have names.
void set_limbs(const Tree& tree, const BodyPlan& shape, const Bones& given, Bones& bones) {
  const auto& p = tree.position;
  const auto across = [&](Segment left, Segment right) -> Vec3 {
    if (given[left] < 0 || given[right] < 0) return Vec3::Zero();
    return p[given[right]] - p[given[left]];
  };
  const Vec3 named =
      across(Segment::upperarm_l, Segment::upperarm_r) + across(Segment::thigh_l, Segment::thigh_r);
  const Vec3 a_to_b = p[shape.legs.b.upper] - p[shape.legs.a.upper];
  const auto& [leg_a, leg_b] = shape.legs;
  const bool a_is_left = is_given(given, Segment::thigh_l, leg_a) || is_given(given, Segment::thigh_r, leg_b);
  const bool b_is_left = is_given(given, Segment::thigh_l, leg_b) || is_given(given, Segment::thigh_r, leg_a);
  const bool left_first = a_is_left != b_is_left ? a_is_left
                          : named.isZero()       ? first_is_left(tree, shape)
                                                 : a_to_b.dot(named) > 0.0;
  const auto& [leg_l, leg_r] =
      left_first ? std::pair(shape.legs.a, shape.legs.b) : std::pair(shape.legs.b, shape.legs.a);
  const Vec3 right = p[leg_r.upper] - p[leg_l.upper];
  const bool arm_a_right = (p[shape.arms.a.upper] - p[shape.arms.b.upper]).dot(right) > 0.0;
  // An arm that has a name is on the side that it says, wherever it lies.
  const auto& [arm_a, arm_b] = shape.arms;
  const bool says_a_right =
      is_given(given, Segment::upperarm_r, arm_a) || is_given(given, Segment::upperarm_l, arm_b);
  const bool says_a_left =
      is_given(given, Segment::upperarm_l, arm_a) || is_given(given, Segment::upperarm_r, arm_b);
  const auto& [arm_l, arm_r] = (says_a_right != says_a_left ? says_a_right : arm_a_right)
                                   ? std::pair(shape.arms.b, shape.arms.a)
                                   : std::pair(shape.arms.a, shape.arms.b);
  set_limb(bones, leg_l, Segment::thigh_l, Segment::shank_l, Segment::foot_l);
  set_limb(bones, leg_r, Segment::thigh_r, Segment::shank_r, Segment::foot_r);
  set_limb(bones, arm_l, Segment::upperarm_l, Segment::forearm_l, Segment::hand_l);
  set_limb(bones, arm_r, Segment::upperarm_r, Segment::forearm_r, Segment::hand_r);
  for (const auto& [arm, clavicle] :
       {std::pair(arm_l, Segment::clavicle_l), std::pair(arm_r, Segment::clavicle_r)}) {
    const int above = tree.skeleton.nodes[arm.upper].parent;
    const bool other_limb_below = is_at_or_below(tree.skeleton, above, arm_l.upper) &&
                                  is_at_or_below(tree.skeleton, above, arm_r.upper);
    if (above >= 0 && !other_limb_below) bones.set(clavicle, above, "topology");
  }
}

/// Limbs from the upper bones that are given.
void follow_given(const Tree& tree, const Bones& given, Bones& bones) {
  constexpr std::array<Segment, 4> kUpper = {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l,
                                             Segment::thigh_r};
  for (const Segment upper : kUpper) {
    if (given[upper] < 0 || given[upper] == bones[upper]) continue;
    const auto limb = limb_from(tree, given[upper]);
    if (!limb) continue;
    set_limb(bones, *limb, upper, segment_at(index(upper) + 1), segment_at(index(upper) + 2));
    const bool is_arm = upper == Segment::upperarm_l || upper == Segment::upperarm_r;
    if (!is_arm) continue;
    const Segment clavicle = segment_at(index(upper) - 1);
    if (!tree.skeleton.is_ancestor(bones[clavicle], given[upper])) bones.set(clavicle, -1, "");
  }
}

}  // namespace

Bones find_by_topology(const Character& character, const Pose& pose, const std::vector<char>& allowed,
                       const Bones& given, LegEnds ends) {
  const Tree tree(character, pose, allowed);
  Bones bones;
  if (const auto shape = shape_of(character, tree, pose, allowed, ends)) {
    bones.set(Segment::pelvis, shape->pelvis, "topology");
    bones.set(Segment::head, shape->head, "topology");
    set_limbs(tree, *shape, given, bones);
  }
  follow_given(tree, given, bones);
  for (int s = 0; s < kSegmentCount; ++s)
    if (given.node[s] >= 0) bones.set(segment_at(s), given.node[s], given.by[s]);
  return bones;
}

}  // namespace ukemi
