#include "bake/exported_clip.h"

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "clip/ground_motion.h"

namespace ukemi {

namespace {

using Json = nlohmann::ordered_json;

bool says_root(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name.find("root") != std::string::npos;
}

/// A joint above the hips that is called root; -1 where there is none.
int root_joint_of(const Skeleton& skeleton, int hips) {
  for (int i = skeleton.nodes[hips].parent; i >= 0; i = skeleton.nodes[i].parent)
    if (says_root(skeleton.nodes[i].name)) return i;
  return -1;
}

/// Puts `fresh` in the place of `old` in a list of children.
void replace_in(Json& list, int old, int fresh) {
  for (Json& entry : list)
    if (entry.is_number_integer() && entry.get<int>() == old) entry = fresh;
}

/// The character with a joint "root" at the ground between the hips and their parent.
Character with_root_joint(const Character& source, int hips) {
  Character character = source;
  Skeleton& skeleton = character.skeleton;
  const int fresh = skeleton.size();
  const int parent = skeleton.nodes[hips].parent;
  const std::string name = skeleton.find("root") < 0 ? "root" : "ukemi_root";
  skeleton.nodes.push_back({name, parent, {}});
  skeleton.nodes[hips].parent = fresh;
  const bool sorted = skeleton.sort();
  static_cast<void>(sorted);  // a chain of parents stays one
  Json json = Json::parse(character.document.json);
  json["nodes"].push_back({{"name", name}, {"children", {hips}}});
  if (parent >= 0)
    replace_in(json["nodes"][parent]["children"], hips, fresh);
  else if (json.contains("scenes"))
    for (Json& scene : json["scenes"])
      if (scene.contains("nodes")) replace_in(scene["nodes"], hips, fresh);
  character.document.json = json.dump();
  return character;
}

Status add_root_joint(const Character& character, ExportedClip& exported) try {
  const int hips = exported.humanoid.root;
  exported.root_joint = root_joint_of(character.skeleton, hips);
  if (exported.root_joint >= 0) return Done{};
  exported.with_root = with_root_joint(character, hips);
  exported.root_joint = character.skeleton.size();
  for (Pose& pose : exported.clip.frames) pose.emplace_back();
  if (!exported.humanoid.reference.empty()) exported.humanoid.reference.emplace_back();
  return Done{};
} catch (const std::exception& e) {
  return input_error(character.path, std::string("the glTF document cannot take a root joint: ") + e.what(),
                     "check the file with the Khronos glTF validator");
}

}  // namespace

Result<ExportedClip> exported_clip(const Character& character, const BakeSettings& settings,
                                   const BakeOutcome& outcome) {
  constexpr int pelvis = index(Segment::pelvis);
  ExportedClip exported{outcome.clip, {}, std::nullopt, outcome.humanoid, -1, {}};
  std::vector<Pose>& frames = exported.clip.frames;
  if (settings.align) {
    const Rigid& start = outcome.start.segments[pelvis];
    const GroundMove to_origin{-kPi / 2 - facing(start.rotation), level(start.translation), Vec3::Zero()};
    for (Pose& pose : frames) pose = to_origin.moved(character.skeleton, outcome.humanoid, pose);
  }
  if (settings.root_motion == RootMotion::hips || frames.empty()) return exported;
  for (const Pose& pose : frames)
    exported.root_curve.push_back(
        level(segments_of(character.skeleton, outcome.humanoid, pose)[pelvis].translation));
  const Vec3 first = exported.root_curve.front();
  for (Vec3& place : exported.root_curve) place -= first;
  if (settings.root_motion == RootMotion::root) {
    exported.on_hips = exported.clip;
    if (const Status status = add_root_joint(character, exported); !status) return status.error();
  }
  const Skeleton& skeleton = exported.with_root ? exported.with_root->skeleton : character.skeleton;
  std::vector<int> below = movers(skeleton, exported.humanoid);
  if (exported.root_joint >= 0)
    std::erase_if(below, [&](int node) { return !skeleton.is_ancestor(exported.root_joint, node); });
  for (std::size_t f = 0; f < frames.size(); ++f) {
    displace(skeleton, exported.humanoid, below, -exported.root_curve[f], frames[f]);
    if (exported.root_joint >= 0)
      displace(skeleton, exported.humanoid, {exported.root_joint}, exported.root_curve[f], frames[f]);
  }
  return exported;
}

}  // namespace ukemi
