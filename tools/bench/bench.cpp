// What a bake costs, stage by stage, and what the adaptive steps save. Times are the thread's CPU time;
// everything that is compared runs interleaved in one process, so that ratios hold on a busy machine.
#include <fmt/format.h>
#include <ode/ode.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "bake/bake.h"
#include "bake/report.h"
#include "base/character_path.h"
#include "base/numbers.h"
#include "load/load.h"
#include "study/compare.h"

namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double step_seconds = 0.0;

}  // namespace

extern "C" {
int __real_dWorldStep(dWorldID, dReal);

int __wrap_dWorldStep(dWorldID world, dReal h) {
  const double before = thread_seconds();
  const int result = __real_dWorldStep(world, h);
  step_seconds += thread_seconds() - before;
  return result;
}
}

namespace ukemi {
namespace {

/// What a way of simulating cost over all hits, and how good it was.
struct Tally {
  std::string name;
  SimulationSettings settings;
  double total_s = 0.0, step_s = 0.0, reference_s = 0.0;  // reference: of the same hits with fixed steps
  int hits = 0;
  double excess_max_deg = 0.0, separation_max_m = 0.0, energy_gain_max_j = 0.0;
  long samples = 0, over_1deg = 0, steps = 0, rejected = 0;
  int failed = 0, settled = 0;
};

struct Run {
  std::optional<SimulationResult> result;
  double total_s = 0.0, step_s = 0.0;
};

Run timed(const Prepared& prepared, const Scene& scene, const SimulationSettings& settings, Behaviour kind) {
  Run run;
  BehaviourSettings behaviour = prepared.behaviour;
  behaviour.kind = kind;
  Diagnostics diagnostics;
  step_seconds = 0.0;
  const double before = thread_seconds();
  auto result = simulate(simulation_input(prepared, scene, settings, behaviour), diagnostics);
  run.total_s = thread_seconds() - before;
  run.step_s = step_seconds;
  if (result) run.result = std::move(*result);
  return run;
}

void add_run(Tally& tally, const Run& run, double reference_s) {
  ++tally.hits;
  tally.total_s += run.total_s;
  tally.step_s += run.step_s;
  tally.reference_s += reference_s;
  if (!run.result) {
    ++tally.failed;
    return;
  }
  const SimulationResult& result = *run.result;
  tally.samples += result.limits.samples;
  tally.over_1deg += result.limits.over_1deg;
  tally.steps += result.figures.steps;
  tally.rejected += result.figures.rejected_steps;
  tally.settled += result.figures.rest_time_s ? 1 : 0;
  tally.excess_max_deg = std::max(tally.excess_max_deg, result.limits.excess_max_deg);
  tally.separation_max_m = std::max(tally.separation_max_m, result.figures.joint_separation_max_m);
  tally.energy_gain_max_j = std::max(tally.energy_gain_max_j, result.figures.energy_gain_max_j);
}

void print_tallies(const std::vector<Tally>& tallies) {
  fmt::print("simulate 3 s, CPU time of one thread; ratio: to fixed steps on the same hits\n");
  fmt::print("{:<16}{:>6}{:>9}{:>8}{:>7}{:>9}{:>8}{:>10}{:>9}{:>9}{:>8}{:>8}{:>8}\n", "", "hits", "ms/hit",
             "ratio", "step", "us/step", "steps", "rejected", "over 1", "max deg", "sep mm", "gain J",
             "rested");
  for (const Tally& t : tallies) {
    if (t.hits == 0) continue;
    const double steps = static_cast<double>(t.steps + t.rejected);
    fmt::print(
        "{:<16}{:>6}{:>9.2f}{:>8.3f}{:>6.1f}%{:>9.1f}{:>8.0f}{:>10.0f}{:>9}{:>9.3f}{:>8.2f}{:>8.2f}{:>8}\n",
        t.name, t.hits, 1e3 * t.total_s / t.hits, t.total_s / t.reference_s, 100 * t.step_s / t.total_s,
        1e6 * t.total_s / steps, steps / t.hits, static_cast<double>(t.rejected) / t.hits, t.over_1deg,
        t.excess_max_deg, 1e3 * t.separation_max_m, t.energy_gain_max_j, t.settled);
    if (t.failed > 0) fmt::print("{:<16}{} of {} hits failed\n", "", t.failed, t.hits);
  }
}

SimulationSettings limp() {
  SimulationSettings settings;
  settings.tone = 0.0;
  return settings;
}

SimulationSettings fixed() {
  SimulationSettings settings;
  settings.fixed_hz = 480.0;
  return settings;
}

/// A blow of the same kind, weaker or stronger.
Scene scaled(Scene scene, double times) {
  scene.ball_speed_m_s *= times;
  return scene;
}

/// Limp bodies, and living ones by what became of them: weak blows for who stands, strong ones for who falls.
void measure_simulation(const Prepared& prepared, int hits) {
  enum { kLimp, kNoTone, kStood, kStepped, kFell, kFixed };
  std::vector<Tally> tallies = {{"limp", {}},         {"limp, no tone", limp()}, {"alive: stands", {}},
                                {"alive: steps", {}}, {"alive: falls", {}},      {"fixed:480", fixed()}};
  const Quat& pelvis = prepared.start.segments[index(Segment::pelvis)].rotation;
  for (const RandomHit& hit : random_hits(1, hits)) {
    const Scene scene = scene_of(hit, pelvis);
    const Run reference = timed(prepared, scene, tallies[kFixed].settings, Behaviour::limp);
    add_run(tallies[kFixed], reference, reference.total_s);
    for (const int row : {kLimp, kNoTone})
      add_run(tallies[row], timed(prepared, scene, tallies[row].settings, Behaviour::limp),
              reference.total_s);
    for (const double times : {0.2, 0.6, 1.5}) {
      const Run run = timed(prepared, scaled(scene, times), {}, Behaviour::alert);
      const bool fell = run.result && run.result->behaviour.fall_begins_s;
      const bool stepped = run.result && !run.result->behaviour.steps.empty();
      add_run(tallies[fell ? kFell : stepped ? kStepped : kStood], run, reference.total_s);
    }
  }
  print_tallies(tallies);
}

/// A whole bake as a batch does it: the character is loaded, nothing is drawn.
Status measure_bakes(const Character& character, int count) {
  double prepare_s = 0.0, simulate_s = 0.0, resample_s = 0.0, reduce_s = 0.0, export_s = 0.0, report_s = 0.0,
         whole_s = 0.0;
  std::size_t bytes = 0;
  for (const RandomHit& hit : random_hits(2, count)) {
    BakeSettings settings;
    settings.hit = hit.segment;
    settings.from = *parse_direction(fmt::format("{:.3f}", degrees(hit.from.azimuth) - 180.0));
    Diagnostics diagnostics;
    const double start = thread_seconds();
    const auto prepared = prepare_bake(character, settings, diagnostics);
    if (!prepared) return prepared.error();
    const double ready = thread_seconds();
    const auto simulation =
        simulate(simulation_input(*prepared, prepared->scene, settings.simulation), diagnostics);
    if (!simulation) return simulation.error();
    const double simulated = thread_seconds();
    auto outcome = bake(character, settings, diagnostics);
    if (!outcome) return outcome.error();
    const double baked = thread_seconds();
    BakedFile file{std::move(*outcome), {}, {}, {}, {}, {}};
    const Humanoid& humanoid = file.outcome.prepared.humanoid;
    file.reduced =
        reduce_keys(character.skeleton, file.outcome.timeline.clip, humanoid.world_from_file, settings.keys);
    const double cut = thread_seconds();
    const auto glb = write_glb(character, humanoid, file.reduced, GltfOptions{});
    if (!glb) return glb.error();
    const double written = thread_seconds();
    bytes += glb->size() + report_json("", character, settings, file, diagnostics).size();
    const double end = thread_seconds();
    prepare_s += ready - start;
    simulate_s += simulated - ready;
    resample_s += (baked - simulated) - (simulated - start);
    reduce_s += cut - baked;
    export_s += written - cut;
    report_s += end - written;
    whole_s += end - simulated;
  }
  fmt::print("\nbake of {} random hits: .glb and report, ms a bake, CPU time of one thread\n", count);
  fmt::print("{:>9}{:>10}{:>10}{:>10}{:>9}{:>9}{:>9}{:>18}{:>14}\n", "whole", "prepare", "simulate",
             "resample", "keys", ".glb", "report", "whole / simulate", "bytes a bake");
  const double scale = 1e3 / count;
  fmt::print("{:>9.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>18.3f}{:>14}\n", scale * whole_s,
             scale * prepare_s, scale * simulate_s, scale * resample_s, scale * reduce_s, scale * export_s,
             scale * report_s, whole_s / simulate_s, bytes / static_cast<std::size_t>(count));
  return Done{};
}

Status run(const std::string& name, int hits) {
  Diagnostics diagnostics;
  const auto path = character_path(name);
  if (!path) return path.error();
  const auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  const BakeSettings settings;
  const auto prepared = prepare_bake(*character, settings, diagnostics);
  if (!prepared) return prepared.error();
  measure_simulation(*prepared, hits);
  if (const Status status = measure_bakes(*character, hits); !status) return status.error();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("\npeak memory {:.0f} MB\n", static_cast<double>(usage.ru_maxrss) / 1024.0);
  return Done{};
}

}  // namespace
}  // namespace ukemi

int main(int count, char** words) {
  const std::string character = count > 1 ? words[1] : "mannequin";
  const auto hits = ukemi::parse_number(count > 2 ? words[2] : "300", ukemi::Range{1.0, 1e5});
  const ukemi::Status status = hits ? ukemi::run(character, static_cast<int>(*hits)) : hits.error();
  if (status) return 0;
  fmt::print(stderr, "ukemi_bench: {}\n", status.error().message());
  return ukemi::exit_status(status.error().kind);
}
