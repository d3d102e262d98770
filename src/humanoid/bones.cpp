#include "humanoid/bones.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "base/nearest.h"
#include "humanoid/names.h"

namespace ukemi {
namespace {

struct Candidate {
  int node = -1;  // -1: the limb has no such bone
  int score = 0;
};

/// A skinned bone is worth more than any name: control rigs carry the same names as the rig that deforms.
constexpr int kSkinBonus = 100;
/// Some exporters list every node in the skin: those that move no vertex are worth less.
constexpr int kWeightBonus = 30;
/// Bones below a control ("Character_Ctrl_Reference") are the control rig's copies.
constexpr int kBelowHelper = 3;

/// Joints that move at least one vertex.
std::vector<char> weighted_joints(const Character& character) {
  std::vector<char> result(character.skeleton.nodes.size(), 0);
  for (const MeshPart& part : character.parts) {
    if (part.skin < 0) continue;
    const std::vector<int>& joints = character.skins[part.skin].joints;
    for (std::size_t v = 0; v < part.joints.size(); ++v)
      for (int k = 0; k < 4; ++k)
        if (part.weights[v][k] > 0.0f) result[joints[part.joints[v][k]]] = 1;
  }
  return result;
}

struct Reader {
  const Character& character;
  std::vector<NameReading> names;
  std::vector<char> skinned, weighted, below_helper;
  bool any_skin = false;

  explicit Reader(const Character& c) : character(c), skinned(skin_joints(c)), weighted(weighted_joints(c)) {
    for (const Node& node : c.skeleton.nodes) names.push_back(read_name(node.name));
    any_skin = !c.skins.empty();
    below_helper.assign(names.size(), 0);
    for (const int node : c.skeleton.order)
      if (const int parent = c.skeleton.nodes[node].parent; parent >= 0)
        below_helper[node] = below_helper[parent] != 0 || names[parent].helper ? 1 : 0;
  }

  std::vector<Candidate> candidates(Part part, Side side, bool optional) const {
    std::vector<Candidate> result;
    if (optional) result.push_back({});
    for (const int node : character.skeleton.order) {
      if (names[node].side != side) continue;
      const int score = std::max(1, fit(names[node], part) - (below_helper[node] ? kBelowHelper : 0));
      if (fit(names[node], part) == 0) continue;
      result.push_back(
          {node, score + (skinned[node] ? kSkinBonus : 0) + (weighted[node] ? kWeightBonus : 0)});
    }
    return result;
  }
};

/// Two or more palms beside each other are parts of a hand that no bone carries whole.
void drop_split_palms(const Skeleton& skeleton, std::vector<Candidate>& hands, const Reader& reader) {
  const auto is_palm = [&](const Candidate& c) { return c.node >= 0 && reader.names[c.node].stem == "palm"; };
  std::erase_if(hands, [&](const Candidate& hand) {
    return is_palm(hand) && std::any_of(hands.begin(), hands.end(), [&](const Candidate& other) {
             return is_palm(other) && other.node != hand.node &&
                    skeleton.nodes[other.node].parent == skeleton.nodes[hand.node].parent;
           });
  });
}

struct Limb {
  std::array<int, 4> nodes{-1, -1, -1,
                           -1};  // clavicle, upper arm, forearm, hand; or (none), thigh, shank, foot
  int score = -1;
};

/// The four candidates, each below the one before, with the highest sum of scores. The last may be detached
/// (an IK-driven foot) when a skin names it.
Limb best_limb(const Reader& reader, const std::array<std::vector<Candidate>, 4>& lists) {
  const Skeleton& skeleton = reader.character.skeleton;
  const auto below = [&](const Candidate& upper, const Candidate& lower) {
    return upper.node < 0 || lower.node < 0 || skeleton.is_ancestor(upper.node, lower.node);
  };
  const auto may_be_detached = [&](const Candidate& upper, const Candidate& lower) {
    return lower.node >= 0 && lower.node != upper.node && (reader.skinned[lower.node] || !reader.any_skin) &&
           !skeleton.is_ancestor(lower.node, upper.node);
  };
  Limb best;
  for (const Candidate& a : lists[0])
    for (const Candidate& b : lists[1]) {
      if (!below(a, b) || a.node == b.node) continue;
      for (const Candidate& c : lists[2]) {
        if (!below(b, c)) continue;
        for (const Candidate& d : lists[3]) {
          const bool attached = below(c, d);
          if (!attached && !may_be_detached(c, d)) continue;
          const int score = a.score + b.score + c.score + d.score + (d.node >= 0 && attached ? 20 : 0);
          if (score > best.score) best = {{a.node, b.node, c.node, d.node}, score};
        }
      }
    }
  return best;
}

constexpr std::array<std::array<Segment, 4>, 2> kArms = {
    {{Segment::clavicle_l, Segment::upperarm_l, Segment::forearm_l, Segment::hand_l},
     {Segment::clavicle_r, Segment::upperarm_r, Segment::forearm_r, Segment::hand_r}}};
constexpr std::array<std::array<Segment, 3>, 2> kLegs = {
    {{Segment::thigh_l, Segment::shank_l, Segment::foot_l},
     {Segment::thigh_r, Segment::shank_r, Segment::foot_r}}};

void limbs_by_name(const Reader& reader, Bones& bones) {
  for (int i = 0; i < 2; ++i) {
    const Side side = i == 0 ? Side::left : Side::right;
    std::array<std::vector<Candidate>, 4> arm = {
        reader.candidates(Part::clavicle, side, true), reader.candidates(Part::upper_arm, side, false),
        reader.candidates(Part::forearm, side, false), reader.candidates(Part::hand, side, true)};
    drop_split_palms(reader.character.skeleton, arm[3], reader);
    const Limb found_arm = best_limb(reader, arm);
    const std::array<std::vector<Candidate>, 4> leg = {
        std::vector<Candidate>{{}}, reader.candidates(Part::thigh, side, false),
        reader.candidates(Part::shank, side, false), reader.candidates(Part::foot, side, true)};
    const Limb found_leg = best_limb(reader, leg);
    for (int k = 0; k < 4; ++k)
      if (found_arm.nodes[k] >= 0) bones.set(kArms[i][k], found_arm.nodes[k], "name");
    for (int k = 0; k < 3; ++k)
      if (found_leg.nodes[k + 1] >= 0) bones.set(kLegs[i][k], found_leg.nodes[k + 1], "name");
  }
}

int legs_fork(const Skeleton& skeleton, const Bones& bones) {
  return common_ancestor(skeleton, bones[Segment::thigh_l], bones[Segment::thigh_r]);
}
int arms_fork(const Skeleton& skeleton, const Bones& bones) {
  const auto top = [&](Segment clavicle, Segment arm) {
    return bones[clavicle] >= 0 ? bones[clavicle] : bones[arm];
  };
  return common_ancestor(skeleton, top(Segment::clavicle_l, Segment::upperarm_l),
                         top(Segment::clavicle_r, Segment::upperarm_r));
}

/// The named pelvis nearest to where the legs fork; the fork itself where no name fits.
void pelvis_by_name(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  const int fork = legs_fork(skeleton, bones);
  Candidate best;
  for (const Candidate& c : reader.candidates(Part::pelvis, Side::none, false)) {
    const bool related =
        fork < 0 || is_at_or_below(skeleton, c.node, fork) || skeleton.nodes[c.node].parent == fork;
    const int score = c.score + (c.node == fork ? 4 : 0) + (related ? 10 : 0);
    if (score > best.score) best = {c.node, score};
  }
  if (best.node >= 0) bones.set(Segment::pelvis, best.node, "name");
}

void head_by_name(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  const int fork = arms_fork(skeleton, bones);
  Candidate best;
  for (const Candidate& c : reader.candidates(Part::head, Side::none, false)) {
    const int score = c.score + (fork >= 0 && skeleton.is_ancestor(fork, c.node) ? 20 : 0);
    if (score > best.score) best = {c.node, score};
  }
  if (best.node >= 0) bones.set(Segment::head, best.node, "name");
}

/// Without a name: the pelvis is where the legs fork; the head is the far end of the straight chain that
/// rises from where the arms fork.
void trunk_by_topology(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  if (bones[Segment::pelvis] < 0)
    if (const int fork = legs_fork(skeleton, bones); fork >= 0) bones.set(Segment::pelvis, fork, "topology");
  const int fork = arms_fork(skeleton, bones);
  if (bones[Segment::head] >= 0 || fork < 0) return;
  const auto children = skeleton.children();
  const auto carries_arm = [&](int node) {
    return is_at_or_below(skeleton, node, bones[Segment::upperarm_l]) ||
           is_at_or_below(skeleton, node, bones[Segment::upperarm_r]);
  };
  const auto usable = [&](int node) {
    return !carries_arm(node) && !reader.names[node].helper && !reader.names[node].end &&
           (!reader.any_skin || reader.skinned[node]);
  };
  int head = -1;
  for (int at = fork;;) {
    std::vector<int> next;
    std::copy_if(children[at].begin(), children[at].end(), std::back_inserter(next), usable);
    if (next.size() != 1) break;
    at = head = next[0];
  }
  if (head >= 0) bones.set(Segment::head, head, "topology");
}

std::optional<Segment> segment_of(VrmBone bone) {
  const int side = bone.side == Side::right ? 1 : 0;
  switch (bone.part) {
    case Part::pelvis:
      return Segment::pelvis;
    case Part::head:
      return Segment::head;
    case Part::clavicle:
    case Part::upper_arm:
    case Part::forearm:
    case Part::hand:
      return kArms[side][static_cast<int>(bone.part) - static_cast<int>(Part::clavicle)];
    case Part::thigh:
    case Part::shank:
    case Part::foot:
      return kLegs[side][static_cast<int>(bone.part) - static_cast<int>(Part::thigh)];
    default:
      return std::nullopt;
  }
}

void apply_vrm(const Character& character, Bones& bones) {
  for (const auto& [name, node] : character.vrm_bones) {
    const auto bone = vrm_bone(name);
    if (!bone || node < 0 || node >= character.skeleton.size()) continue;
    if (const auto segment = segment_of(*bone)) bones.set(*segment, node, "vrm");
  }
}

Status apply_user_map(const Character& character, const HumanoidOptions& options, Bones& bones) {
  for (const auto& [segment_name, label] : options.map) {
    const auto segment = segment_named(segment_name);
    if (!segment) {
      std::vector<std::string> known;
      for (int i = 0; i < kSegmentCount; ++i) known.emplace_back(name(segment_at(i)));
      return usage_error(character.path, fmt::format("there is no segment '{}'", segment_name),
                         suggestion(segment_name, known));
    }
    const int node = character.skeleton.find(label);
    if (node < 0) {
      std::vector<std::string> known;
      for (int i = 0; i < character.skeleton.size(); ++i) known.push_back(character.skeleton.label(i));
      const std::string near = nearest_word(label, known);
      return error_about(
          segment_name,
          usage_error(character.path, fmt::format("there is no node '{}', or more than one", label),
                      near.empty() ? "give a node's unique name, or its #INDEX in the file"
                                   : fmt::format("did you mean '{}'?", near)));
    }
    bones.set(*segment, node, "user");
  }
  return Done{};
}

/// Later sources fill what earlier ones left open.
void fill(Bones& bones, const Bones& more) {
  for (int s = 0; s < kSegmentCount; ++s)
    if (bones.node[s] < 0 && more.node[s] >= 0) bones.set(segment_at(s), more.node[s], more.by[s]);
}

constexpr Segment kMustHave[] = {
    Segment::pelvis,    Segment::head,    Segment::upperarm_l, Segment::forearm_l, Segment::upperarm_r,
    Segment::forearm_r, Segment::thigh_l, Segment::shank_l,    Segment::thigh_r,   Segment::shank_r};

bool complete(const Bones& bones) {
  return std::all_of(std::begin(kMustHave), std::end(kMustHave), [&](Segment s) { return bones[s] >= 0; });
}

/// For the message: single bones whose limb is not complete, upper before lower.
void add_stray_bones(const Reader& reader, Bones& bones) {
  constexpr std::pair<Segment, Part> kParts[] = {{Segment::upperarm_l, Part::upper_arm},
                                                 {Segment::forearm_l, Part::forearm},
                                                 {Segment::thigh_l, Part::thigh},
                                                 {Segment::shank_l, Part::shank}};
  for (const auto& [left, part] : kParts)
    for (const Side side : {Side::left, Side::right}) {
      const Segment segment = side == Side::left ? left : mirror_of(left);
      if (bones[segment] >= 0) continue;
      Candidate best;
      for (const Candidate& c : reader.candidates(part, side, false))
        if (c.score > best.score &&
            std::find(bones.node.begin(), bones.node.end(), c.node) == bones.node.end())
          best = c;
      if (best.node >= 0) bones.set(segment, best.node, "name");
    }
}

Error not_a_humanoid(const Character& character, const Bones& bones, bool any_skin) {
  std::vector<std::string> found, missing;
  for (const Segment s : kMustHave) {
    if (bones[s] >= 0)
      found.push_back(fmt::format("{} ({})", name(s), character.skeleton.label(bones[s])));
    else
      missing.emplace_back(name(s));
  }
  const std::vector<char> skinned = skin_joints(character);
  const auto joints = std::count(skinned.begin(), skinned.end(), 1);
  const std::string what_is_there =
      any_skin ? fmt::format("{} nodes, {} of them skin joints", character.skeleton.size(), joints)
               : fmt::format("{} nodes and no skin", character.skeleton.size());
  return input_error(
      character.path,
      fmt::format(
          "not a humanoid: looked for a pelvis, a head, two arms (upper arm, forearm) and two legs (thigh, "
          "shank) by VRM data, names and shape in {}; found {}; missing {}",
          what_is_there, found.empty() ? "none of them" : fmt::format("{}", fmt::join(found, ", ")),
          fmt::join(missing, ", ")),
      "if the character has these bones, name them with --map SEGMENT=NODE");
}

}  // namespace

int common_ancestor(const Skeleton& skeleton, int a, int b) {
  if (a < 0 || b < 0) return -1;
  while (a >= 0 && !is_at_or_below(skeleton, a, b)) a = skeleton.nodes[a].parent;
  return a;
}

std::vector<int> path_below(const Skeleton& skeleton, int top, int node) {
  std::vector<int> path;
  for (int i = node; i != top; i = skeleton.nodes[i].parent) {
    if (i < 0) return {};
    path.push_back(i);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<char> skin_joints(const Character& character) {
  std::vector<char> result(character.skeleton.nodes.size(), 0);
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      if (joint >= 0 && joint < character.skeleton.size()) result[joint] = 1;
  return result;
}

Result<Bones> find_bones(const Character& character, const HumanoidOptions& options) {
  const Reader reader(character);
  Bones bones;
  if (Status status = apply_user_map(character, options, bones); !status) return status.error();
  Bones vrm;
  apply_vrm(character, vrm);
  fill(bones, vrm);
  if (vrm.node == Bones().node || !complete(bones)) {
    Bones named;
    limbs_by_name(reader, named);
    Bones so_far = bones;
    fill(so_far, named);
    if (so_far[Segment::pelvis] < 0) pelvis_by_name(reader, so_far);
    if (so_far[Segment::head] < 0) head_by_name(reader, so_far);
    bones = so_far;
  }
  trunk_by_topology(reader, bones);
  if (!complete(bones)) {
    Bones shape = find_by_topology(character, rest_pose(character.skeleton));
    if (complete(shape)) fill(bones, shape);
  }
  if (!complete(bones)) {
    add_stray_bones(reader, bones);
    return not_a_humanoid(character, bones, reader.any_skin);
  }
  return bones;
}

std::optional<Bones> find_bones_by_shape(const Character& character, const HumanoidOptions& options) {
  Bones bones;
  if (const Status status = apply_user_map(character, options, bones); !status) return std::nullopt;
  fill(bones, find_by_topology(character, rest_pose(character.skeleton)));
  return complete(bones) ? std::optional(bones) : std::nullopt;
}

}  // namespace ukemi
