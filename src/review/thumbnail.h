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

/// WebP of both themes.
struct ReviewThumbnails {
  std::vector<std::uint8_t> light, dark;
};

/// The clip half-way through its motion. Errors: output.
Result<ReviewThumbnails> review_thumbnails(const ReviewedClip& reviewed);

}  // namespace ukemi
