// The character's own hierarchy of nodes and poses of it, in the file's units and axes.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace ukemi {

/// Local transform: parent_from_node = translation * rotation * scale, as in glTF.
struct LocalTransform {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();

  Affine affine() const;
};

struct Node {
  std::string name;  // may be empty or shared with other nodes
  int parent = -1;   // -1: a root
  LocalTransform rest;
};

/// Contract:
/// 1. nodes[i].parent is -1 or another node; there are no cycles.
/// 2. `order` lists every node once, parents before children.
/// 3. node i is node i of the character's glTF document where it has one.
struct Skeleton {
  std::vector<Node> nodes;
  std::vector<int> order;

  int size() const { return static_cast<int>(nodes.size()); }
  /// Fills `order`; false when the parents have a cycle or point outside.
  [[nodiscard]] bool sort();
  /// The only node of that name, or of the form "#INDEX"; -1 when there is none or more than one.
  int find(std::string_view name) const;
  /// A name that finds the node again: its name where unique, else "#INDEX".
  std::string label(int node) const;
  std::vector<std::vector<int>> children() const;
  bool is_ancestor(int ancestor, int node) const;
};

/// A name as a BVH can hold it: blanks, braces and control characters are '_' (as three.js reads glTF names).
std::string plain_name(std::string name);
/// Node of each plain name, -1 where several share it. Only nodes whose `counts` is true (empty: all).
std::map<std::string, int> nodes_by_plain_name(const Skeleton& skeleton,
                                               const std::vector<char>& counts = {});

/// One local transform per node.
using Pose = std::vector<LocalTransform>;

Pose rest_pose(const Skeleton& skeleton);
/// world_from_node of every node, file units.
std::vector<Affine> world_transforms(const Skeleton& skeleton, const Pose& pose);

}  // namespace ukemi
