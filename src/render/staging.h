// Where the camera stands and where the floor lies.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render/drawn_character.h"
#include "render/moments.h"
#include "render/painter.h"

namespace ukemi {

/// Places of the joints in every frame, metres.
using JointPaths = std::vector<std::vector<Vec3>>;

/// The stage of a motion, and how it moves along where the figure goes far.
struct Staging {
  StageView stage;
  std::vector<Vec3> shifts;  // per frame, horizontal, metres; empty: the camera stands still

  bool follows() const { return !shifts.empty(); }
  StageView at(int frame) const;
};

/// The way the camera looks, and a stage whose camera stands where `framing` put it; `seen`: what it holds.
Quat telling_side(const DrawnCharacter& figure, const Shot& shot, const JointPaths& joints,
                  const std::optional<ViewAngles>& view = {});
StageView stage_about(const Camera& camera, const Eigen::AlignedBox3d& seen);

struct Viewpoint {
  std::optional<ViewAngles> view{};
  bool all_around = false;  // far enough for a camera that goes round the middle of the motion
  ThemeKind theme = ThemeKind::light;
};

/// One view for all moments: the camera looks across the blow (or, without one, across the way), turned
/// towards the figure's front, and holds all joints of all frames and all that the moments show. It stands
/// still unless the figure would become much smaller than with a camera that follows it. Top: share of the
/// picture's height that is kept free for labels.
Staging set_stage(const DrawnCharacter& figure, const Shot& shot, const JointPaths& joints,
                  const std::vector<Moment>& moments, double aspect, double top,
                  const Viewpoint& viewpoint = {});

/// The arrow of the blow: it ends at the impact point, or behind the ball that touches it there.
/// Shown shortly before and after the mark "impact" only.
bool shows_arrow(const Shot& shot, int frame);
void add_blow_arrow(Geometry& geometry, const Shot& shot, int frame, float alpha = 1.0f);
/// The same, seen through what hides it.
void add_blow_arrow(FrameGeometry& geometry, const Shot& shot, int frame);

}  // namespace ukemi
