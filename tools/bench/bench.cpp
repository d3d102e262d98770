// What a bake costs, stage by stage, and what the adaptive steps save. Times are the thread's CPU time;
// everything that is compared runs interleaved in one process, so that ratios hold on a busy machine.
#include <fmt/format.h>
#include <ode/ode.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
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
  double total_s = 0.0, step_s = 0.0;
  double excess_max_deg = 0.0, separation_max_m = 0.0, energy_gain_max_j = 0.0;
  long samples = 0, over_1deg = 0, steps = 0, rejected = 0;
  int failed = 0, settled = 0;
};

void add_hit(Tally& tally, const Prepared& prepared, const Scene& scene) {
  step_seconds = 0.0;
  Diagnostics diagnostics;
  const double before = thread_seconds();
  const auto run = simulate(simulation_input(prepared, scene, tally.settings), diagnostics);
  tally.total_s += thread_seconds() - before;
  tally.step_s += step_seconds;
  if (!run) {
    ++tally.failed;
    return;
  }
  tally.samples += run->limits.samples;
  tally.over_1deg += run->limits.over_1deg;
  tally.steps += run->figures.steps;
  tally.rejected += run->figures.rejected_steps;
  tally.settled += run->figures.rest_time_s ? 1 : 0;
  tally.excess_max_deg = std::max(tally.excess_max_deg, run->limits.excess_max_deg);
  tally.separation_max_m = std::max(tally.separation_max_m, run->figures.joint_separation_max_m);
  tally.energy_gain_max_j = std::max(tally.energy_gain_max_j, run->figures.energy_gain_max_j);
}

void print_tallies(const std::vector<Tally>& tallies, int hits) {
  fmt::print("simulate, {} random hits of 3 s, CPU time of one thread\n", hits);
  fmt::print("{:<16}{:>9}{:>8}{:>7}{:>7}{:>8}{:>9}{:>9}{:>8}{:>8}{:>8}\n", "", "ms/hit", "ratio", "step",
             "other", "steps", "over 1", "max deg", "sep mm", "gain J", "rested");
  for (const Tally& t : tallies) {
    fmt::print("{:<16}{:>9.2f}{:>8.3f}{:>6.1f}%{:>6.1f}%{:>8.0f}{:>9}{:>9.3f}{:>8.2f}{:>8.2f}{:>8}\n", t.name,
               1e3 * t.total_s / hits, t.total_s / tallies.back().total_s, 100 * t.step_s / t.total_s,
               100 * (1 - t.step_s / t.total_s), static_cast<double>(t.steps + t.rejected) / hits,
               t.over_1deg, t.excess_max_deg, 1e3 * t.separation_max_m, t.energy_gain_max_j, t.settled);
    if (t.failed > 0) fmt::print("{:<16}{} of {} hits failed\n", "", t.failed, hits);
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

void measure_simulation(const Prepared& prepared, int hits) {
  std::vector<Tally> tallies = {{"default", {}}, {"without tone", limp()}, {"fixed:480", fixed()}};
  const Quat& pelvis = prepared.start.segments[index(Segment::pelvis)].rotation;
  for (const RandomHit& hit : random_hits(1, hits))
    for (Tally& tally : tallies) add_hit(tally, prepared, scene_of(hit, pelvis));
  print_tallies(tallies, hits);
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
  const auto prepared = prepare_bake(*character, BakeSettings{}, diagnostics);
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
