// The picture of a clip on its card of the review page.
#pragma once

#include <cstdint>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"
#include "render/render.h"

namespace ukemi {

/// A clip and what is known of its blow.
struct ReviewedClip {
  const Character& character;
  const Humanoid& humanoid;
  const Clip& clip;
  double floor_m = 0.0;                  // height of the floor
  Vec3 impact_point = Vec3::Zero();      // world
  Vec3 impact_direction = Vec3::Zero();  // zero: unknown
};

/// A WebP of the clip half-way through its motion. Errors: output.
Result<std::vector<std::uint8_t>> review_thumbnail(const ReviewedClip& reviewed, ThemeKind theme);

}  // namespace ukemi
