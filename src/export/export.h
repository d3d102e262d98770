// Clips out: glTF (the character's own document plus one animation) and BVH.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Key times and values of one animated quantity, ready to be written.
struct KeyReduction {
  bool enabled = true;
  double tolerance_m = 0.0005;  // largest world-position error of any joint
};

/// The clip as tracks: only quantities that move, linear interpolation. `error_m` is the largest distance of any
/// node from the unreduced clip, metres, at every frame.
struct ReducedClip {
  std::string name;
  std::vector<Track> tracks;
  std::size_t keys = 0;
  double error_m = 0.0;
  std::vector<Mark> marks;
};
ReducedClip reduce_keys(const Skeleton& skeleton, const Clip& clip, const Similarity& world_from_file,
                        const KeyReduction& settings);

struct GltfOptions {
  bool clip_only = false;  // skeleton and animation without the mesh
  std::string extras_json;  // written as the animation's "extras" when not empty
};

/// The character's document plus one animation, as the bytes of a .glb or of a .gltf with embedded buffers.
/// Documents that the loader wrote (BVH, FBX, DAE) get a root node with `world_from_file`, and a simple figure
/// where they have no mesh. Errors: input (document cannot take an animation), internal.
Result<std::vector<std::uint8_t>> write_glb(const Character& character, const Humanoid& humanoid,
                                            const ReducedClip& clip, const GltfOptions& options);
Result<std::string> write_gltf(const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
                               const GltfOptions& options);

struct BvhOptions {
  double metres_per_unit = 0.01;  // unit of a BVH that does not come from a BVH: centimetres
};

/// Same hierarchy, names, offsets, channel order and unit as a BVH source; for others the joints of the humanoid's
/// chains and their ancestors below and including the root. Root OFFSET 0 unless the source has another, positions
/// on the root only, Euler angles without jumps, full precision.
Result<std::string> write_bvh(const Character& character, const Humanoid& humanoid, const Clip& clip,
                              const BvhOptions& options);

}  // namespace ukemi
