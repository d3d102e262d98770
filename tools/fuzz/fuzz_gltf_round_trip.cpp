// glTF read, given a clip, written as .glb and .gltf and read again: the same nodes, one animation more.
#include "export/export.h"
#include "fuzz/checks.h"
#include "load/load.h"

namespace {

using namespace ukemi;

/// Every node's rest pose, and one node that turns.
ReducedClip turning_clip(const Skeleton& skeleton) {
  Clip clip{"turn", 30.0, {}, {}};
  for (int i = 0; i < 4; ++i) {
    Pose pose = rest_pose(skeleton);
    pose.back().rotation = pose.back().rotation * exp_rotation(Vec3(0.0, 0.1 * i, 0.0));
    clip.frames.push_back(std::move(pose));
  }
  return reduce_keys(skeleton, clip, Similarity{}, KeyReduction{});
}

void require_same(const Character& before, const std::vector<std::uint8_t>& bytes, bool clip_only) {
  Diagnostics diagnostics;
  const auto after = read_gltf(bytes, "elsewhere/output.glb", diagnostics);
  if (!after) std::fputs((after.error().message() + '\n').c_str(), stderr);
  fuzz::require(static_cast<bool>(after), "what was written can be read");
  fuzz::require_sound(*after);
  fuzz::require(after->skeleton.size() == before.skeleton.size(), "the nodes are the same");
  for (int i = 0; i < before.skeleton.size(); ++i) {
    fuzz::require(after->skeleton.nodes[i].name == before.skeleton.nodes[i].name, "the names are the same");
    fuzz::require(after->skeleton.nodes[i].parent == before.skeleton.nodes[i].parent, "the tree is the same");
  }
  fuzz::require(after->animations.size() == (clip_only ? 0 : before.animations.size()) + 1,
                "one animation is added");
  fuzz::require(clip_only || after->parts.size() == before.parts.size(), "the meshes are the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Diagnostics diagnostics;
  const auto character = read_gltf({data, size}, "folder/input.glb", diagnostics);
  if (!character) return 0;
  const ReducedClip clip = turning_clip(character->skeleton);
  if (clip.tracks.empty()) return 0;
  for (const bool clip_only : {false, true}) {
    const GltfOptions options{clip_only, R"({"note": 1})", {}};
    const auto glb = write_glb(*character, Humanoid{}, clip, options);
    if (glb)
      require_same(*character, *glb, clip_only);
    else
      fuzz::require_clear(glb.error());
    const auto gltf = write_gltf(*character, Humanoid{}, clip, options);
    if (gltf)
      require_same(*character, {gltf->begin(), gltf->end()}, clip_only);
    else
      fuzz::require_clear(gltf.error());
  }
  return 0;
}
