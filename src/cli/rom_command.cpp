#include <fmt/format.h>

#include <string>

#include "bake/outputs.h"
#include "bake/rom.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/settings_options.h"

namespace ukemi {
namespace {

constexpr Range kSwingRange{-170.0, 170.0};

Status take_state(RomSettings& settings, const std::string& text) {
  const auto comma = text.find(',');
  if (comma == std::string::npos)
    return Error{ErrorKind::usage,
                 "",
                 0,
                 0,
                 "",
                 fmt::format("'{}' is not AY,AZ", text),
                 "give two angles in degrees, as in --state=20,-35"};
  const auto a_y = parse_number(text.substr(0, comma), kSwingRange);
  if (!a_y) return a_y.error();
  const auto a_z = parse_number(text.substr(comma + 1), kSwingRange);
  if (!a_z) return a_z.error();
  settings.state = Vec2(radians(*a_y), radians(*a_z));
  return Done{};
}

void declare(Options& options, RomSettings& settings) {
  options.text("--joint", "NAME", settings.joint,
               "spine chest neck clavicle_r shoulder_r elbow_r wrist_r hip_r knee_r ankle_r or _l [default: "
               "all]");
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion: human diamond box, or a TOML file");
  options.text("--check", "CLIP|FILE", settings.check,
               "a clip's path through the ranges: a clip of the mannequin, or the last clip of a file");
  options.text("--clip", "NAME", settings.clip, "which clip of that file, by its name or #INDEX");
  options.custom(
      "--state", "AY,AZ", [&settings](const std::string& text) { return take_state(settings, text); },
      "a point of the joint, degrees, with the chords of the polygon through it");
  options.flag("--swing", settings.swing,
               "pulls a single link on the joint into its boundary, under axis, segments and edges");
  declare_humanoid_options(options, settings.humanoid);
}

Status check_output(const std::filesystem::path& output) {
  if (const Status status = check_picture_name(output); !status) return status.error();
  return check_writable(output);
}

}  // namespace

int rom_command(const Arguments& arguments) {
  RomSettings settings;
  std::filesystem::path output;
  bool json = false;
  Options options("rom", "draws or prints the range of motion of the joints, and clips in it");
  declare(options, settings);
  options.path("-o,--output", output, "the picture, as .png");
  options.flag("--json", json, "as JSON to stdout");
  const auto outcome = options.parse(arguments);
  if (!outcome) return print_error(outcome.error());
  if (*outcome == Options::Outcome::help) return print_result(options.help(), 0);
  if (!output.empty())
    if (const Status status = check_output(output); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto rom = rom_of(settings, diagnostics);
  print_warnings(diagnostics);
  if (!rom) return print_error(rom.error());
  if (!output.empty()) {
    const auto png = rom_png(*rom);
    if (!png) return print_error(png.error());
    if (const Status status = write_file(output, *png); !status) return print_error(status.error());
  }
  if (json) return print_result(rom_json(*rom), 0);
  return print_result(rom_text(*rom) + (output.empty() ? "" : fmt::format("wrote {}\n", output.string())), 0);
}

}  // namespace ukemi
