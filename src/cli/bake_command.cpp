#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <thread>

#include "bake/bake.h"
#include "bake/outputs.h"
#include "bake/report.h"
#include "bake/response.h"
#include "base/errors.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/picture_options.h"
#include "cli/progress_line.h"
#include "cli/settings_options.h"
#include "cli/stop_signals.h"
#include "prepare/impact.h"

namespace ukemi {
namespace {

struct BakeRequest {
  std::string character;
  BakeSettings settings;
  bool json = false;
  bool quiet = false;
};

void declare_out(Options& options, BakeRequest& request) {
  BakeSettings& settings = request.settings;
  options.group("out");
  options.paths("-o,--output", settings.outputs,
                "the clip, as .glb, .gltf, .fbx, .bvh, .vrm (of a VRM) or .vrma (for any VRM); a folder: "
                "named there by "
                "character, hit and preset");
  options.path("--sheet", settings.sheet, "contact sheet, as .png");
  options.path("--preview", settings.preview, "moving picture, as .webp (640x360, 30 a second)");
  options.everyday(false);
  options.flag("--append", settings.append, "add the clip to those of a glTF or FBX output that exists");
  options.custom(
      "--theme", "light|dark", [&](const std::string& text) { return take_theme(text, settings.theme); },
      "colours of the pictures [default light]");
  options.path("--report", settings.report, "what the bake did, as JSON");
  options.path("--events", settings.events,
               "times of blow, steps, contacts and rest, as JSON: hit.events.json");
  options.flag("--json", request.json, "the report as JSON to stdout");
  options.flag("--quiet", request.quiet, "nothing to stdout, no warnings");
}

Status check(const BakeRequest& request) {
  const BakeSettings& settings = request.settings;
  if (request.json && request.quiet)
    return usage_error("--json and --quiet exclude each other", "give one of them");
  if (settings.outputs.empty() && settings.sheet.empty() && settings.preview.empty() &&
      settings.report.empty() && settings.events.empty() && !request.json)
    return usage_error(
        "nothing to write",
        "add -o hit.glb (or .gltf, .fbx, .bvh, .vrma, or a folder), --sheet, --preview, --report, "
        "--events or --json");
  return Done{};
}

/// Trials run on idle processors; Ctrl-C keeps the best so far.
Result<BakedFile> search_and_bake(const BakeRequest& request, Diagnostics& diagnostics) {
  if (most_trials(request.settings) == 1) return bake_file(request.character, request.settings, diagnostics);
  const StopSignals signals;
  const ProgressLine line("trial", !request.quiet && !request.json);
  SearchRun run;
  run.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  run.after_each = [&line](int done, int most) { line.show(done, most); };
  run.stopped = [] { return StopSignals::stopped_by() != 0; };
  return bake_file(request.character, request.settings, diagnostics, run);
}

std::string summary(const BakeRequest& request, const BakedFile& baked) {
  const BakedClip& outcome = baked.outcome;
  const LimitFigures& limits = outcome.limits;
  const SimulationFigures& figures = outcome.figures;
  std::string text = blow_in_words(request.settings, outcome.prepared.scene);
  if (figures.momentum_n_s > 0.0) text += fmt::format(": {:.1f} N s", figures.momentum_n_s);
  text += fmt::format("; {:.2f} m, {:.1f} kg\n", outcome.prepared.humanoid.height_m,
                      outcome.prepared.body.mass_kg);
  text += fmt::format("{:.2f} s, {} frames at {} fps; {}, {}\n", outcome.timeline.clip.duration_s(),
                      outcome.timeline.clip.frames.size(), outcome.timeline.clip.fps,
                      outcome_text(response_of(outcome)),
                      figures.rest_time_s ? fmt::format("at rest after {:.2f} s", *figures.rest_time_s)
                                          : std::string("not at rest"));
  text += fmt::format("range of motion{}: {} of {} samples over 1 degree outside, at most {:.2f} degrees{}\n",
                      outcome.prepared.widened.empty() ? "" : ", widened for the start pose",
                      limits.over_1deg, limits.samples, limits.excess_max_deg,
                      limits.worst_joint ? fmt::format(" ({})", name(*limits.worst_joint)) : std::string());
  if (outcome.human.excess_max_deg > 1.0)
    text += fmt::format(
        "human range of motion: {} of {} joint samples over 1 degree outside, at most {:.2f} "
        "degrees{}\n",
        outcome.human.over_1deg, outcome.human.samples, outcome.human.excess_max_deg,
        outcome.human.worst_joint ? fmt::format(" ({})", name(*outcome.human.worst_joint)) : "");
  if (outcome.trials > 1) text += fmt::format("{} trials; score {:.2f}\n", outcome.trials, outcome.score);
  if (figures.help_n_s > 0.0) text += fmt::format("helped from outside: {:.1f} N s\n", figures.help_n_s);
  for (const auto& output : request.settings.outputs) text += "wrote " + output.string() + "\n";
  if (!request.settings.sheet.empty()) text += "wrote " + request.settings.sheet.string() + "\n";
  if (!request.settings.preview.empty()) text += "wrote " + request.settings.preview.string() + "\n";
  for (const auto& file : {request.settings.report, request.settings.events})
    if (!file.empty()) text += "wrote " + file.string() + "\n";
  return text;
}

}  // namespace

int bake_command(const Arguments& arguments) {
  BakeRequest request;
  Options options("bake", "bakes one hit reaction of a character");
  options.argument("CHARACTER", request.character,
                   "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin");
  declare_bake_options(options, request.settings);
  declare_out(options, request);
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check(request); !status) return print_error(status.error());
  name_outputs(request.character, request.settings);

  Diagnostics diagnostics;
  const auto baked = search_and_bake(request, diagnostics);
  if (!request.quiet) print_warnings(diagnostics);
  if (!baked) return print_error(baked.error());
  if (request.quiet) return 0;
  return request.json ? print_json(baked->report, 0) : print_result(summary(request, *baked), 0);
}

}  // namespace ukemi
