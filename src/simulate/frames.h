// Steps to frames at the clip's rate.
#pragma once

#include <vector>

#include "body/trajectory.h"

namespace ukemi {

/// Writes the frames of a trajectory while the simulation steps on: a frame on a step's end is the state
/// itself, others lie between two (positions linearly, rotations along the arc).
class FrameWriter {
 public:
  struct State {
    BodyPose segments;
    std::vector<Rigid> props;
  };
  FrameWriter(double fps, double duration_s, double tick_s, std::vector<Prop> props, State start);

  /// The state after an accepted step.
  void add(double time_s, State state);
  /// The last state is held to the end.
  void hold();

  Trajectory trajectory;

 private:
  void write_until(double time_s);

  double duration_s_, slack_s_;
  State before_, now_;
  double before_s_ = 0.0;
};

}  // namespace ukemi
