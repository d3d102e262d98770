// Where the body starts: a natural pose, or a moment of a clip with its velocities.
#pragma once

#include "base/character.h"
#include "base/result.h"
#include "clip/start.h"
#include "humanoid/humanoid.h"

namespace ukemi {

struct BakeSettings;

/// The start that the settings ask for. Pose and clip may be of another file: see motion.h. Errors: usage
/// (--pose and --clip together, --at without a clip or outside it, unknown pose or clip), input (another file
/// that cannot be read, is not a humanoid or holds no clip).
Result<Start> start_of(const Character& character, const Humanoid& humanoid, const BakeSettings& settings,
                       Diagnostics& diagnostics);

}  // namespace ukemi
