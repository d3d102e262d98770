// The picture of a clip on its card of the review page.
#pragma once

#include <cstdint>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// A PNG of the clip's most telling moment. `direction`: of the blow, zero where there is none. `floor_m`:
/// height of the floor. Errors: output.
Result<std::vector<std::uint8_t>> review_thumbnail(const Character& character, const Humanoid& humanoid,
                                                   const Clip& clip, const Vec3& direction, double floor_m);

}  // namespace ukemi
