#include "base/skeleton.h"

#include <algorithm>
#include <charconv>

namespace ukemi {

Affine LocalTransform::affine() const {
  Affine result;
  result.linear() = rotation.toRotationMatrix() * scale.asDiagonal();
  result.translation() = translation;
  result.makeAffine();
  return result;
}

bool Skeleton::sort() {
  order.clear();
  order.reserve(nodes.size());
  const auto below = children();
  for (int i = 0; i < size(); ++i) {
    if (nodes[i].parent < -1 || nodes[i].parent >= size()) return false;
    if (nodes[i].parent == -1) order.push_back(i);
  }
  for (std::size_t next = 0; next < order.size(); ++next)
    order.insert(order.end(), below[order[next]].begin(), below[order[next]].end());
  return order.size() == nodes.size();
}

int Skeleton::find(std::string_view name) const {
  int found = -1;
  for (int i = 0; i < size(); ++i) {
    if (nodes[i].name != name) continue;
    if (found >= 0) return -1;
    found = i;
  }
  if (found >= 0 || name.size() < 2 || name.front() != '#') return found;
  int value = -1;
  const char* end = name.data() + name.size();
  const auto [parsed, error] = std::from_chars(name.data() + 1, end, value);
  return error == std::errc() && parsed == end && value >= 0 && value < size() ? value : -1;
}

std::string Skeleton::label(int node) const {
  const std::string& name = nodes[node].name;
  return !name.empty() && find(name) == node ? name : '#' + std::to_string(node);
}

std::vector<std::vector<int>> Skeleton::children() const {
  std::vector<std::vector<int>> result(nodes.size());
  for (int i = 0; i < size(); ++i)
    if (nodes[i].parent >= 0 && nodes[i].parent < size()) result[nodes[i].parent].push_back(i);
  return result;
}

bool Skeleton::is_ancestor(int ancestor, int node) const {
  for (int i = nodes[node].parent; i >= 0; i = nodes[i].parent)
    if (i == ancestor) return true;
  return false;
}

std::string plain_name(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) <= ' ' || c == '{' || c == '}') c = '_';
  return name;
}

std::map<std::string, int> nodes_by_plain_name(const Skeleton& skeleton, const std::vector<char>& counts) {
  std::map<std::string, int> nodes;
  for (int i = 0; i < skeleton.size(); ++i) {
    if (skeleton.nodes[i].name.empty() || (!counts.empty() && !counts[static_cast<std::size_t>(i)])) continue;
    const auto [at, is_new] = nodes.emplace(plain_name(skeleton.nodes[i].name), i);
    if (!is_new) at->second = -1;
  }
  return nodes;
}

Pose rest_pose(const Skeleton& skeleton) {
  Pose pose;
  pose.reserve(skeleton.nodes.size());
  for (const Node& node : skeleton.nodes) pose.push_back(node.rest);
  return pose;
}

std::vector<Affine> world_transforms(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Affine> world(skeleton.nodes.size());
  for (const int i : skeleton.order) {
    const int parent = skeleton.nodes[i].parent;
    world[i] = parent < 0 ? pose[i].affine() : world[parent] * pose[i].affine();
  }
  return world;
}

}  // namespace ukemi
