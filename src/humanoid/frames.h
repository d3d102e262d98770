// Reference pose, unit, up axis and anatomical frames (see Humanoid).
#pragma once

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Fills reference, rest_pose, up_axis, world_from_file, height_m and node_from_segment; exchanges the sides
/// where the feet point backwards. Errors: input, when the trunk does not rise from the legs in any pose of
/// the file.
///
/// The frames, read from the reference pose (x anterior, y up, z right; H is the shortest rotation that
/// lowers a limb bone to hang straight down):
/// 1. up is the file axis along which the head lies farthest from the feet; right is the horizontal part of
///    the line from the left to the right hip; anterior = up x right.
/// 2. The toes lie in front of the ankles, else left and right are exchanged.
/// 3. Pelvis, abdomen, chest, head, clavicles: anterior, up, right. Raised arms hold the clavicles up: they
///    are lowered by 8 degrees (T-pose) or 3 (A-pose).
/// 4. Upper arm and thigh: H^-1 of these axes, so y runs along the bone.
/// 5. Forearm: y along the bone, x from little to index finger, else as for a straight elbow.
/// 6. Hand: y from the base of the middle finger to the wrist, else as the forearm.
/// 7. Shank: y along the bone, z that of the thigh.
/// 8. Foot: y up, x towards the toes; on a leg spread by more than 8 degrees, once its shank is turned to
///    the vertical.
Status find_frames(const Character& character, const HumanoidOptions& options, Humanoid& humanoid,
                   Diagnostics& diagnostics);

}  // namespace ukemi
