#include "simulate/stepping.h"

#include <algorithm>

namespace ukemi {
namespace {

constexpr int kCalmSteps = 8;
constexpr double kCalmSpeed = 3.0;             // rad/s, of every joint
constexpr double kWorstExcess = radians(0.5);  // above: the step is rejected
constexpr double kWorstSeparation = 0.006;     // m
constexpr double kWorstSinking = 0.008;        // m, growth of a pair's depth in one step
constexpr double kFloorDepth = 0.005;          // m: below this in the floor
constexpr double kFloorSinking = 0.002;        // m: how much deeper a pair may sink in a step

}  // namespace

Stepping stepping_of(const SimulationSettings& settings, int refinement) {
  Stepping s;
  s.tick_s /= refinement;
  if (settings.fixed_hz > 0.0) {
    s.adaptive = false;
    s.tick_s = 1.0 / (settings.fixed_hz * refinement);
    s.base_ticks = s.calm_ticks = 1;
  }
  return s;
}

PhysicsSettings physics_settings_of(const SimulationSettings& settings, const Stepping& stepping) {
  PhysicsSettings physics;
  physics.limits = settings.limits;
  physics.active = settings.active;
  physics.active_k = settings.active_k;
  physics.active_delay_s = settings.active_delay_s;
  physics.damping = damping_of(settings);
  physics.gravity = settings.gravity;
  physics.self_collision = settings.self_collision;
  if (stepping.adaptive) return physics;
  physics.adaptive = false;
  physics.reach = {std::max(0.25, 120.0 * stepping.tick_s), 0.0};
  physics.max_correcting_speed = 1.0;
  physics.sparse_friction = false;
  return physics;
}

double StepResult::worst_excess() const { return *std::max_element(excesses.begin(), excesses.end()); }

bool StepResult::is_bad() const { return separation_m > kWorstSeparation || worst_excess() > kWorstExcess; }

bool sinks(const Physics& physics, const Contacts& before, const Contacts& after) {
  for (std::size_t p = 0; p < after.depth.size(); ++p) {
    const double growth = after.depth[p] - before.depth[p];
    if (growth > kWorstSinking) return true;
    if (physics.is_floor(p) && after.depth[p] > kFloorDepth && growth > kFloorSinking) return true;
  }
  return false;
}

int StepLength::next(long ticks) const {
  const bool on_calm_grid = ticks % stepping_.calm_ticks == 0;
  return calm_steps_ >= kCalmSteps && on_calm_grid ? stepping_.calm_ticks : stepping_.base_ticks;
}

void StepLength::observe(double worst_joint_speed) {
  calm_steps_ = worst_joint_speed < kCalmSpeed ? calm_steps_ + 1 : 0;
}

}  // namespace ukemi
