// A reaction over time: the clip, the simulated segments, the props and the marks, which move together.
#pragma once

#include <string>
#include <vector>

#include "base/animation.h"
#include "base/character.h"
#include "body/body.h"
#include "clip/frames.h"
#include "clip/resample.h"
#include "clip/start.h"
#include "humanoid/humanoid.h"
#include "simulate/simulate.h"

namespace ukemi {

/// The character that reacts, as every part of a timeline needs it.
struct Actor {
  const Character& character;
  const Humanoid& humanoid;
  const Start& start;
  const ArticulatedBody& body;
};

/// The segments' frames, as the start pose defines them.
SegmentFrames frames_of(const Actor& actor);

/// Segments of a pose in the frames of the simulation, above a floor at y = 0.
BodyPose segments_above_floor(const Actor& actor, const SegmentFrames& frames, const Pose& pose);

/// Frames that come before a timeline or after it.
struct TimelinePart {
  std::vector<Pose> poses;
  std::vector<BodyPose> segments;         // of each pose, above a floor at y = 0
  std::vector<std::vector<Rigid>> props;  // of each prop, one per pose; none of a prop that has a single pose
};

/// 1. Clip and trajectory have the same frames, and every prop that moves has one pose for each.
/// 2. Times of marks and of the impact count from frame 0.
struct Timeline {
  Trajectory trajectory;  // above a floor at y = 0
  Clip clip;              // where the file places the figure
  double impact_s = 0.0;

  /// Signs of the new rotations are those nearest to the frames beside them. All marks but "start" move.
  void prepend(TimelinePart part);
  void append(TimelinePart part);
};

/// The clip of a trajectory, on the character's own skeleton, with the marks "start" and "impact" at 0.
Timeline timeline_of(const Actor& actor, Trajectory trajectory, std::string name, ResampleError& error);

/// Bones that carry no segment play the start clip after the impact, where there is one.
void play_extra_bones(const Actor& actor, Clip& clip);

}  // namespace ukemi
