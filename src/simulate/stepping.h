// How long the steps are, and which are taken back.
#pragma once

#include <vector>

#include "physics/physics.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Adaptive: 240 Hz, 120 Hz when calm, halved down to 1/960 s when a step's result is bad. Fixed: the
/// reference that speed-ups are measured against. A tick is the shortest step.
struct Stepping {
  bool adaptive = true;
  double tick_s = 1.0 / 960.0;
  int base_ticks = 4;
  int calm_ticks = 8;
};

/// `refinement`: how many times shorter the steps are than the settings say.
Stepping stepping_of(const SimulationSettings& settings, int refinement);
PhysicsSettings physics_settings_of(const SimulationSettings& settings, const Stepping& stepping);

/// What a step has done, before it counts.
struct StepResult {
  std::vector<double> excesses;  // rad, joints of the model
  double separation_m = 0.0;
  double worst_excess() const;
  /// Whether the step is to be taken back and halved.
  bool is_bad() const;
};

/// Whether something sank too far between the contacts of a step's start and those of its end.
bool sinks(const Physics& physics, const Contacts& before, const Contacts& after);

/// Chooses the length of the next step: long ones while nothing turns fast.
class StepLength {
 public:
  explicit StepLength(const Stepping& stepping) : stepping_(stepping) {}
  int next(long ticks) const;
  /// Call after an accepted step.
  void observe(double worst_joint_speed);

 private:
  Stepping stepping_;
  int calm_steps_ = 0;
};

}  // namespace ukemi
