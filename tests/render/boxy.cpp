#include "render/boxy.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

struct Bone {
  const char* name;
  int parent;
  Vec3 joint;      // world, rest
  Vec3 low, high;  // box, world, rest
};

const std::vector<Bone>& bones() {
  static const std::vector<Bone> list{
      {"hips", -1, {0, 0.95, 0}, {-0.16, 0.88, -0.10}, {0.16, 1.06, 0.10}},
      {"chest", 0, {0, 1.10, 0}, {-0.19, 1.08, -0.11}, {0.19, 1.46, 0.11}},
      {"head", 1, {0, 1.50, 0}, {-0.09, 1.50, -0.10}, {0.09, 1.75, 0.11}},
      {"upperarm_l", 1, {0.22, 1.40, 0}, {0.20, 1.14, -0.05}, {0.29, 1.45, 0.05}},
      {"forearm_l", 3, {0.245, 1.12, 0}, {0.20, 0.78, -0.04}, {0.285, 1.13, 0.04}},
      {"upperarm_r", 1, {-0.22, 1.40, 0}, {-0.29, 1.14, -0.05}, {-0.20, 1.45, 0.05}},
      {"forearm_r", 5, {-0.245, 1.12, 0}, {-0.285, 0.78, -0.04}, {-0.20, 1.13, 0.04}},
      {"thigh_l", 0, {0.09, 0.90, 0}, {0.02, 0.48, -0.08}, {0.16, 0.90, 0.08}},
      {"shank_l", 7, {0.09, 0.47, 0}, {0.03, 0.07, -0.06}, {0.15, 0.47, 0.06}},
      {"foot_l", 8, {0.09, 0.08, 0}, {0.03, 0.0, -0.06}, {0.15, 0.07, 0.20}},
      {"thigh_r", 0, {-0.09, 0.90, 0}, {-0.16, 0.48, -0.08}, {-0.02, 0.90, 0.08}},
      {"shank_r", 10, {-0.09, 0.47, 0}, {-0.15, 0.07, -0.06}, {-0.03, 0.47, 0.06}},
      {"foot_r", 11, {-0.09, 0.08, 0}, {-0.15, 0.0, -0.06}, {-0.03, 0.07, 0.20}},
  };
  return list;
}

/// Four sides and two ends; the end near the joint is shared with the parent.
void add_box(MeshPart& part, int bone) {
  const Bone& b = bones()[bone];
  const int parent = std::max(0, b.parent);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      const auto first = static_cast<std::uint32_t>(part.positions.size());
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (int corner = 0; corner < 4; ++corner) {
        Vec3 p;
        p[axis] = side ? b.high[axis] : b.low[axis];
        p[u] = corner == 1 || corner == 2 ? b.high[u] : b.low[u];
        p[v] = corner >= 2 ? b.high[v] : b.low[v];
        Vec3 normal = Vec3::Zero();
        normal[axis] = side ? 1.0 : -1.0;
        const bool near_joint = std::abs(p.y() - b.joint.y()) < 0.06;
        part.positions.push_back(p.cast<float>());
        part.normals.push_back(normal.cast<float>());
        part.joints.push_back({static_cast<std::uint16_t>(bone), static_cast<std::uint16_t>(parent), 0, 0});
        part.weights.push_back(near_joint ? std::array<float, 4>{0.75f, 0.25f, 0, 0}
                                          : std::array<float, 4>{1, 0, 0, 0});
      }
      if (side)
        part.indices.insert(part.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
      else
        part.indices.insert(part.indices.end(), {first, first + 2, first + 1, first, first + 3, first + 2});
    }
}

Quat about(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis)); }

double ease(double from, double to, double time) {
  const double u = std::clamp((time - from) / (to - from), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

}  // namespace

Character boxy_character() {
  Character character;
  character.name = "boxy";
  character.path = "boxy.glb";
  MeshPart part;
  part.skin = 0;
  part.material = 0;
  part.node = 0;
  Skin skin;
  for (std::size_t i = 0; i < bones().size(); ++i) {
    const Bone& bone = bones()[i];
    Node node{bone.name, bone.parent, {}};
    node.rest.translation = bone.parent < 0 ? bone.joint : Vec3(bone.joint - bones()[bone.parent].joint);
    character.skeleton.nodes.push_back(node);
    skin.joints.push_back(static_cast<int>(i));
    skin.inverse_bind.push_back(Affine(Eigen::Translation3d(-bone.joint)));
    add_box(part, static_cast<int>(i));
  }
  if (!character.skeleton.sort()) return {};
  Material material;
  material.name = "blue";
  material.base_color = {0.10f, 0.24f, 0.42f, 1.0f};
  character.materials.push_back(material);
  character.skins.push_back(skin);
  character.parts.push_back(part);
  return character;
}

Clip boxy_fall(const Character& character, int frames) {
  Clip clip{"fall", 30.0, {}, {}};
  for (int frame = 0; frame < frames; ++frame) {
    const double time = frame / clip.fps;
    const double fall = ease(0.2, 1.1, time);
    const double snap = ease(0.2, 0.4, time) - ease(0.4, 1.2, time);
    Pose pose = rest_pose(character.skeleton);
    pose[0].rotation = about(Vec3::UnitX(), -radians(86.0) * fall);
    pose[0].translation = {0.0, 0.95 - 0.82 * fall, -0.75 * fall};
    pose[1].rotation = about(Vec3::UnitX(), radians(25.0) * snap);
    pose[2].rotation = about(Vec3::UnitX(), radians(35.0) * snap);
    pose[3].rotation =
        about(Vec3::UnitZ(), radians(20.0 + 40.0 * fall)) * about(Vec3::UnitX(), -radians(60.0) * snap);
    pose[5].rotation =
        about(Vec3::UnitZ(), -radians(20.0 + 40.0 * fall)) * about(Vec3::UnitX(), -radians(70.0) * snap);
    pose[7].rotation = about(Vec3::UnitX(), -radians(30.0) * fall * (1.0 - 0.5 * fall));
    pose[8].rotation = about(Vec3::UnitX(), radians(45.0) * fall);
    clip.frames.push_back(pose);
  }
  clip.marks = {{"start", 0.0}, {"impact", 0.2}, {"first_ground_contact", 0.8}, {"rest", 1.2}};
  return clip;
}

std::vector<Prop> boxy_ball(const Clip& clip) {
  Prop ball;
  ball.radius = 0.14;
  for (std::size_t frame = 0; frame < clip.frames.size(); ++frame) {
    const double since = static_cast<double>(frame) / clip.fps - 0.2;
    Rigid pose;
    pose.translation = since < 0.0
                           ? Vec3(0.0, 1.30, 0.11 + ball.radius - 6.0 * since)
                           : Vec3(0.0, std::max(ball.radius, 1.30 - 4.9 * since * since), 0.25 + 0.7 * since);
    pose.rotation = about(Vec3::UnitX(), 3.0 * since);
    ball.poses.push_back(pose);
  }
  return {ball};
}

BoxyScene::BoxyScene() {
  shot.character = &character;
  shot.clip = &clip;
  shot.props = &props;
  shot.impact_point = {0.0, 1.30, 0.11};
  shot.impact_direction = {0.0, 0.0, -1.0};
  shot.title = "boxy, hit on the chest from the front";
  shot.facts = {{"blow", "medicine ball, 5 kg at 6 m/s"}};
}

int differing_pixels(const Picture& a, const Picture& b, int tolerance) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      most = std::max(most, std::abs(a.rgba[i + channel] - b.rgba[i + channel]));
    count += most > tolerance;
  }
  return count;
}

}  // namespace ukemi
