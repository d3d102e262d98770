#include "bones/bones.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/nearest.h"
#include "bones/names.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

struct Candidate {
  int node = -1;  // -1: the limb has no such bone
  int score = 0;
  bool given = false;
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

/// Nodes that hold one of `marked` at or below them.
std::vector<char> holders(const Skeleton& skeleton, std::vector<char> marked) {
  for (auto it = skeleton.order.rbegin(); it != skeleton.order.rend(); ++it)
    if (const int parent = skeleton.nodes[*it].parent; parent >= 0 && marked[*it]) marked[parent] = 1;
  return marked;
}

std::vector<char> mesh_nodes(const Character& character) {
  std::vector<char> result(character.skeleton.nodes.size(), 0);
  for (const MeshPart& part : character.parts)
    if (part.node >= 0) result[part.node] = 1;
  return result;
}

/// Nodes at or below `top`; all where it is -1.
std::vector<char> nodes_below(const Skeleton& skeleton, int top) {
  std::vector<char> below(skeleton.nodes.size(), static_cast<char>(top < 0 ? 1 : 0));
  for (const int node : skeleton.order)
    if (const int parent = skeleton.nodes[node].parent; node == top || (parent >= 0 && below[parent]))
      below[node] = 1;
  return below;
}

Part part_of(Segment segment) {
  switch (segment) {
    case Segment::pelvis:
      return Part::pelvis;
    case Segment::head:
      return Part::head;
    case Segment::clavicle_l:
    case Segment::clavicle_r:
      return Part::clavicle;
    case Segment::upperarm_l:
    case Segment::upperarm_r:
      return Part::upper_arm;
    case Segment::forearm_l:
    case Segment::forearm_r:
      return Part::forearm;
    case Segment::hand_l:
    case Segment::hand_r:
      return Part::hand;
    case Segment::thigh_l:
    case Segment::thigh_r:
      return Part::thigh;
    case Segment::shank_l:
    case Segment::shank_r:
      return Part::shank;
    case Segment::foot_l:
    case Segment::foot_r:
      return Part::foot;
    case Segment::abdomen:
    case Segment::chest:
      break;
  }
  return Part::spine;
}

Side side_of(Segment segment) {
  if (mirror_of(segment) == segment) return Side::none;
  return segment < mirror_of(segment) ? Side::left : Side::right;
}

struct Reader {
  const Character& character;
  std::vector<NameReading> names;
  std::vector<char> skinned, weighted, below_helper;
  std::vector<char> allowed;  // to be bones
  bool any_skin = false;

  Reader(const Character& c, std::vector<char> may_be_bones)
      : character(c),
        skinned(skin_joints(c)),
        weighted(weighted_joints(c)),
        allowed(std::move(may_be_bones)) {
    for (const Node& node : c.skeleton.nodes) names.push_back(read_name(node.name));
    any_skin = !c.skins.empty();
    below_helper.assign(names.size(), 0);
    for (const int node : c.skeleton.order)
      if (const int parent = c.skeleton.nodes[node].parent; parent >= 0)
        below_helper[node] = below_helper[parent] != 0 || names[parent].helper ? 1 : 0;
  }

  std::vector<Candidate> candidates(Part part, Side side) const {
    std::vector<Candidate> result;
    for (const int node : character.skeleton.order) {
      if (names[node].side != side || !allowed[node]) continue;
      const int score = std::max(1, fit(names[node], part) - (below_helper[node] ? kBelowHelper : 0));
      if (fit(names[node], part) == 0) continue;
      result.push_back(
          {node, score + (skinned[node] ? kSkinBonus : 0) + (weighted[node] ? kWeightBonus : 0)});
    }
    return result;
  }

  /// The bone that a better source gives, else all whose names fit; with none for a bone that may be missing.
  std::vector<Candidate> candidates(Segment segment, const Bones& given, bool optional) const {
    if (given[segment] >= 0) return {{given[segment], kSkinBonus, true}};
    std::vector<Candidate> result = candidates(part_of(segment), side_of(segment));
    if (optional) result.insert(result.begin(), Candidate{});
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
    const bool deforms = lower.node >= 0 && (lower.given || reader.skinned[lower.node] || !reader.any_skin);
    return deforms && lower.node != upper.node && !skeleton.is_ancestor(lower.node, upper.node);
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

/// Limbs that go through what is given already.
void limbs_by_name(const Reader& reader, const Bones& given, Bones& bones) {
  for (int i = 0; i < 2; ++i) {
    std::array<std::vector<Candidate>, 4> arm, leg{std::vector<Candidate>{{}}};
    for (std::size_t k = 0; k < 4; ++k) arm[k] = reader.candidates(kArms[i][k], given, k == 0 || k == 3);
    for (std::size_t k = 0; k < 3; ++k) leg[k + 1] = reader.candidates(kLegs[i][k], given, k == 2);
    drop_split_palms(reader.character.skeleton, arm[3], reader);
    const Limb found_arm = best_limb(reader, arm), found_leg = best_limb(reader, leg);
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

/// Names that bones of other parts carry as well: they count where the legs fork and nowhere else.
constexpr int kVagueName = 2;

/// Whether the legs hang on `pelvis`, or beside it on the same node.
bool carries_legs(const Skeleton& skeleton, int pelvis, int legs_fork) {
  return is_at_or_below(skeleton, pelvis, legs_fork) ||
         (legs_fork >= 0 && skeleton.nodes[pelvis].parent == legs_fork);
}

/// The named pelvis nearest to where the legs fork; none where no name fits.
void pelvis_by_name(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  const int fork = legs_fork(skeleton, bones);
  if (fork < 0) return;
  Candidate best;
  for (const Candidate& c : reader.candidates(Part::pelvis, Side::none)) {
    const bool vague = fit(reader.names[c.node], Part::pelvis) <= kVagueName;
    if (!carries_legs(skeleton, c.node, fork) || (vague && c.node != fork)) continue;
    const int score = c.score + (c.node == fork ? 4 : 0);
    if (score > best.score) best = {c.node, score};
  }
  if (best.node >= 0) bones.set(Segment::pelvis, best.node, "name");
}

/// Whether `head` lies nearer to the shoulders than to the hips, or beyond them: a bone of that name below
/// the pelvis is another's head, or a control.
bool lies_high(const Skeleton& skeleton, const Bones& bones, int head) {
  const std::vector<Affine> world = world_transforms(skeleton, rest_pose(skeleton));
  const auto middle = [&](int left, int right) -> Vec3 {
    return 0.5 * (world[left].translation() + world[right].translation());
  };
  const auto shoulder = [&](Segment arm, Segment clavicle) {
    return bones[arm] >= 0 ? bones[arm] : bones[clavicle];
  };
  const Vec3 hips = middle(bones[Segment::thigh_l], bones[Segment::thigh_r]);
  const Vec3 shoulders = middle(shoulder(Segment::upperarm_l, Segment::clavicle_l),
                                shoulder(Segment::upperarm_r, Segment::clavicle_r));
  const Vec3 trunk = shoulders - hips;
  return (world[head].translation() - hips).dot(trunk) >= 0.5 * trunk.squaredNorm();
}

/// Whether `head` belongs to the trunk that carries the arms, lies at its upper end, and carries no limb
/// itself.
bool is_above_the_trunk(const Skeleton& skeleton, const Bones& bones, int head) {
  const int arms = arms_fork(skeleton, bones), legs = legs_fork(skeleton, bones);
  const int trunk = common_ancestor(skeleton, legs, arms);
  const int meets = common_ancestor(skeleton, head, arms);
  if (meets < 0 || !is_at_or_below(skeleton, trunk, meets)) return false;
  if (!lies_high(skeleton, bones, head)) return false;
  for (const Segment limb : {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r})
    if (is_at_or_below(skeleton, head, bones[limb]) || is_at_or_below(skeleton, bones[limb], head))
      return false;
  return true;
}

void head_by_name(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  const int fork = arms_fork(skeleton, bones);
  if (fork < 0 || legs_fork(skeleton, bones) < 0) return;
  Candidate best;
  for (const Candidate& c : reader.candidates(Part::head, Side::none)) {
    if (!is_above_the_trunk(skeleton, bones, c.node)) continue;
    // A volume or a mesh below the head may be called head as well.
    if (best.node >= 0 && skeleton.is_ancestor(best.node, c.node)) continue;
    const int score = c.score + (skeleton.is_ancestor(fork, c.node) ? 20 : 0);
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
  const auto carries_limb = [&](int node) {
    for (const Segment s : {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r})
      if (is_at_or_below(skeleton, node, bones[s])) return true;
    return false;
  };
  const auto usable = [&](int node) {
    return reader.allowed[node] && !carries_limb(node) && !reader.names[node].helper &&
           !reader.names[node].end && (!reader.any_skin || reader.skinned[node]);
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

/// What the bake that wrote a BVH took for the segments: its hierarchy has no way to say that the armature
/// was mirrored.
void apply_bake(const Character& character, Bones& bones) {
  if (!character.bvh || character.animations.empty()) return;
  const Json json = Json::parse(character.animations.front().extras_json, nullptr, false);
  const Json::json_pointer place("/ukemi/segments");
  if (!json.is_object() || !json.contains(place) || !json[place].is_object()) return;
  for (const auto& [label, segment] : json[place].items()) {
    const auto named = segment_named(label);
    if (!named || !segment.is_object() || !segment.contains("node") || !segment["node"].is_string()) continue;
    const int node = character.skeleton.find(segment["node"].get<std::string>());
    if (node >= 0) bones.set(*named, node, "bake");
  }
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
  constexpr std::pair<Segment, Part> kParts[] = {
      {Segment::pelvis, Part::pelvis},        {Segment::head, Part::head},
      {Segment::upperarm_l, Part::upper_arm}, {Segment::forearm_l, Part::forearm},
      {Segment::thigh_l, Part::thigh},        {Segment::shank_l, Part::shank}};
  for (const auto& [left, part] : kParts)
    for (const Segment segment : {left, mirror_of(left)}) {
      const Side side = side_of(segment);
      if (bones[segment] >= 0) continue;
      Candidate best;
      for (const Candidate& c : reader.candidates(part, side))
        if (c.score > best.score &&
            std::find(bones.node.begin(), bones.node.end(), c.node) == bones.node.end())
          best = c;
      if (best.node >= 0) bones.set(segment, best.node, "name");
    }
}

/// What the user can do where bones are missing.
std::string fix_for_missing(const Bones& bones) {
  const bool upper_alone = std::any_of(std::begin(kMustHave), std::end(kMustHave), [&](Segment s) {
    const bool is_lower =
        s == Segment::forearm_l || s == Segment::forearm_r || s == Segment::shank_l || s == Segment::shank_r;
    return is_lower && bones[s] < 0 && bones[segment_at(index(s) - 1)] >= 0;
  });
  return upper_alone ? "an arm or a leg needs two bones: name the lower ones with --map SEGMENT=NODE, or "
                       "give limbs of one bone a second one"
                     : "if the character has these bones, name them with --map SEGMENT=NODE";
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
  const std::string fault = missing.empty() ? "but " + misplaced(character, bones)
                                            : fmt::format("missing {}", fmt::join(missing, ", "));
  return input_error(
      character.path,
      fmt::format(
          "not a humanoid: looked for a pelvis, a head, two arms (upper arm, forearm) and two legs (thigh, "
          "shank) by VRM data, names and shape in {}; found {}; {}",
          what_is_there, found.empty() ? "none of them" : fmt::format("{}", fmt::join(found, ", ")), fault),
      missing.empty() ? "if these are the character's bones, parent them as the limbs of a body"
                      : fix_for_missing(bones));
}

/// A hand or foot whose name fits and says no side is that of the limb that it hangs on.
void ends_without_side(const Reader& reader, Bones& bones) {
  const Skeleton& skeleton = reader.character.skeleton;
  const auto children = skeleton.children();
  for (const Segment end : {Segment::hand_l, Segment::hand_r, Segment::foot_l, Segment::foot_r}) {
    const int above = bones[segment_at(index(end) - 1)];
    if (bones[end] >= 0 || above < 0) continue;
    std::vector<int> fitting;
    for (const int child : children[static_cast<std::size_t>(above)]) {
      NameReading name = reader.names[static_cast<std::size_t>(child)];
      const bool says_no_side = name.side == Side::none;
      name.side = side_of(end);
      const bool deforms = !reader.any_skin || reader.skinned[static_cast<std::size_t>(child)];
      if (reader.allowed[static_cast<std::size_t>(child)] && deforms && says_no_side &&
          fit(name, part_of(end)) > 0)
        fitting.push_back(child);
    }
    if (fitting.size() == 1) bones.set(end, fitting.front(), "name");
  }
}

/// Every source in turn, on the nodes that may be bones.
Bones search(const Reader& reader, const Bones& given, LegEnds ends = LegEnds::required) {
  Bones bones = given;
  const auto trunk = [&] {
    if (bones[Segment::pelvis] < 0) pelvis_by_name(reader, bones);
    if (bones[Segment::head] < 0) head_by_name(reader, bones);
  };
  if (!complete(bones)) {
    Bones named;
    limbs_by_name(reader, bones, named);
    fill(bones, named);
    ends_without_side(reader, bones);
  }
  trunk();
  trunk_by_topology(reader, bones);
  if (complete(bones)) return bones;
  const Character& character = reader.character;
  const Bones shape = find_by_topology(character, rest_pose(character.skeleton), reader.allowed, bones, ends);
  if (!complete(shape)) return bones;
  for (int s = index(Segment::clavicle_l); s < kSegmentCount; ++s)
    if (bones.node[s] < 0 && shape.node[s] >= 0) bones.set(segment_at(s), shape.node[s], shape.by[s]);
  trunk();
  fill(bones, shape);
  return bones;
}

/// Nodes that may be bones at first: beside a skin its joints and the nodes above them, nodes that hold no
/// mesh, and those below joints that hold some but are none; in the second round also meshes that hang on
/// joints. Below the root that the user names.
std::vector<char> may_be_bones(const Character& character, int root, bool second_round) {
  const Skeleton& skeleton = character.skeleton;
  std::vector<char> allowed = nodes_below(skeleton, root);
  if (character.skins.empty()) return allowed;
  const std::vector<char> joints = skin_joints(character);
  const std::vector<char> holds_joint = holders(skeleton, joints);
  const std::vector<char> is_mesh = mesh_nodes(character);
  const std::vector<char> holds_mesh = holders(skeleton, is_mesh);
  std::vector<char> on_joint(joints);
  for (const int node : skeleton.order) {
    const int parent = skeleton.nodes[node].parent;
    if (parent >= 0 && on_joint[parent]) on_joint[node] = 1;
    const bool may_hold_mesh = on_joint[node] && (second_round || !is_mesh[node]);
    if (!holds_joint[node] && holds_mesh[node] && !may_hold_mesh) allowed[node] = 0;
  }
  return allowed;
}

/// True where two skeletons lie in the same place: the controls of one figure.
bool same_place(const Character& character, int a, int b) {
  const std::vector<Affine> world = world_transforms(character.skeleton, rest_pose(character.skeleton));
  double size = 0.0;
  for (const Affine& m : world) size = std::max(size, (m.translation() - world[a].translation()).norm());
  return (world[a].translation() - world[b].translation()).norm() < 0.05 * size;
}

/// Says so where what is left of the file holds a second body, by names or, of bones that move a skin, by
/// shape.
void warn_of_another_figure(const Character& character, const Bones& bones, Diagnostics& diagnostics) {
  const Skeleton& skeleton = character.skeleton;
  const int top =
      common_ancestor(skeleton, bones[Segment::pelvis],
                      common_ancestor(skeleton, legs_fork(skeleton, bones), bones[Segment::head]));
  if (top < 0) return;
  std::vector<char> allowed = may_be_bones(character, -1, false);
  const std::vector<char> taken = nodes_below(skeleton, top);
  for (std::size_t i = 0; i < allowed.size(); ++i) allowed[i] = allowed[i] && !taken[i];
  const Reader reader(character, std::move(allowed));
  const Bones other = search(reader, Bones());
  const int pelvis = other[Segment::pelvis];
  if (!complete(other) || !misplaced(character, other).empty()) return;
  const bool by_shape = other.by[index(Segment::thigh_l)] == "topology";
  if ((reader.any_skin ? !reader.weighted[other[Segment::thigh_l]] : by_shape) ||
      same_place(character, bones[Segment::pelvis], pelvis))
    return;
  diagnostics.warn(character.path.string(),
                   fmt::format("holds more than one figure; the one at '{}' is taken: --root '{}' takes the "
                               "other",
                               skeleton.label(bones[Segment::pelvis]), skeleton.label(pelvis)));
}

bool by_user(const Bones& bones) {
  return std::find(bones.by.begin(), bones.by.end(), "user") != bones.by.end();
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

Result<Bones> find_bones(const Character& character, const HumanoidOptions& options,
                         Diagnostics& diagnostics) {
  int root = -1;
  if (!options.root.empty()) {
    const auto node = node_of_label(character, options.root);
    if (!node) return node.error();
    root = *node;
  }
  Bones given;
  if (Status status = apply_user_map(character, options, given); !status) return status.error();
  Bones vrm;
  apply_vrm(character, vrm);
  apply_bake(character, vrm);
  if (root < 0) fill(given, vrm);
  Bones bones;
  for (const bool second_round : {false, true}) {
    const Reader reader(character, may_be_bones(character, root, second_round));
    bones = search(reader, given);
    if (complete(bones)) break;
    if (!second_round) continue;
    const bool is_unnamed =
        std::all_of(bones.node.begin(), bones.node.end(), [](int node) { return node < 0; });
    if (is_unnamed) bones = search(reader, given, LegEnds::may_be_missing);
    if (!complete(bones)) add_stray_bones(reader, bones);
  }
  if (complete(bones)) add_feet_apart(character, bones);
  const bool is_complete = complete(bones);
  const std::string fault = is_complete ? misplaced(character, bones) : std::string();
  if (is_complete && fault.empty()) {
    warn_of_another_figure(character, bones, diagnostics);
    return bones;
  }
  if (is_complete && by_user(bones))
    return usage_error(character.path, fault,
                       "name bones of one body with --map; inspect shows what is found without it");
  return not_a_humanoid(character, bones, !character.skins.empty());
}

std::optional<Bones> find_bones_by_shape(const Character& character, const HumanoidOptions& options) {
  Bones bones;
  if (const Status status = apply_user_map(character, options, bones); !status) return std::nullopt;
  const int root = options.root.empty() ? -1 : character.skeleton.find(options.root);
  fill(bones, find_by_topology(character, rest_pose(character.skeleton), may_be_bones(character, root, false),
                               bones, LegEnds::required));
  return complete(bones) && misplaced(character, bones).empty() ? std::optional(bones) : std::nullopt;
}

}  // namespace ukemi
