// Clips for any VRM avatar: .vrma (VRMC_vrm_animation 1.0).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// A .glb of the humanoid bones alone, in the T-pose that the format asks for (facing +z, every bone along
/// the world's axes), with rotations of every bone and the translation of the hips at every frame. `frames`:
/// segments in a y-up world, metres; the first tells the lengths of the bones.
Result<std::vector<std::uint8_t>> write_vrma(const std::string& name, const std::vector<BodyPose>& frames,
                                             double fps);

}  // namespace ukemi
