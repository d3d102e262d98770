// Where the body starts: a natural pose, or a moment of a clip with its velocities.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"
#include "simulate/simulate.h"

namespace ukemi {

struct BakeSettings;

struct Start {
  std::string name;  // "stand", or the clip's name
  bool from_clip = false;
  double at_s = 0.0;   // of the clip
  Pose pose;           // the file's units, as the file places it
  BodyPose segments;   // of `pose`, canonical, world
  double floor_m = 0;  // height of the floor in the world
  StartState state;    // what the simulation is given: the same segments above a floor at y = 0
};

/// True where a file is motion alone: a BVH with frames, or no mesh, no skin and a single animation.
bool is_motion_only(const Character& character);

/// The clip's name, or "#INDEX" where it has none.
std::string clip_label(const Character& character, std::size_t clip);

/// Index of the clip of that name (the first of equals) or "#INDEX". Errors: usage, with the nearest name.
Result<std::size_t> find_clip(const Character& character, std::string_view name);

/// Height of the floor under some poses of a clip, metres: of the lowest point of the feet, in all but the
/// lowest twentieth of the poses.
double floor_of(const Character& character, const Humanoid& humanoid, const std::vector<Pose>& poses);

/// The start that the settings ask for. Errors: usage (--pose and --clip together, --at without a clip or
/// outside it, unknown pose or clip).
Result<Start> start_of(const Character& character, const Humanoid& humanoid, const BakeSettings& settings,
                       Diagnostics& diagnostics);

/// The pose with the whole figure moved by `offset` (world, metres).
Pose moved(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose, const Vec3& offset);

}  // namespace ukemi
