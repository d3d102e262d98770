// What a simulation leaves: the segments over time, the props, and the figures that judge the run.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/segments.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// A ball, a box or a slope that takes part in the scene.
struct Prop {
  enum class Kind { ball, box } kind = Kind::ball;
  double radius = 0.0;
  Vec3 size = Vec3::Zero();
  bool moves = true;
  std::vector<Rigid> poses;  // one per frame of the trajectory; a single one when it does not move
};

/// Segments at uniform times: frame i at i / fps after the start of the clip.
struct Trajectory {
  double fps = 60.0;
  std::vector<BodyPose> frames;
  std::vector<Prop> props;
  Vec3 impact_point = Vec3::Zero();      // world, metres
  Vec3 impact_direction = Vec3::Zero();  // unit, the way the blow goes
};

}  // namespace ukemi
