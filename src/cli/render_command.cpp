#include <fmt/format.h>

#include <string>

#include "bake/outputs.h"
#include "bake/sheet.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/settings_options.h"

namespace ukemi {
namespace {

Status check_output(const std::filesystem::path& output) {
  if (output.empty()) return Error{ErrorKind::usage, "", 0, 0, "", "no output", "add -o FILE.png"};
  if (const Status status = check_picture_name(output); !status) return status.error();
  return check_writable(output);
}

}  // namespace

int render_command(const Arguments& arguments) {
  std::string file;
  std::filesystem::path output;
  RenderSettings settings;
  Options options("render", "draws the contact sheet of a clip");
  options.argument("FILE", file, "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin");
  options.path("-o,--output", output, "the picture, as .png");
  options.text("--clip", "NAME", settings.clip,
               "which clip, by its name or #INDEX [default: the last; the rest pose where there is none]");
  options.flag("--shapes", settings.shapes, "the simulated segments' shapes in place of the mesh");
  declare_humanoid_options(options, settings.humanoid);
  const auto outcome = options.parse(arguments);
  if (!outcome) return print_error(outcome.error());
  if (*outcome == Options::Outcome::help) return print_result(options.help(), 0);
  if (const Status status = check_output(output); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto rendered = render_clip(file, settings, diagnostics);
  print_warnings(diagnostics);
  if (!rendered) return print_error(rendered.error());
  if (const Status status = write_file(output, rendered->png); !status) return print_error(status.error());
  return print_result(
      fmt::format("clip '{}', {:.2f} s\nwrote {}\n", rendered->clip, rendered->duration_s, output.string()),
      0);
}

}  // namespace ukemi
