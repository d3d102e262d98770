#include "humanoid/soles.h"

#include <gtest/gtest.h>

#include "load/load.h"

namespace ukemi {
namespace {

struct Mannequin {
  Diagnostics diagnostics;
  Character character = *load_character(UKEMI_ASSETS_FOLDER "/characters/mannequin.glb", {}, diagnostics);
  Humanoid humanoid = *map_humanoid(character, {}, diagnostics);
  Pose stand = start_pose(character, humanoid, StartPose::stand, {});

  /// Lowest point of the skin of both feet, metres.
  double skin(const Pose& pose) const {
    const SkinExtent extent =
        extent_of_feet(character, humanoid, pose, {Segment::foot_l, Segment::foot_r}, Vec3::UnitY());
    return humanoid.world_from_file.scale * extent.min;
  }
  /// On the toes: both feet turned about the ankle, heels up.
  Pose on_toes(double pitch_deg) const {
    const BodyPose from = segments_of(character.skeleton, humanoid, stand);
    BodyPose to = from;
    for (const Segment foot : {Segment::foot_l, Segment::foot_r})
      to[index(foot)].rotation = from[index(foot)].rotation * exp_rotation(Vec3(0, 0, -radians(pitch_deg)));
    return pose_skeleton(character.skeleton, humanoid, stand, from, to);
  }
};

TEST(Soles, OfFlatFeetAreWhereTheSkinIs) {
  const Mannequin mannequin;
  EXPECT_NEAR(
      Soles(mannequin.character, mannequin.humanoid).lowest(mannequin.character.skeleton, mannequin.stand),
      mannequin.skin(mannequin.stand), 0.006);
}

TEST(Soles, OfFeetOnTheirToesAreTheBallsForToesBend) {
  const Mannequin mannequin;
  const Pose pose = mannequin.on_toes(30.0);
  const double lowest =
      Soles(mannequin.character, mannequin.humanoid).lowest(mannequin.character.skeleton, pose);
  EXPECT_GT(lowest - mannequin.skin(pose), 0.015);
  EXPECT_LT(lowest, mannequin.skin(mannequin.stand) - 0.02) << "the balls go down as the heels go up";
}

}  // namespace
}  // namespace ukemi
