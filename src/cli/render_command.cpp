#include <fmt/format.h>

#include <string>

#include "bake/outputs.h"
#include "bake/sheet.h"
#include "base/errors.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/picture_options.h"
#include "cli/settings_options.h"

namespace ukemi {
namespace {

struct RenderRequest {
  std::vector<std::string> files;
  std::filesystem::path output;
  RenderSettings settings;
};

template <typename Value, typename Parse>
auto take_parsed(std::optional<Value>& target, Parse&& parse) {
  return [&target, parse](const std::string& text) -> Status {
    const auto value = parse(text);
    if (!value) return value.error();
    target = *value;
    return Done{};
  };
}

void declare_look(Options& options, RenderSettings& settings) {
  options.group("look");
  options.custom(
      "--theme", "light|dark", [&](const std::string& text) { return take_theme(text, settings.theme); },
      "colours [default light]");
  options.custom(
      "--view", "DIR", take_parsed(settings.view, parse_view),
      "where the camera stands: front back left right above, or AZIMUTH[,ELEVATION] in degrees, 90 = "
      "to the figure's left [default: across the motion]");
  options.custom(
      "--size", "SIZE", take_parsed(settings.size, parse_picture_size),
      "thumbnail, screen, a4, a3 (300 pixels an inch) or WIDTHxHEIGHT in pixels [default: a sheet by "
      "its cells, a moving picture 640x360]");
  options.flag("--shapes", settings.overlays.shapes,
               "the simulated segments' shapes over the mesh; on the floor foot prints (left blue, right "
               "orange), what the body "
               "stands on (green), its centre of mass (dot) and its capture point (ring)");
  options.flag("--axes", settings.overlays.axes, "each joint's axes: forward red, up green, right blue");
  options.flag("--rom", settings.overlays.ranges,
               "each joint's range of motion as a cone: amber near its edge, red outside");
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion of --rom: human, diamond, box or a TOML file");
  options.flag("--trail", settings.overlays.trail, "draws the path of the hips");
}

void declare_kinds(Options& options, RenderSettings& settings) {
  options.group("sheet");
  options.whole("--cells", "N", settings.cells, 1, 100, "how many moments a sheet shows",
                "default 12; 6 a row for several files");
  options.whole("--columns", "N", settings.columns, 1, 100, "how many cells stand side by side", "default 4");
  options.group("moving picture");
  options.number("--fps", "HZ", settings.fps, Range{1.0, 60.0}, "pictures a second");
  options.number("--speed", "X", settings.speed, Range{0.01, 10.0},
                 "speed of the picture: 0.25 is four times as slow as the clip");
  options.number("--turntable", "S", settings.turn_s, Range{0.5, 60.0},
                 "the camera goes once round in this many seconds");
}

Status check(const RenderRequest& request) {
  if (request.files.empty()) return usage_error("no file", "name a file, or the word mannequin");
  if (request.output.empty()) return usage_error("no output", "add -o FILE.png or -o FILE.webp");
  const auto kind = picture_kind(request.output);
  if (!kind) return kind.error();
  const RenderSettings& settings = request.settings;
  if (*kind != PictureKind::sheet && (settings.cells || settings.columns))
    return usage_error("--cells and --columns are for sheets", "ask for -o NAME.png, or leave them out");
  const RenderSettings defaults;
  const auto moving_only = [&](const char* option) {
    return usage_error(fmt::format("{} is for moving pictures", option),
                       "ask for -o NAME.webp or -o NAME_####.png");
  };
  if (*kind == PictureKind::sheet && settings.turn_s) return moving_only("--turntable");
  if (*kind == PictureKind::sheet && settings.fps != defaults.fps) return moving_only("--fps");
  if (*kind == PictureKind::sheet && settings.speed != defaults.speed) return moving_only("--speed");
  if (settings.region != defaults.region && !settings.overlays.ranges)
    return usage_error("--region needs --rom", "add --rom to draw the ranges, or leave --region out");
  if (settings.size && settings.columns)
    return usage_error("--size and --columns exclude each other", "give one of them");
  return check_writable(request.output);
}

std::string summary(const Rendered& rendered) {
  std::string text;
  for (const RenderedClip& clip : rendered.clips)
    text += fmt::format("clip '{}', {:.2f} s\n", clip.clip, clip.duration_s);
  text += fmt::format("wrote {}", rendered.files.front().path.string());
  if (rendered.files.size() > 1) text += fmt::format(" to {}", rendered.files.back().path.string());
  return text + "\n";
}

}  // namespace

int render_command(const Arguments& arguments) {
  RenderRequest request;
  Options options("render", "draws clips: a contact sheet, or a moving picture");
  options.arguments("FILE", request.files,
                    "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin; several for a row each");
  options.path("-o,--output", request.output,
               "a sheet as .png, a moving picture as .webp, or NAME_####.png for a picture per frame");
  options.text("--clip", "NAME", request.settings.clip,
               "which clip, by its name or #INDEX [default: the last; the rest pose where there is none]");
  declare_humanoid_options(options, request.settings.humanoid);
  declare_look(options, request.settings);
  declare_kinds(options, request.settings);
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check(request); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto rendered = render_files(request.files, request.output, request.settings, diagnostics);
  print_warnings(diagnostics);
  if (!rendered) return print_error(rendered.error());
  for (const OutputFile& file : rendered->files)
    if (const Status status = write_file(file.path, file.bytes); !status) return print_error(status.error());
  return print_result(summary(*rendered), 0);
}

}  // namespace ukemi
