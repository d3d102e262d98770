// The segments over time: where they start, and what a simulation leaves of them and of the props.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/segments.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Segments at time 0 and their velocities (zero unless the body starts from motion).
struct StartState {
  BodyPose segments;
  PerSegment<Vec3> linear_velocity{};   // of the segment's origin, m/s
  PerSegment<Vec3> angular_velocity{};  // rad/s, world
  StartState() {
    linear_velocity.fill(Vec3::Zero());
    angular_velocity.fill(Vec3::Zero());
  }
};

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
