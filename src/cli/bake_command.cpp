#include <fmt/format.h>

#include <string>

#include "bake/bake.h"
#include "bake/impact.h"
#include "bake/report.h"
#include "cli/character_options.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {
namespace {

struct BakeRequest {
  std::string character;
  BakeSettings settings;
  bool json = false;
  bool quiet = false;
};

Error usage(std::string what, std::string fix) {
  return {ErrorKind::usage, "", 0, 0, "", std::move(what), std::move(fix)};
}

void declare_hit(Options& options, BakeSettings& settings) {
  options.group("hit");
  options.text(
      "--hit", "SEGMENT", settings.hit,
      "what is hit: pelvis abdomen chest head clavicle_l upperarm_l forearm_l hand_l thigh_l shank_l foot_l, "
      "or _r");
  options.text(
      "--from", "DIR", settings.from,
      "where the blow comes from: front back left right above, or AZIMUTH[,ELEVATION] in degrees, 0 = from "
      "the front, 90 = from the character's left [-360 to 360, -90 to 90]");
  options.text("--preset", "NAME", settings.preset, "punch kick medicine-ball football tackle shot");
  options.number("--ball-mass", "KG", settings.ball_mass_kg, Range{0.001, 10000.0},
                 "in place of the preset's");
  options.number("--ball-speed", "M_S", settings.ball_speed_m_s, Range{0.01, 1000.0},
                 "in place of the preset's");
  options.number("--ball-radius", "M", settings.ball_radius_m, Range{0.005, 5.0}, "in place of the preset's");
  options.custom(
      "--scene", "ball|slope|fall|push|impulse|box",
      [&settings](const std::string& text) -> Status {
        if (const auto scene = parse_scene(text); !scene) return scene.error();
        settings.scene = text;
        return Done{};
      },
      "what happens: a ball flies in, a ball rolls down a ramp, the body is tipped over or dropped, a force "
      "acts for a time, momentum is given at once, a box slides in; mass, speed and radius (half edge) are "
      "the ball's [default: the preset's]");
  options.number("--slope-deg", "DEG", settings.slope_deg, Range{1.0, 60.0}, "slope: of the ramp");
  options.number("--fall-height", "M", settings.fall_height_m, Range{0.0, 50.0}, "fall: above the floor");
  options.number("--tip-speed", "M_S", settings.tip_speed_m_s, Range{0.0, 20.0},
                 "fall: of the centre of mass, away from --from");
}

void declare_body(Options& options, BakeSettings& settings) {
  options.group("body");
  options.number(
      "--mass", "KG", settings.mass_kg, Range{0.001, 10000.0},
      "mass of the body; default: 73 kg (height / 1.741 m)^3, female 61.9 kg (height / 1.735 m)^3");
  options.choice(
      "--sex", {"male", "female"}, 0,
      [&settings](std::size_t i) { settings.sex = i == 0 ? Sex::male : Sex::female; },
      "table of the segments' masses");
  declare_humanoid_options(options, settings.humanoid);
}

void declare_start(Options& options, BakeSettings& settings) {
  options.group("start");
  options.text(
      "--pose", "rest|stand|guard", settings.pose,
      "still pose to start from [default: stand; a file that only has motion starts from its own clip]");
  options.text("--clip", "NAME", settings.clip, "clip of the file to start from, by its name or #INDEX");
  options.number("--at", "S", settings.at_s, Range{0.0, 86400.0},
                 "time in that clip at the first contact; default 0");
}

Status take_rate(SimulationSettings& simulation, const std::string& text) {
  if (text == "adaptive") {
    simulation.fixed_hz = 0.0;
    return Done{};
  }
  const std::string prefix = "fixed:";
  if (!text.starts_with(prefix))
    return usage(fmt::format("--rate: unknown word '{}'", text), "give adaptive or fixed:HZ");
  const auto hz = parse_number("--rate", text.substr(prefix.size()), Range{60.0, 10000.0});
  if (!hz) return hz.error();
  simulation.fixed_hz = *hz;
  return Done{};
}

void declare_method(Options& options, BakeSettings& settings) {
  SimulationSettings& simulation = settings.simulation;
  options.group("method");
  options.choice(
      "--limits", {"edges", "segments", "axis"}, 0,
      [&simulation](std::size_t i) {
        constexpr Limits limits[] = {Limits::edges, Limits::segments, Limits::axis};
        simulation.limits = limits[i];
      },
      "how the range of motion is kept");
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion: human diamond box, or a TOML file");
  options.choice(
      "--active", {"implicit", "explicit", "off"}, 0,
      [&simulation](std::size_t i) {
        constexpr Active active[] = {Active::implicit, Active::explicit_torque, Active::off};
        simulation.active = active[i];
      },
      "active restriction: joints resist fast rotation, like a person who tenses up");
  options.number("--active-k", "1_S", simulation.active_k, Range{0.0, 2000.0, true}, "its strength k");
  options.custom(
      "--active-file", "FILE",
      [&simulation](const std::string& text) -> Status {
        simulation.active_file = text;
        return Done{};
      },
      "its thresholds, as calibrate writes them [default: the program's own]");
  options.number("--active-delay", "S", simulation.active_delay_s, Range{0.0, 10.0},
                 "time before it sets in");
  options.number(
      "--tone", "0..1", simulation.tone, Range{0.0, 1.0},
      "share of a man's joint torques that hold the start pose at first; 0.3, or 0 with --rate fixed");
  options.number("--tone-fade", "S", simulation.tone_fade_s, Range{0.0, 10.0, true}, "time in which it goes");
  options.number("--damping", "1_S", simulation.damping, Range{0.0, 100.0},
                 "joint damping; 10, or 0 with --rate fixed");
  options.custom(
      "--rate", "adaptive|fixed:HZ",
      [&simulation](const std::string& text) { return take_rate(simulation, text); },
      "time steps of the simulation [default adaptive; HZ 60 to 10000]");
}

void declare_clip(Options& options, BakeSettings& settings) {
  options.group("clip");
  options.number("--duration", "S", settings.simulation.duration_s, Range{0.0, 60.0, true}, "length at most");
  options.on_off("until-rest", settings.until_rest, "end the clip once everything rests",
                 "keep the still tail, up to --duration");
  options.number("--hold", "S", settings.hold_s, Range{0.0, 60.0}, "kept after that");
  options.number("--fps", "N", settings.simulation.fps, Range{1.0, 1000.0}, "frames per second");
  options.choice(
      "--keys", {"reduced", "all"}, settings.keys.enabled ? 0 : 1,
      [&settings](std::size_t i) { settings.keys.enabled = i == 0; }, "keys of a glTF clip");
  options.custom(
      "--key-error-mm", "MM",
      [&settings](const std::string& text) -> Status {
        const auto millimetres = parse_number("--key-error-mm", text, Range{0.0, 1000.0, true});
        if (!millimetres) return millimetres.error();
        settings.keys.tolerance_m = 0.001 * *millimetres;
        return Done{};
      },
      fmt::format("how far reduced keys may move a joint [default {}; above 0, at most 1000]",
                  settings.keys.tolerance_m * 1000.0));
}

void declare_out(Options& options, BakeRequest& request) {
  BakeSettings& settings = request.settings;
  options.group("out");
  options.paths("-o,--output", settings.outputs, "the clip, as .glb, .gltf or .bvh");
  options.flag("--clip-only", settings.clip_only, "glTF without the mesh");
  options.custom(
      "--bvh-unit", "cm|m",
      [&settings](const std::string& text) -> Status {
        if (text != "cm" && text != "m")
          return usage(fmt::format("--bvh-unit: unknown word '{}'", text), "give cm or m");
        settings.bvh_metres_per_unit = text == "cm" ? 0.01 : 1.0;
        return Done{};
      },
      "length unit of a BVH that does not come from a BVH [default cm]");
  options.path("--sheet", settings.sheet, "contact sheet, as .png");
  options.path("--report", settings.report, "what the bake did, as JSON");
  options.flag("--json", request.json, "the same JSON to stdout");
  options.flag("--quiet", request.quiet, "nothing to stdout, no warnings");
}

Status check(const BakeRequest& request) {
  const BakeSettings& settings = request.settings;
  if (request.json && request.quiet)
    return usage("--json and --quiet exclude each other", "give one of them");
  if (settings.outputs.empty() && settings.sheet.empty() && settings.report.empty() && !request.json)
    return usage("nothing to write", "add -o hit.glb (or .gltf, .bvh), --sheet, --report or --json");
  return Done{};
}

std::string summary(const BakeRequest& request, const BakedFile& baked) {
  const BakeOutcome& outcome = baked.outcome;
  const LimitFigures& limits = outcome.simulation.limits;
  const SimulationFigures& figures = outcome.simulation.figures;
  std::string text = fmt::format("{} hit from {}: {:.1f} N s on {:.2f} m, {:.1f} kg\n",
                                 name(outcome.scene.target), request.settings.from, figures.momentum_n_s,
                                 outcome.humanoid.height_m, outcome.body.mass_kg);
  text += fmt::format("{:.2f} s, {} frames at {} fps; {}\n", outcome.clip.duration_s(),
                      outcome.clip.frames.size(), outcome.clip.fps,
                      figures.rest_time_s ? fmt::format("at rest after {:.2f} s", *figures.rest_time_s)
                                          : std::string("not at rest"));
  text += fmt::format("range of motion: {} of {} samples over 1 degree outside, at most {:.2f} degrees{}\n",
                      limits.over_1deg, limits.samples, limits.excess_max_deg,
                      limits.worst_joint ? fmt::format(" ({})", name(*limits.worst_joint)) : std::string());
  for (const auto& output : request.settings.outputs) text += "wrote " + output.string() + "\n";
  if (!request.settings.sheet.empty()) text += "wrote " + request.settings.sheet.string() + "\n";
  if (!request.settings.report.empty()) text += "wrote " + request.settings.report.string() + "\n";
  return text;
}

}  // namespace

int bake_command(const Arguments& arguments) {
  BakeRequest request;
  Options options("bake", "bakes one hit reaction of a character");
  options.argument("CHARACTER", request.character,
                   "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin");
  declare_hit(options, request.settings);
  declare_body(options, request.settings);
  declare_start(options, request.settings);
  declare_method(options, request.settings);
  declare_clip(options, request.settings);
  declare_out(options, request);
  const auto outcome = options.parse(arguments);
  if (!outcome) return print_error(outcome.error());
  if (*outcome == Options::Outcome::help) return print_result(options.help(), 0);
  if (const Status status = check(request); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto baked = bake_file(request.character, request.settings, diagnostics);
  if (!request.quiet) print_warnings(diagnostics);
  if (!baked) return print_error(baked.error());
  if (request.quiet) return 0;
  return print_result(request.json ? baked->report : summary(request, *baked), 0);
}

}  // namespace ukemi
