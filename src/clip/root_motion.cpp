#include "clip/root_motion.h"

#include <algorithm>
#include <string>
#include <utility>

#include "clip/ground_motion.h"
#include "export/lift_hips.h"
#include "export/root_joint.h"

namespace ukemi {
namespace {

bool says_root(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name.find("root") != std::string::npos;
}

bool is_skin_joint(const Character& character, int node) {
  return std::any_of(character.skins.begin(), character.skins.end(), [node](const Skin& skin) {
    return std::find(skin.joints.begin(), skin.joints.end(), node) != skin.joints.end();
  });
}

/// Something that holds meshes beside the bones: the file's scene, or a wrapper of it.
bool holds_meshes(const Character& character, int node) {
  return std::any_of(character.parts.begin(), character.parts.end(), [&](const MeshPart& part) {
    return part.skin >= 0 && character.skeleton.is_ancestor(node, part.node);
  });
}

/// The rig's own root bone: the first of the skin's joints in the hierarchy above the hips, or a bone above
/// them that is called root; -1 where there is none.
int root_joint_of(const Character& character, int hips) {
  const Skeleton& skeleton = character.skeleton;
  int root = -1;
  for (int i = skeleton.nodes[hips].parent; i >= 0; i = skeleton.nodes[i].parent)
    if (is_skin_joint(character, i) || (says_root(skeleton.nodes[i].name) && !holds_meshes(character, i)))
      root = i;
  return root;
}

Status add_root_joint(const Character& character, ExportedClip& exported) {
  const int hips = exported.humanoid.root;
  exported.root_joint = root_joint_of(character, hips);
  if (exported.root_joint >= 0) return Done{};
  auto with_root = with_root_joint(character, hips);
  if (!with_root) return with_root.error();
  exported.with_root = std::move(*with_root);
  exported.root_joint = character.skeleton.size();
  for (Pose& pose : exported.clip.frames) pose.emplace_back();
  if (!exported.humanoid.reference.empty()) exported.humanoid.reference.emplace_back();
  return Done{};
}

}  // namespace

std::string_view name(RootMotion motion) {
  switch (motion) {
    case RootMotion::root:
      return "root";
    case RootMotion::in_place:
      return "in-place";
    case RootMotion::hips:
      break;
  }
  return "hips";
}

Result<ExportedClip> exported_clip(const Character& character, const Humanoid& humanoid,
                                   const Rigid& start_pelvis, const Clip& clip,
                                   const GroundPlacement& placement) {
  constexpr int pelvis = index(Segment::pelvis);
  ExportedClip exported{clip, {}, std::nullopt, humanoid, -1, {}};
  std::vector<Pose>& frames = exported.clip.frames;
  if (placement.align) {
    const GroundMove to_origin{-kPi / 2 - facing(start_pelvis.rotation), level(start_pelvis.translation),
                               Vec3::Zero()};
    for (Pose& pose : frames) pose = to_origin.moved(character.skeleton, humanoid, pose);
  }
  if (placement.root_motion == RootMotion::hips || frames.empty()) {
    lift_hips(character, humanoid, frames);
    return exported;
  }
  for (const Pose& pose : frames)
    exported.root_curve.push_back(level(segments_of(character.skeleton, humanoid, pose)[pelvis].translation));
  const Vec3 first = exported.root_curve.front();
  for (Vec3& place : exported.root_curve) place -= first;
  if (placement.root_motion == RootMotion::root) {
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
  lift_hips(character, exported.humanoid,
            placement.root_motion == RootMotion::root ? exported.on_hips.frames : frames);
  return exported;
}

}  // namespace ukemi
