// What feet stand on.
#pragma once

#include <array>
#include <vector>

#include "humanoid/humanoid.h"
#include "humanoid/skin.h"

namespace ukemi {

/// Of the skin around the bones of some feet, along a direction of the world (unit), file units.
SkinExtent extent_of_feet(const Character& character, const Humanoid& humanoid, const Pose& pose,
                          const std::vector<Segment>& feet, const Vec3& direction);

/// Farther from the ankle, in heights, than any shoe.
inline constexpr double kFarSole = 0.4;

/// Ankle centre (de Leva 1996) and toe joint above the sole, in heights: where there is no skin to see it.
inline constexpr double kAnkleUp = 0.039, kToeJointUp = 0.012;

/// Heels and balls of the feet. Toes bend, also where a rig has none: they do not count.
class Soles {
 public:
  Soles(const Character& character, const Humanoid& humanoid);

  /// Where they are in the world, metres: of the left and the right foot.
  std::array<std::vector<Vec3>, 2> points(const Skeleton& skeleton, const Pose& pose) const;
  /// Height of the lowest of them.
  double lowest(const Skeleton& skeleton, const Pose& pose) const;

 private:
  const Humanoid& humanoid_;
  std::array<std::vector<Vec3>, 2> points_;  // of the left and the right foot, in its frame
};

}  // namespace ukemi
