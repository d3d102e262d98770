// Reference pose, unit, up axis and anatomical frames (see Humanoid).
#pragma once

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Fills reference, rest_pose, up_axis, world_from_file, height_m and node_from_segment; exchanges the sides
/// where the feet point backwards. Errors: input, when the trunk does not rise from the legs in any pose of
/// the file.
Status find_frames(const Character& character, const HumanoidOptions& options, Humanoid& humanoid,
                   Diagnostics& diagnostics);

}  // namespace ukemi
