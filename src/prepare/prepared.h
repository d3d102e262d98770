// What the simulation of a bake is given.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "behave/behaviour.h"
#include "body/body.h"
#include "body/muscles.h"
#include "clip/start.h"
#include "clip/timeline.h"
#include "humanoid/humanoid.h"
#include "prepare/settings.h"
#include "restrict/active.h"
#include "restrict/range_of_motion.h"
#include "rise/rising_clip.h"
#include "simulate/simulate.h"

namespace ukemi {

/// A character in its place, and what happens to it. It does not change afterwards.
struct Prepared {
  std::string reaction;  // "head_left": name of the clip
  Humanoid humanoid;
  Start start;
  ArticulatedBody body;
  RangeOfMotion range;                            // in force: widened joints included
  std::vector<std::pair<Joint, double>> widened;  // radians
  Scene scene;
  ActiveThresholds thresholds;  // of the active restriction
  MuscleStrength strength;
  BehaviourSettings behaviour;
  BodyPose
      home;  // what a body that keeps its feet comes back to: the start pose, or its stance after a motion

  std::shared_ptr<const std::vector<RisingClip>> get_ups;  // a library to get up by; null: none is asked for

  Actor actor(const Character& character) const { return {character, humanoid, start, body}; }
};

/// Errors: those of the rooms above.
Result<Prepared> prepare_bake(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics);

/// What the simulation of a prepared bake is given.
SimulationInput simulation_input(const Prepared& prepared, const Scene& scene,
                                 const SimulationSettings& settings);
/// The same body with another behaviour.
SimulationInput simulation_input(const Prepared& prepared, const Scene& scene,
                                 const SimulationSettings& settings, const BehaviourSettings& behaviour);

}  // namespace ukemi
