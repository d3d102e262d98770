#include "export/puppet.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace ukemi::test {
namespace {

int add(Skeleton& skeleton, std::string name, int parent, const Vec3& at_cm) {
  skeleton.nodes.push_back({std::move(name), parent, {at_cm, Quat::Identity(), Vec3::Ones()}});
  return skeleton.size() - 1;
}

void set(Humanoid& humanoid, Segment segment, std::vector<int> chain) {
  humanoid.segments[index(segment)].chain = std::move(chain);
}

/// `side` +1 left (x positive), -1 right.
void add_arm(Puppet& puppet, int chest, int side) {
  Skeleton& s = puppet.character.skeleton;
  const std::string lr = side > 0 ? "Left" : "Right";
  const int clavicle = add(s, lr + "Shoulder", chest, {side * 6.0, 12, 0});
  const int upper = add(s, lr + "Arm", clavicle, {side * 12.0, 0, 0});
  const int fore = add(s, lr + "ForeArm", upper, {side * 28.0, 0, 0});
  const int hand = add(s, lr + "Hand", fore, {side * 26.0, 0, 0});
  for (int finger = 0; finger < 5; ++finger) {
    int parent = hand;
    for (int k = 1; k <= 4; ++k)
      parent = add(s, lr + "Finger" + std::to_string(finger) + std::to_string(k), parent,
                   k == 1 ? Vec3(side * 9.0, 0, 4.0 - 2.0 * finger) : Vec3(side * 3.0, 0, 0));
    if (finger == 2) puppet.humanoid.middle_finger[side > 0 ? 0 : 1] = parent - 3;
  }
  const int shift = side > 0 ? 0 : index(Segment::clavicle_r) - index(Segment::clavicle_l);
  set(puppet.humanoid, segment_at(index(Segment::clavicle_l) + shift), {clavicle});
  set(puppet.humanoid, segment_at(index(Segment::upperarm_l) + shift), {upper});
  set(puppet.humanoid, segment_at(index(Segment::forearm_l) + shift), {fore});
  set(puppet.humanoid, segment_at(index(Segment::hand_l) + shift), {hand});
}

void add_leg(Puppet& puppet, int hips, int side) {
  Skeleton& s = puppet.character.skeleton;
  const std::string lr = side > 0 ? "Left" : "Right";
  const int thigh = add(s, lr + "UpLeg", hips, {side * 9.0, -5, 0});
  const int shank = add(s, lr + "Leg", thigh, {0, -42, 0});
  const int foot = add(s, lr + "Foot", shank, {0, -42, -2});
  const int toe = add(s, lr + "ToeBase", foot, {0, -6, 12});
  add(s, lr + "ToeEnd", toe, {0, 0, 8});
  puppet.humanoid.toes[side > 0 ? 0 : 1] = toe;
  const int shift = side > 0 ? 0 : index(Segment::thigh_r) - index(Segment::thigh_l);
  set(puppet.humanoid, segment_at(index(Segment::thigh_l) + shift), {thigh});
  set(puppet.humanoid, segment_at(index(Segment::shank_l) + shift), {shank});
  set(puppet.humanoid, segment_at(index(Segment::foot_l) + shift), {foot});
}

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// A bend towards a new pose, and swings that start at the blow and again at the fall.
Vec3 turn_at(int node, double t) {
  const double phase = 1.7 * node;
  const Vec3 axis = Vec3(std::sin(phase), std::cos(2.3 * phase), std::sin(0.7 * phase + 1)).normalized();
  const double hz = 0.8 + 0.2 * (node % 5);
  const auto swing = [&](double since, double size) {
    return since < 0 ? 0.0 : size * std::exp(-3.5 * since) * std::sin(2 * kPi * hz * since);
  };
  const double size = 0.3 + 0.1 * (node % 4);
  return axis * (size * smooth_step(t / 1.1) + swing(t, 0.4 * size) + swing(t - 0.7, 0.6 * size));
}

}  // namespace

std::string plain_document(const Skeleton& skeleton) {
  using Json = nlohmann::ordered_json;
  Json nodes = Json::array();
  Json roots = Json::array();
  for (int i = 0; i < skeleton.size(); ++i) {
    const LocalTransform& r = skeleton.nodes[i].rest;
    const Eigen::Vector4d q = r.rotation.coeffs();
    nodes.push_back({{"name", skeleton.nodes[i].name},
                     {"translation", {r.translation.x(), r.translation.y(), r.translation.z()}},
                     {"rotation", {q[0], q[1], q[2], q[3]}},
                     {"scale", {r.scale.x(), r.scale.y(), r.scale.z()}}});
    if (skeleton.nodes[i].parent < 0) roots.push_back(i);
  }
  const auto below = skeleton.children();
  for (std::size_t i = 0; i < below.size(); ++i)
    if (!below[i].empty()) nodes[i]["children"] = below[i];
  Json document;
  document["asset"] = {{"version", "2.0"}};
  document["scene"] = 0;
  document["scenes"] = Json::array({{{"nodes", roots}}});
  document["nodes"] = nodes;
  return document.dump();
}

Puppet make_puppet() {
  Puppet puppet;
  Skeleton& s = puppet.character.skeleton;
  const int armature = add(s, "Armature", -1, {0, 0, 0});
  s.nodes[armature].rest.rotation = exp_rotation(Vec3(-kPi / 2, 0, 0));
  s.nodes[armature].rest.scale = Vec3::Constant(0.01);
  const int hips = add(s, "Hips", armature, {0, 0, 96});
  s.nodes[hips].rest.rotation = exp_rotation(Vec3(kPi / 2, 0, 0));
  const int spine = add(s, "Spine", hips, {0, 10, 0});
  const int spine1 = add(s, "Spine1", spine, {0, 12, 0});
  const int spine2 = add(s, "Spine2", spine1, {0, 12, 0});
  const int neck = add(s, "Neck", spine2, {0, 18, 0});
  const int head = add(s, "Head", neck, {0, 9, 0});
  puppet.humanoid.head_top = add(s, "HeadTop", head, {0, 18, 0});
  puppet.humanoid.root = hips;
  puppet.humanoid.node_from_segment.fill(Quat::Identity());
  set(puppet.humanoid, Segment::pelvis, {hips});
  set(puppet.humanoid, Segment::abdomen, {spine, spine1});
  set(puppet.humanoid, Segment::chest, {spine2});
  set(puppet.humanoid, Segment::head, {neck, head});
  for (const int side : {1, -1}) add_arm(puppet, spine2, side);
  for (const int side : {1, -1}) add_leg(puppet, hips, side);
  if (!s.sort()) std::abort();
  puppet.humanoid.reference = rest_pose(s);
  puppet.character.name = "puppet";
  puppet.character.path = "puppet.glb";
  puppet.character.document.json = plain_document(s);
  puppet.character.document.is_glb = true;
  return puppet;
}

Clip falling_clip(const Skeleton& skeleton, int frames, double fps) {
  Clip clip{"fall", fps, {}, {{"impact", 0.0}}};
  for (int f = 0; f < frames; ++f) {
    const double t = f / fps;
    Pose pose = rest_pose(skeleton);
    for (int i = 0; i < skeleton.size(); ++i) {
      if (i == 0 || skeleton.nodes[i].name.find("Finger") != std::string::npos) continue;
      pose[i].rotation = pose[i].rotation * exp_rotation(turn_at(i, t));
    }
    const double fall = std::min(t, 0.42);
    const double bounce =
        t < 0.42 ? 0.0 : 4.0 * std::exp(-4 * (t - 0.42)) * std::abs(std::sin(6 * (t - 0.42)));
    pose[1].translation +=
        Vec3(20 * smooth_step(t), 60 * smooth_step(t / 0.8), -490.5 * fall * fall + bounce);
    clip.frames.push_back(std::move(pose));
  }
  return clip;
}

double largest_distance_m(const Skeleton& skeleton, const Clip& clip, const std::vector<Track>& tracks,
                          const Similarity& world_from_file) {
  const Animation animation{"", 0, clip.duration_s(), 0, tracks};
  double largest = 0.0;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    const auto wanted = world_transforms(skeleton, clip.frames[f]);
    const auto played =
        world_transforms(skeleton, sample(skeleton, animation, static_cast<double>(f) / clip.fps));
    for (std::size_t i = 0; i < wanted.size(); ++i)
      largest = std::max(largest,
                         world_from_file.scale * (wanted[i].translation() - played[i].translation()).norm());
  }
  return largest;
}

}  // namespace ukemi::test
