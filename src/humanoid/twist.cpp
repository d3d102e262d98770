#include "humanoid/twist.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "humanoid/assemble.h"

namespace ukemi {
namespace {

bool is_named_twist(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const bool control = name.find("control") != std::string::npos || name.find("ctrl") != std::string::npos;
  return !control && (name.find("twist") != std::string::npos || name.find("roll") != std::string::npos ||
                      name.find("捩") != std::string::npos);  // MikuMikuDance
}

bool is_limb(Segment s) {
  switch (s) {
    case Segment::upperarm_l:
    case Segment::upperarm_r:
    case Segment::forearm_l:
    case Segment::forearm_r:
    case Segment::thigh_l:
    case Segment::thigh_r:
    case Segment::shank_l:
    case Segment::shank_r:
      return true;
    default:
      return false;
  }
}

}  // namespace

Segment limb_end(Segment limb) { return segment_at(index(limb) + 1); }

std::vector<TwistBone> find_twist_bones(const Skeleton& skeleton, const Humanoid& humanoid) {
  const std::vector<Affine> world = world_transforms(skeleton, humanoid.reference);
  const PerSegment<Vec3> origins = origins_of(humanoid, world);
  std::vector<int> carried(skeleton.nodes.size(), -1);  // segment whose twist a node could take
  std::vector<bool> mapped(skeleton.nodes.size(), false);
  for (int s = 0; s < kSegmentCount; ++s) {
    for (const int node : humanoid.segments[s].chain) mapped[node] = true;
    if (is_limb(segment_at(s)) && !humanoid.segments[s].fused()) carried[humanoid.segments[s].node()] = s;
  }
  std::vector<TwistBone> found;
  for (const int node : skeleton.order) {
    const int parent = skeleton.nodes[node].parent;
    if (parent < 0 || mapped[node] || carried[parent] < 0 || !is_named_twist(skeleton.nodes[node].name))
      continue;
    const int s = carried[node] = carried[parent];
    const Vec3 limb = origins[index(limb_end(segment_at(s)))] - origins[s];
    const double share = limb.dot(world[node].translation() - origins[s]) / limb.squaredNorm();
    if (std::isfinite(share)) found.push_back({node, segment_at(s), std::clamp(share, 0.0, 1.0)});
  }
  return found;
}

Quat with_less_twist(const Quat& turn, const Vec3& axis, double lost) {
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;
  const double twist = 2.0 * std::atan2(sign * turn.vec().dot(axis), sign * turn.w());
  return turn * exp_rotation(-lost * twist * axis);
}

}  // namespace ukemi
