#include "export/stick_mesh.h"

#include <algorithm>

namespace ukemi {
namespace {

constexpr double kWidest = 0.2;                         // of the bone's length, from its upper end
constexpr double kWidthShare = 0.13;                    // of the bone's length, from the axis to an edge
constexpr double kWidthMin = 0.012, kWidthMax = 0.035;  // of the body height
constexpr double kShortest = 0.005;                     // of the body height: shorter bones have no shape

void add_triangle(StickMesh& mesh, int node, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Eigen::Vector3f normal = (b - a).cross(c - a).normalized().cast<float>();
  for (const Vec3& point : {a, b, c}) {
    mesh.positions.push_back(point.cast<float>());
    mesh.normals.push_back(normal);
    mesh.nodes.push_back(node);
  }
}

void add_bone(StickMesh& mesh, int node, const Vec3& from, const Vec3& to, double height) {
  const Vec3 along = to - from;
  const double length = along.norm();
  if (!(length > kShortest * height)) return;
  const Vec3 side = along.unitOrthogonal();
  const Vec3 front = along.cross(side) / length;
  const double width =
      std::min(std::clamp(kWidthShare * length, kWidthMin * height, kWidthMax * height), 0.5 * length);
  const Vec3 middle = from + kWidest * along;
  const Vec3 ring[4] = {middle + width * side, middle + width * front, middle - width * side,
                        middle - width * front};
  for (int i = 0; i < 4; ++i) {
    add_triangle(mesh, node, from, ring[(i + 1) % 4], ring[i]);
    add_triangle(mesh, node, to, ring[i], ring[(i + 1) % 4]);
  }
}

}  // namespace

StickMesh make_stick_mesh(const Character& character, const Humanoid& humanoid) {
  const Skeleton& skeleton = character.skeleton;
  const bool has_reference = humanoid.reference.size() == skeleton.nodes.size();
  const auto bind = world_transforms(skeleton, has_reference ? humanoid.reference : rest_pose(skeleton));
  const auto below = skeleton.children();
  Eigen::AlignedBox3d box;
  const auto in_body = [&](int node) {
    return humanoid.root < 0 || node == humanoid.root || skeleton.is_ancestor(humanoid.root, node);
  };
  for (int node = 0; node < skeleton.size(); ++node)
    if (in_body(node)) box.extend(bind[node].translation().matrix());
  const double height = box.sizes().maxCoeff();
  StickMesh mesh;
  for (int node = 0; node < skeleton.size(); ++node) {
    const Vec3 from = bind[node].translation();
    mesh.inverse_bind.push_back(bind[node].inverse());
    if (!in_body(node)) continue;  // no bone reaches from the scene's origin to the hips
    for (const int child : below[node]) add_bone(mesh, node, from, bind[child].translation(), height);
    const int parent = skeleton.nodes[node].parent;
    const bool has_end = character.bvh && node < static_cast<int>(character.bvh->end_site.size()) &&
                         character.bvh->end_site[node].has_value();
    if (has_end)
      add_bone(mesh, node, from, bind[node] * *character.bvh->end_site[node], height);
    else if (below[node].empty() && parent >= 0)
      add_bone(mesh, node, from, from + 0.5 * (from - bind[parent].translation()), height);
  }
  return mesh;
}

}  // namespace ukemi
