// The pose from which the anatomical frames are read.
#pragma once

#include <vector>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

struct Reference {
  Pose pose;
  Vec3 up;                // file axes
  bool is_frame = false;  // a moment of a motion, not a pose that an artist chose
};

/// A motion's zero pose or best frame; a character's rest pose, its bind pose where that is cleaner, else the
/// best frame of its first animation. Turned upright where it does not stand along the up axis, which is that
/// of the user, else of the file (glTF: y), else of the zero pose or of the way the figure stands.
Reference find_reference(const Character& character, const Humanoid& humanoid, const HumanoidOptions& options,
                         Diagnostics& diagnostics);

/// Times of an animation's frames, at most about `at_most` of them.
std::vector<double> sample_times(const Animation& animation, int at_most);

}  // namespace ukemi
