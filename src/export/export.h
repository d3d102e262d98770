// Clips out: glTF (the character's own document plus one animation) and BVH.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Fewer keys within a bound at world positions.
struct KeyReduction {
  bool enabled = true;
  double tolerance_m = 0.0005;  // largest world-position error of any joint
  /// Rotations rounded to what normalised 16-bit integers hold; keys are kept until the whole error is within
  /// the tolerance, or all are.
  bool short_rotations = false;
  std::vector<int> joints{};  // have keys at both ends where they rest
};

/// The clip as tracks: only quantities that move, linear interpolation, the shorter arc between rotations;
/// the first frame, the last and that of the mark "impact" as they are; what rests, but not in the rest pose,
/// has a single key. `error_m` is the largest distance of any node from the unreduced clip, metres, at every
/// frame; a node without children stands for a point as far out as its bone is long (1 to 20 cm), so that
/// hands and heads keep their turn.
struct ReducedClip {
  std::string name;
  std::vector<Track> tracks;
  std::size_t keys = 0;
  double error_m = 0.0;
  std::vector<Mark> marks;
  bool short_rotations = false;
};
/// Nodes whose rotations must be as in the whole clip at a frame, told from the reduced pose there; asked
/// again until there are none.
using ExactRotations = std::function<std::vector<int>(std::size_t frame, const Pose& reduced)>;
ReducedClip reduce_keys(const Skeleton& skeleton, const Clip& clip, const Similarity& world_from_file,
                        const KeyReduction& settings, const ExactRotations& exact = {});

struct GltfOptions {
  bool clip_only = false;   // nodes, skins and animation without meshes, materials, images, extensions
  std::string extras_json;  // written as the animation's "extras" when not empty
  /// Where the file will lie. Links of a .gltf to files beside it are kept when this is the source's folder;
  /// otherwise (and when not given) what they link to is embedded.
  std::optional<std::filesystem::path> folder{};
};

/// The character's document plus one animation, as the bytes of a .glb or the text of a .gltf. Everything
/// that is not added stays as it is, in its order, with two exceptions: a node that is animated and has a
/// `matrix` gets translation, rotation and scale instead (glTF demands it), and a change of container moves
/// buffers and images into the binary chunk or out of it. The name of the animation is made unique. In a .glb
/// the source's binary chunk is a prefix of the new one; a .gltf gets a further buffer. Documents that the
/// loader wrote (BVH, FBX, DAE) get a root node of the file's name with `world_from_file`, their
/// skinned meshes at the scene's root, and a simple figure where they have no mesh. Errors: input (document
/// cannot take an animation, an image is missing), internal.
Result<std::vector<std::uint8_t>> write_glb(const Character& character, const Humanoid& humanoid,
                                            const ReducedClip& clip, const GltfOptions& options);
Result<std::string> write_gltf(const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
                               const GltfOptions& options);

struct BvhOptions {
  double metres_per_unit = 0.01;  // unit of a BVH that does not come from a BVH: centimetres
  std::string extras_json{};      // extras of the clip, see animation_extras; empty: none
};

/// The node of each joint that write_bvh writes, in the order of the file.
std::vector<int> bvh_nodes(const Character& character, const Humanoid& humanoid);

/// Same hierarchy, names, offsets, channel order and unit as a BVH source (joints with fewer than three
/// rotation channels get the nearest rotation those can make; what joints without position channels would
/// move goes onto the joint above that has them). For others the joints of the humanoid's chains and their
/// ancestors up to the root: offsets as in the reference pose, all rotations zero there and axes along the
/// world's, root OFFSET 0, positions on the root only, rotations Z Y X: with y in the middle a body that lies
/// on its back, belly or side, bent hips and bent knees stay clear of the gimbal. The name of the first End
/// Site says unit, up axis and, in base64, `extras_json` ("unit=0.01m,up=y,clip=eyJ1..."): the format has no
/// word for them, and readers skip it there. Euler angles without jumps, full precision. A joint that the
/// hierarchy holds more than 0.5 mm away from its place is a warning. Errors: input (a clip without frames or
/// of another skeleton).
Result<std::string> write_bvh(const Character& character, const Humanoid& humanoid, const Clip& clip,
                              const BvhOptions& options, Diagnostics& diagnostics);

}  // namespace ukemi
