// The loop: steps that are tried, taken back and halved, and what is seen and recorded of those that count.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "body/body.h"
#include "body/muscles.h"
#include "body/trajectory.h"
#include "physics/restriction.h"
#include "physics/scene.h"
#include "restrict/active.h"
#include "restrict/range_of_motion.h"
#include "simulate/controller.h"

namespace ukemi {

struct SimulationSettings {
  Limits limits = Limits::edges;
  Active active = Active::implicit;
  double active_k = 15.0;       // 1/s; Era et al. eq. (1)
  double active_delay_s = 0.0;  // reaction time of the active restriction
  /// 0 limp .. 1: share of a man's joint torques that hold the start pose at first; default 0.3 with adaptive
  /// steps, 0 with fixed ones.
  std::optional<double> tone;
  double tone_fade_s = 0.6;          // until it has gone
  std::optional<double> damping;     // joint damping, 1/s; default 10 with adaptive steps, 0 with fixed ones
  double fixed_hz = 0.0;             // 0: adaptive steps; else fixed steps at that rate, the reference
  std::optional<double> duration_s;  // of the simulated part; default 3
  double fps = 60.0;                 // of the trajectory
  bool stop_at_rest = true;          // hold the pose once everything rests
  bool self_collision = true;
  double gravity = 9.81;  // m/s^2, downwards
};

/// The duration, tone and damping in force.
double duration_of(const SimulationSettings& settings);
double tone_of(const SimulationSettings& settings);
double damping_of(const SimulationSettings& settings);

/// Excess over the range, all joints, every accepted step, before projection unless said otherwise.
struct LimitFigures {
  long samples = 0;
  long over_1deg = 0;
  double excess_p999_deg = 0.0;
  double excess_max_deg = 0.0;
  std::optional<Joint> worst_joint;
  double excess_projected_max_deg = 0.0;
  bool projected = false;
};

struct SimulationFigures {
  long steps = 0;
  long rejected_steps = 0;
  double joint_separation_max_m = 0.0;
  double energy_gain_max_j = 0.0;  // largest rise above the running minimum
  double floor_penetration_max_m = 0.0;
  double self_penetration_max_m = 0.0;
  std::optional<double> rest_time_s;
  double jitter_rad_s = 0.0;      // RMS angular velocity over the last 0.5 s (0 once stopped at rest)
  double momentum_n_s = 0.0;      // of the blow
  double delivered_n_s = 0.0;     // of it, what the body received
  double muscle_share_max = 0.0;  // of a joint's strength that a behaviour's muscles gave
  double muscle_work_j = 0.0;     // of those muscles, either way
  double help_n_s = 0.0;          // given from outside, see Goals::help_n
  std::optional<double> first_ground_contact_s;     // of anything that did not stand on it, feet apart
  PerSegment<std::optional<TouchDown>> touch_down;  // of what did not stand on the floor at the start
  double angular_momentum_mean_kg_m2_s = 0.0;       // about the centre of mass, mean over 1 s after the blow
  double airborne_mean_s = 0.0;                     // time without ground contact after the blow
  double turning_mean_rad_s = 0.0;       // RMS angular velocity of the segments over 1 s after the blow
  double floor_penetration_end_m = 0.0;  // at the last step
  std::string hash;                      // of every state of the run
};

struct SimulationResult {
  Trajectory trajectory;
  LimitFigures limits;
  SimulationFigures figures;
  ControllerReport behaviour;
};

/// What a run is given. The thresholds are those of the active restriction, the strength that of the muscles
/// which a behaviour drives.
struct SimulationInput {
  const ArticulatedBody& body;
  const RangeOfMotion& range;
  const ActiveThresholds& thresholds;
  const MuscleStrength& strength;
  const StartState& start;
  const Scene& scene;
  const SimulationSettings& settings;
  MakeController controller;  // null: nothing drives the body
};

/// Runs the scene on the body. The body holds still until the blow arrives at time 0: the ball starts
/// touching. A run that diverges (a segment over 100 m/s, a joint apart by 11.5 % of the height) or fails
/// is run again at twice the rate, with a warning. Errors: simulation (diverged: segment, time, speed), usage
/// (settings out of range), input (body, start or range of no use), internal (a behaviour that throws, or
/// asks for what no muscle can give: joint, time).
Result<SimulationResult> simulate(const SimulationInput& input, Diagnostics& diagnostics);

/// A run for an experiment: judged by a range of the caller's choice; a failure is a result too.
struct Trial {
  SimulationResult result;       // up to the failure, where there is one
  std::vector<double> excesses;  // of the samples outside, rad
  double simulated_s = 0.0;      // without a still end
  std::optional<Error> failure;  // diverged
};

/// simulate(), with LimitFigures taken against `judged` instead of the range in force. Errors: usage.
Result<Trial> simulate_trial(const SimulationInput& input, const RangeOfMotion& judged,
                             Diagnostics& diagnostics);

}  // namespace ukemi
