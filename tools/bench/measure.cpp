#include "measure.h"

#include <algorithm>

#include "body/ground.h"
#include "bullet_peer.h"
#include "rise/getting_up.h"
#include "stopwatch.h"

namespace ukemi {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kFixedHz = 480.0;
constexpr double kWeak = 0.2, kMedium = 0.6, kStrong = 1.5;  // times the hit's speed

SimulationSettings without_tone(SimulationSettings settings) {
  settings.tone = 0.0;
  return settings;
}

SimulationSettings fixed(SimulationSettings settings) {
  settings.fixed_hz = kFixedHz;
  return settings;
}

/// What became of a living body.
const char* row_of(const ControllerReport& behaviour) {
  if (behaviour.fall_begins_s) return "fall";
  return behaviour.steps.empty() ? "stand" : "step";
}

void add_figures(const SimulationResult& result, Sample& sample) {
  sample.steps = result.figures.steps;
  sample.rejected = result.figures.rejected_steps;
  sample.samples = result.limits.samples;
  sample.over_1deg = result.limits.over_1deg;
  sample.excess_max_deg = result.limits.excess_max_deg;
  sample.separation_max_m = result.figures.joint_separation_max_m;
  sample.energy_gain_max_j = result.figures.energy_gain_max_j;
  sample.rested = result.figures.rest_time_s.has_value();
}

void add_cost(double cpu_s, Sample& sample) {
  const EngineCost cost = engine_cost();
  sample.cpu_s = cpu_s - cost.counting_s;
  sample.engine_s = cost.engine_s;
  sample.calls = cost.calls;
  sample.rows = cost.rows;
  sample.contacts = cost.contacts;
}

}  // namespace

Result<Measure> Measure::make(const Character& character, int hits, double duration_s) {
  Diagnostics diagnostics;
  auto prepared = prepare_bake(character, BakeSettings{}, diagnostics);
  if (!prepared) return prepared.error();
  Measure measure;
  measure.skin_ = outermost_skin(character, prepared->humanoid, prepared->start.pose,
                                 prepared->start.segments, prepared->body);
  measure.prepared_ = std::move(*prepared);
  measure.hits_ = random_hits(kSeed, hits);
  measure.duration_s_ = duration_s;
  return measure;
}

std::vector<std::string> Measure::runs() {
  std::vector<std::string> runs = {kReference, "limp", "limp, no tone", "weak", "medium", "strong", "get-up"};
  if (has_bullet()) runs.emplace_back(kBulletRun);
  return runs;
}

Scene Measure::scene(int hit, double times) const {
  const Quat& pelvis = prepared_.start.segments[index(Segment::pelvis)].rotation;
  Scene scene = scene_of(hits_[static_cast<std::size_t>(hit)], pelvis);
  scene.ball_speed_m_s *= times;
  return scene;
}

Sample Measure::simulated(int hit, const std::string& run, double times, const SimulationSettings& settings,
                          Behaviour kind) const {
  Sample sample;
  sample.hit = hit;
  sample.run = sample.row = run;
  BehaviourSettings behaviour = prepared_.behaviour;
  behaviour.kind = kind;
  const Scene hit_by = scene(hit, times);
  Diagnostics diagnostics;
  reset_engine_cost();
  const double before = thread_seconds();
  auto result = simulate(simulation_input(prepared_, hit_by, settings, behaviour), diagnostics);
  std::optional<GetUpTimes> up;
  if (result && run == "get-up")
    up = add_get_up({prepared_.body, prepared_.range, prepared_.start.state.segments, skin_, nullptr},
                    {GetUpStyle::plain, 0, settings.fps}, result->trajectory);
  add_cost(thread_seconds() - before, sample);
  sample.failed = !result || (run == "get-up" && !up);
  if (!result) return sample;
  add_figures(*result, sample);
  if (kind != Behaviour::limp && run != "get-up") sample.row = row_of(result->behaviour);
  return sample;
}

Sample Measure::sample(int hit, const std::string& run) const {
  SimulationSettings settings;
  settings.duration_s = duration_s_;
  if (run == kReference) return simulated(hit, run, 1.0, fixed(settings), Behaviour::limp);
  if (run == "limp") return simulated(hit, run, 1.0, settings, Behaviour::limp);
  if (run == "limp, no tone") return simulated(hit, run, 1.0, without_tone(settings), Behaviour::limp);
  if (run == "weak") return simulated(hit, run, kWeak, settings, Behaviour::alert);
  if (run == "medium") return simulated(hit, run, kMedium, settings, Behaviour::alert);
  if (run == "strong") return simulated(hit, run, kStrong, settings, Behaviour::alert);
  if (run == kBulletRun) return bullet_sample(prepared_, scene(hit, 1.0), hit, duration_s_);
  BakeSettings gets_up;
  gets_up.get_up_s = 0.0;
  settings.duration_s = std::max(duration_s_, simulated_s(gets_up));
  return simulated(hit, run, kStrong, settings, Behaviour::alert);
}

}  // namespace ukemi
