// Poses and clips of another file on a character.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// True for "walk.bvh" and "hero.glb#run": a file that may hold motion and, after '#', one of its clips by
/// name or index.
bool names_motion_file(std::string_view text);

/// The clip that `text` names (the file's first unless told) as motion of `character`: its own where the file
/// has the same skeleton, else by the segments (see Transfer). It stands on y = 0 and its first pelvis over
/// that of the reference pose. Keys are at the file's frames, at most 60 a second. Errors: input (unreadable,
/// not a humanoid, no clips), usage (no such clip).
Result<Animation> motion_of_file(const Character& character, const Humanoid& humanoid,
                                 const std::string& text, Diagnostics& diagnostics);

/// All clips of a file, or the one that `text` names after '#', as motions of `character`, as above. Errors:
/// the same.
Result<std::vector<Animation>> motions_of_file(const Character& character, const Humanoid& humanoid,
                                               const std::string& text, Diagnostics& diagnostics);

/// The first frame of that clip, or the rest pose of a file without clips, on the floor. Errors: the same but
/// for files without clips.
Result<Pose> pose_of_file(const Character& character, const Humanoid& humanoid, const std::string& text,
                          Diagnostics& diagnostics);

/// The clip with the whole figure going on along the ground at a velocity (forward and right of the world, x
/// and z, m/s).
Animation going_on(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& clip,
                   const Vec2& velocity);

}  // namespace ukemi
