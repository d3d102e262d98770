// The bones of the limbs, pelvis and head: found by the user's map, VRM, names, then topology.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "base/segments.h"
#include "bones/options.h"

namespace ukemi {

/// One node per segment (the last of its chain), -1 where there is none, and how it was found. The user may
/// name abdomen and chest; otherwise they follow from the hierarchy.
struct Bones {
  PerSegment<int> node;
  PerSegment<std::string> by;

  Bones() { node.fill(-1); }
  int operator[](Segment s) const { return node[index(s)]; }
  void set(Segment s, int n, const std::string& how) {
    node[index(s)] = n;
    by[index(s)] = how;
  }
};

/// Which nodes may be bones: all, or where the file has skins those that a skin names (1) rather than others
/// (0).
std::vector<char> skin_joints(const Character& character);

/// Which nodes carry vertices: most of a skinned one's weight, or a mesh of their own.
std::vector<char> carries_skin(const Character& character);

/// Every source in turn. Errors: usage for a bad user map; input when the must-have bones (pelvis, head,
/// upper arms, forearms, thighs, shanks) are not there. A second figure in the file is a warning.
Result<Bones> find_bones(const Character& character, const HumanoidOptions& options,
                         Diagnostics& diagnostics);

/// The same from the user's map and, whatever the names say, by shape; nothing where a must-have bone is
/// missing.
std::optional<Bones> find_bones_by_shape(const Character& character, const HumanoidOptions& options);

/// The node of that label. Errors: usage, with what there is.
Result<int> node_of_label(const Character& character, const std::string& label);
/// The bones that the user names. Errors: usage (no such segment or node, a node named twice).
Status apply_user_map(const Character& character, const HumanoidOptions& options, Bones& bones);

/// Which relation between bones no body has ("head (A) hangs above pelvis (B)"); empty where all must-have
/// bones are there and fit.
std::string misplaced(const Character& character, const Bones& bones);

/// Whether legs that are found by shape end in a joint of their own, an ankle. Arms have to: without wrists
/// clavicles would be taken for upper arms.
enum class LegEnds { required, may_be_missing };

/// The bones by shape alone, of the `allowed` nodes: a trunk with two mirrored legs below and two mirrored
/// arms above; limbs that `given` starts are followed from there. Empty (all -1) when there is none.
Bones find_by_topology(const Character& character, const Pose& pose, const std::vector<char>& allowed,
                       const Bones& given, LegEnds ends);

/// Where neither foot is known: what stands apart under both legs and carries the feet's skin or meshes.
void add_feet_apart(const Character& character, Bones& bones);

/// Lowest common ancestor (a node is its own ancestor); -1 when there is none.
int common_ancestor(const Skeleton& skeleton, int a, int b);
inline bool is_at_or_below(const Skeleton& skeleton, int top, int node) {
  return node >= 0 && (top == node || skeleton.is_ancestor(top, node));
}
/// Nodes from `top` (exclusive) down to `node` (inclusive), top first; empty when `node` is not below `top`.
std::vector<int> path_below(const Skeleton& skeleton, int top, int node);

}  // namespace ukemi
