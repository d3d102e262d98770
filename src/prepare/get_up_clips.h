// The library that a bake gets up by: get-ups of other files on the character.
#pragma once

#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "body/body.h"
#include "humanoid/humanoid.h"
#include "rise/rising_clip.h"

namespace ukemi {

/// The get-ups in what `text` names: a clip (FILE#NAME), a file, or a folder of files (by name, not below
/// it). Files of a folder that cannot be read or are no humanoids are left out with a warning. Errors: input
/// (no such file or folder, no motion file in it, not a humanoid, no clip, nobody gets up in it), usage (no
/// such clip).
Result<std::vector<RisingClip>> get_up_clips(const Character& character, const Humanoid& humanoid,
                                             const ArticulatedBody& body, const std::string& text,
                                             Diagnostics& diagnostics);

}  // namespace ukemi
