// The articulated body in ODE: restricted joints, floor, props, and a step that can be rejected.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "body/body.h"
#include "restrict/range_of_motion.h"
#include "simulate/trajectory.h"

namespace ukemi {

enum class Limits { edges, segments, segments_euler, axis, none };
enum class Active { implicit, explicit_torque, off };
enum class SceneKind { ball, slope, fall, push, impulse, box };

struct SimulationSettings {
  Limits limits = Limits::edges;
  Active active = Active::implicit;
  double active_k = 15.0;       // 1/s; Era et al. eq. (1)
  double active_delay_s = 0.0;  // reaction time of the active restriction
  std::string active_file;      // thresholds; empty: assets/limits/active.toml
  /// 0 limp .. 1: share of a man's joint torques that hold the start pose at first; default 0.3 with adaptive
  /// steps, 0 with fixed ones.
  std::optional<double> tone;
  double tone_fade_s = 0.6;       // until it has gone
  std::optional<double> damping;  // joint damping, 1/s; default 10 with adaptive steps, 0 with fixed ones
  double fixed_hz = 0.0;          // 0: adaptive steps; else the frozen yardstick at that rate
  double duration_s = 3.0;        // of the simulated part
  double fps = 60.0;              // of the trajectory
  bool stop_at_rest = true;       // hold the pose once everything rests
  bool self_collision = true;
  double gravity = 9.81;  // m/s^2, downwards
};

/// The blow. Distances in metres, directions in the world.
struct Scene {
  SceneKind kind = SceneKind::ball;
  Segment target = Segment::chest;
  Vec3 direction = Vec3(0, 0, 0);  // unit: the way the blow travels
  /// ball: flies into the target, above the floor. slope: rolls down a ramp into the body. box: a cube of
  /// that half edge slides in.
  Vec3 aim_offset = Vec3(0, 0, 0);  // ball, box: from the target's centre to where it is aimed
  double ball_mass_kg = 5.0;
  double ball_speed_m_s = 6.0;  // at contact
  double ball_radius_m = 0.12;
  double slope_rad = radians(20.0);  // slope: of the ramp
  double push_force_n = 300.0;       // push: force on the target
  double push_duration_s = 0.2;
  double impulse_n_s = 30.0;   // impulse: momentum given to the target at once
  double fall_height_m = 0.0;  // fall: the body starts so high above the floor
  double tip_speed_m_s = 0.8;  // fall: of the centre of mass, about the feet, along the direction
};

/// The tone and damping in force.
double tone_of(const SimulationSettings& settings);
double damping_of(const SimulationSettings& settings);

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
  double jitter_rad_s = 0.0;  // RMS angular velocity over the last 0.5 s (0 once stopped at rest)
  double momentum_n_s = 0.0;  // of the blow
  std::optional<double> first_ground_contact_s;  // of anything but the feet
  double angular_momentum_mean_kg_m2_s = 0.0;    // about the centre of mass, mean over 1 s after the blow
  double airborne_mean_s = 0.0;                  // time without ground contact after the blow
  double turning_mean_rad_s = 0.0;       // RMS angular velocity of the segments over 1 s after the blow
  double floor_penetration_end_m = 0.0;  // at the last step
  std::string hash;                      // of every state of the run
};

struct SimulationResult {
  Trajectory trajectory;
  LimitFigures limits;
  SimulationFigures figures;
};

/// Runs the scene on the body. The body holds still until the blow arrives at time 0: the ball starts
/// touching. A run that diverges (a segment faster than 100 m/s, a joint apart by more than 11.5 % of the
/// height, a failure of the engine) is run again at twice the rate, with a warning. Errors: simulation
/// (diverged again: segment, time, speed), usage (settings out of range), input (body, start or range that
/// nothing can be run with).
Result<SimulationResult> simulate(const ArticulatedBody& body, const RangeOfMotion& range,
                                  const StartState& start, const Scene& scene,
                                  const SimulationSettings& settings, Diagnostics& diagnostics);

/// A run as an experiment sees it: judged in a range of its own choice, and a failure is a result.
struct Trial {
  SimulationResult result;       // up to the failure, where there is one
  std::vector<double> excesses;  // of the samples outside, rad
  double simulated_s = 0.0;      // without a still end
  std::optional<Error> failure;  // diverged
};

/// simulate(), with LimitFigures taken against `judged` instead of the range in force. Errors: usage.
Result<Trial> simulate_trial(const ArticulatedBody& body, const RangeOfMotion& range,
                             const RangeOfMotion& judged, const StartState& start, const Scene& scene,
                             const SimulationSettings& settings, Diagnostics& diagnostics);

}  // namespace ukemi
