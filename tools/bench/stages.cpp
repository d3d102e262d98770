#include "stages.h"

#include <fmt/format.h>

#include <optional>

#include "bake/bake.h"
#include "bake/report.h"
#include "stopwatch.h"
#include "study/compare.h"

namespace ukemi {

Status measure_stages(const Character& character, int count) {
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

}  // namespace ukemi
