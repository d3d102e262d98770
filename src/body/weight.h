// Whether a body's weight lies over what bears it.
#pragma once

#include <algorithm>
#include <vector>

#include "body/body.h"

namespace ukemi {

/// Hull (x, z) of the skin that bears. Skin bears up to 20 mm (of a man) over the floor (y = 0), that of
/// trunk and thighs, which give, up to 50 mm. `skin`: outermost_skin (body/ground.h).
std::vector<Vec2> support_of(const ArticulatedBody& body, const PerSegment<std::vector<Vec3>>& skin,
                             const BodyPose& pose);

/// Metres outside the hull of the skin that is on the floor; less than 0 inside.
struct WeightOffset {
  double mass_m = 0.0;     // of the centre of mass
  double capture_m = 0.0;  // of where its motion takes it: c + v sqrt(h / g) (Hof 2008, eq. 5)

  /// The smaller of the two: momentum may carry over its support a body that is not there yet.
  double least_m() const { return std::min(mass_m, capture_m); }
};

/// Of every frame. Velocities are those over a tenth of a second.
std::vector<WeightOffset> weight_offsets(const ArticulatedBody& body,
                                         const PerSegment<std::vector<Vec3>>& skin,
                                         const std::vector<BodyPose>& frames, double fps);

}  // namespace ukemi
