#include "bake/skin_lift.h"

#include <fmt/format.h>

#include <algorithm>

#include "body/ground.h"
#include "clip/ground_motion.h"

namespace ukemi {
namespace {

constexpr double kAllowed_m = 0.009;
constexpr double kMost_m = 0.25;  // a body in a ball of skin
constexpr double kNoticed_m = 0.020;

}  // namespace

double lift_blended_skin(const Actor& actor, const SkinOverFloor& skin, Timeline& timeline) {
  std::vector<double> depths;
  for (const Pose& frame : timeline.clip.frames) depths.push_back(skin.depth(frame).body_m);
  const std::vector<double> up = lifts(depths, kAllowed_m, kMost_m, timeline.clip.fps);
  const std::vector<int> moved = movers(actor.character.skeleton, actor.humanoid);
  for (std::size_t f = 0; f < up.size(); ++f) {
    if (up[f] <= 0.0) continue;
    displace(actor.character.skeleton, actor.humanoid, moved, up[f] * Vec3::UnitY(), timeline.clip.frames[f]);
    for (Rigid& segment : timeline.trajectory.frames[f]) segment.translation.y() += up[f];
  }
  return up.empty() ? 0.0 : *std::max_element(up.begin(), up.end());
}

void warn_of_sinking_skin(const Character& character, const SkinOnFloor& skin, Diagnostics& diagnostics) {
  const auto name_of = [&](int node) { return character.skeleton.label(node); };
  if (skin.max.body_m > kNoticed_m)
    diagnostics.warn(character.path.string(),
                     fmt::format("the skin of '{}' lies up to {:.0f} mm below the floor",
                                 name_of(skin.max.body_node), 1000.0 * skin.max.body_m));
  if (skin.max.other_m > kNoticed_m)
    diagnostics.warn(
        character.path.string(),
        fmt::format("what '{}' carries lies up to {:.0f} mm below the floor: hair, skirts, wings "
                    "and what hands hold do not collide",
                    name_of(skin.max.other_node), 1000.0 * skin.max.other_m));
}

}  // namespace ukemi
