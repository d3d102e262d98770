// The neutral pose of a person who is only known from motion.
#pragma once

#include "base/character.h"
#include "humanoid/humanoid.h"
#include "humanoid/reference.h"

namespace ukemi {

/// Corrects node_from_segment from the first animation of a motion file:
/// 1. Upright frames (trunk within 20 degrees of vertical, thighs 35, upper arms 45, knees bent less than
///    60) say how the person holds abdomen, chest and head (pitch and side bend) and clavicles when
///    standing: the mean becomes neutral, with at least 80 such frames (clavicles 15).
/// 2. Elbows and knees bent by more than 30 degrees show the axes of these hinges (at least 10 frames).
/// 3. The mean rotation of the hands against the forearms becomes neutral, and the axis about which a wrist
///    bends most is that of flexion: marker sets put hands up to 45 degrees off, and turn them by more.
///    Frames in which a hand is folded back by more than 80 degrees do not count: the tracker has lost it.
/// 4. Where the reference is a moment of the motion, each foot is read where it lies lowest and flattest.
void refine_from_motion(const Character& character, const Reference& reference, Humanoid& humanoid);

}  // namespace ukemi
