// From single bones to chains, root and landmarks.
#pragma once

#include "base/character.h"
#include "bones/bones.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Fills segments, root, toes, middle_finger, head_top and fused_origin.
void assemble(const Character& character, const Bones& bones, Humanoid& humanoid);

/// First node below `top` (parents first) whose name contains `word`; -1 when there is none.
int find_below(const Skeleton& skeleton, int top, std::string_view word);

/// Segment origins in file units: the joint above (mean of the chain's nodes), pelvis: midway between the
/// hips.
PerSegment<Vec3> origins_of(const Humanoid& humanoid, const std::vector<Affine>& world_from_node);

/// Exchanges the sides of all segments and landmarks.
void swap_sides(Humanoid& humanoid);

}  // namespace ukemi
