// https://github.com/vrm-c/vrm-specification, VRMC_vrm_animation-1.0: nodes in rest are a T-pose; a reader
// takes each bone's rotation out of the node's own rest rotation and scales the hips' way by their height.
#include "export/vrma.h"

#include <iterator>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "export/container.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

struct HumanBone {
  Segment segment;
  const char* name;
};

constexpr HumanBone kBones[] = {{Segment::pelvis, "hips"},
                                {Segment::abdomen, "spine"},
                                {Segment::chest, "chest"},
                                {Segment::head, "head"},
                                {Segment::clavicle_l, "leftShoulder"},
                                {Segment::upperarm_l, "leftUpperArm"},
                                {Segment::forearm_l, "leftLowerArm"},
                                {Segment::hand_l, "leftHand"},
                                {Segment::clavicle_r, "rightShoulder"},
                                {Segment::upperarm_r, "rightUpperArm"},
                                {Segment::forearm_r, "rightLowerArm"},
                                {Segment::hand_r, "rightHand"},
                                {Segment::thigh_l, "leftUpperLeg"},
                                {Segment::shank_l, "leftLowerLeg"},
                                {Segment::foot_l, "leftFoot"},
                                {Segment::thigh_r, "rightUpperLeg"},
                                {Segment::shank_r, "rightLowerLeg"},
                                {Segment::foot_r, "rightFoot"}};

/// VRM axes (facing +z, left hand to +x) from anatomical axes (x anterior, y up, z right).
Quat vrm_from_anatomical() {
  Mat3 axes;
  axes.col(0) = Vec3::UnitZ();
  axes.col(1) = Vec3::UnitY();
  axes.col(2) = -Vec3::UnitX();
  return Quat(axes);
}

bool is_arm(Segment s, bool left) {
  return left ? s == Segment::upperarm_l || s == Segment::forearm_l || s == Segment::hand_l
              : s == Segment::upperarm_r || s == Segment::forearm_r || s == Segment::hand_r;
}

/// Rotation of a segment in the T-pose against the neutral one: hanging arms, palms to the thighs, become
/// level ones, palms down, by a quarter turn about the anterior axis.
Quat t_pose(Segment s) {
  if (is_arm(s, true)) return exp_rotation(Vec3(kPi / 2, 0, 0));
  if (is_arm(s, false)) return exp_rotation(Vec3(-kPi / 2, 0, 0));
  return Quat::Identity();
}

int bone_of(Segment s) {
  for (int i = 0; i < static_cast<int>(std::size(kBones)); ++i)
    if (kBones[i].segment == s) return i;
  return -1;
}

/// Place of a bone's node in the T-pose below its parent's.
Vec3 offset_of(const BodyPose& pose, Segment s) {
  const Rigid& own = pose[index(s)];
  if (s == Segment::pelvis) return {0.0, own.translation.y(), 0.0};
  const Segment parent = parent_of(s);
  const Rigid& above = pose[index(parent)];
  const Vec3 in_parent = above.rotation.conjugate() * (own.translation - above.translation);
  return vrm_from_anatomical() * (t_pose(parent) * in_parent);
}

/// Rotation of the avatar's bone: none in the T-pose.
Quat bone_rotation(const BodyPose& pose, Segment s) {
  return pose[index(s)].rotation * t_pose(s).conjugate() * vrm_from_anatomical().conjugate();
}

Json nodes_json(const BodyPose& pose) {
  Json nodes = Json::array();
  for (const HumanBone& bone : kBones) {
    const Vec3 at = offset_of(pose, bone.segment);
    nodes.push_back({{"name", bone.name}, {"translation", {at.x(), at.y(), at.z()}}});
  }
  for (int i = 1; i < static_cast<int>(std::size(kBones)); ++i)
    nodes[bone_of(parent_of(kBones[i].segment))]["children"].push_back(i);
  return nodes;
}

/// Floats behind each other, an accessor for each list.
class Floats {
 public:
  std::size_t add(Json& json, const std::vector<float>& values, const char* type, std::size_t width) {
    const std::size_t bytes = values.size() * sizeof(float);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", values.size() / width},
                                 {"type", type}});
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes_.insert(bytes_.end(), first, first + bytes);
    return json["accessors"].size() - 1;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::vector<float> rotations_of(const std::vector<BodyPose>& frames, Segment s) {
  std::vector<float> values;
  Quat previous = Quat::Identity();
  for (const BodyPose& pose : frames) {
    const Quat above =
        s == Segment::pelvis ? Quat::Identity() : bone_rotation(pose, parent_of(s)).conjugate();
    previous = nearest_sign((above * bone_rotation(pose, s)).normalized(), previous);
    for (const double part : previous.coeffs()) values.push_back(static_cast<float>(part));
  }
  return values;
}

void add_animation(const std::string& name, const std::vector<BodyPose>& frames, double fps, Json& json,
                   Floats& floats) {
  std::vector<float> times, hips;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    times.push_back(static_cast<float>(static_cast<double>(f) / fps));
    for (const double part : frames[f][index(Segment::pelvis)].translation)
      hips.push_back(static_cast<float>(part));
  }
  const std::size_t input = floats.add(json, times, "SCALAR", 1);
  json["accessors"][input]["min"] = Json::array({times.front()});
  json["accessors"][input]["max"] = Json::array({times.back()});
  Json animation{{"name", name}, {"channels", Json::array()}, {"samplers", Json::array()}};
  const auto add = [&](int node, const char* path, std::size_t output) {
    animation["samplers"].push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  };
  add(0, "translation", floats.add(json, hips, "VEC3", 3));
  for (int i = 0; i < static_cast<int>(std::size(kBones)); ++i)
    add(i, "rotation", floats.add(json, rotations_of(frames, kBones[i].segment), "VEC4", 4));
  json["animations"] = Json::array();
  json["animations"].push_back(std::move(animation));
}

}  // namespace

Result<std::vector<std::uint8_t>> write_vrma(const std::string& name, const std::vector<BodyPose>& frames,
                                             double fps) {
  Json json{{"asset", {{"version", "2.0"}, {"generator", generator()}}},
            {"extensionsUsed", {"VRMC_vrm_animation"}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}}};
  Json bones = Json::object();
  for (int i = 0; i < static_cast<int>(std::size(kBones)); ++i) bones[kBones[i].name] = {{"node", i}};
  json["extensions"]["VRMC_vrm_animation"] = {{"specVersion", "1.0"}, {"humanoid", {{"humanBones", bones}}}};
  json["nodes"] = nodes_json(frames.front());
  json["accessors"] = Json::array();
  json["bufferViews"] = Json::array();
  Floats floats;
  add_animation(name, frames, fps, json, floats);
  json["buffers"] = {{{"byteLength", floats.bytes().size()}}};
  return assemble_glb(json.dump(-1, ' ', false, Json::error_handler_t::replace), floats.bytes(), {});
}

}  // namespace ukemi
