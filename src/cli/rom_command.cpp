#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "bake/outputs.h"
#include "base/errors.h"
#include "base/files.h"
#include "check/rom.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/settings_options.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace {

constexpr Range kSwingRange{-170.0, 170.0};

Status take_state(RomSettings& settings, const std::string& text) {
  const auto comma = text.find(',');
  if (comma == std::string::npos)
    return usage_error(fmt::format("'{}' is not AY,AZ", text),
                       "give two angles in degrees, as in --state=20,-35");
  const auto a_y = parse_number(text.substr(0, comma), kSwingRange);
  if (!a_y) return a_y.error();
  const auto a_z = parse_number(text.substr(comma + 1), kSwingRange);
  if (!a_z) return a_z.error();
  settings.state = Vec2(radians(*a_y), radians(*a_z));
  return Done{};
}

constexpr Range kExcessRange{0.0, 180.0};
constexpr double kMostExcess_deg = 1.0;  // unless --max-excess says otherwise

/// The command line of `ukemi rom`.
struct RomRequest {
  RomSettings settings;
  std::optional<double> max_excess_deg;
  std::filesystem::path output;
  bool json = false;
};

void declare(Options& options, RomRequest& request) {
  RomSettings& settings = request.settings;
  options.text("--joint", "NAME", settings.joint,
               "spine chest neck clavicle_r shoulder_r elbow_r wrist_r hip_r knee_r ankle_r or _l [default: "
               "all]");
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion: human diamond box, or a TOML file");
  options.text("--check", "CLIP|FILE", settings.check,
               "a clip's path through the ranges: a clip of the mannequin, or the last clip of a file");
  options.text("--clip", "NAME", settings.clip,
               "with --check FILE: the clip of the file, by its name or #INDEX [default: the last]");
  options.custom(
      "--state", "AY,AZ", [&settings](const std::string& text) { return take_state(settings, text); },
      "a point of the joint, degrees, with the chords of the polygon through it");
  options.flag("--swing", settings.swing,
               "pulls a single link on the joint into its boundary, under axis, segments and edges");
  options.number("--max-excess", "DEG", request.max_excess_deg, kExcessRange,
                 "with --check: exit status 1 when a joint lies farther outside than this [default 1]");
  declare_humanoid_options(options, settings.humanoid);
  options.path("-o,--output", request.output, "the picture, as .png");
  options.flag("--json", request.json, "as JSON to stdout");
}

Status check(const RomRequest& request) {
  if (request.max_excess_deg && !request.settings.check)
    return usage_error("--max-excess needs --check", "name a clip or a file to check");
  if (!request.settings.check) {
    const HumanoidOptions defaults;
    for (const HumanoidSetting& setting : humanoid_settings())
      if (setting.get(request.settings.humanoid) != setting.get(defaults))
        return usage_error(fmt::format("--{} needs --check", setting.name), "name a clip or a file to check");
  }
  if (request.output.empty()) return Done{};
  if (const Status status = check_picture_name(request.output); !status) return status.error();
  return check_writable(request.output);
}

/// Of the joints that were asked for.
double largest_excess_deg(const Rom& rom) {
  double largest = 0.0;
  for (const Joint joint : rom.joints)
    if (const auto& figures = rom.check->figures.joints[index(joint)])
      largest = std::max(largest, figures->excess_max_deg);
  return largest;
}

}  // namespace

int rom_command(const Arguments& arguments) {
  RomRequest request;
  Options options("rom", "draws or prints the range of motion of the joints, and clips in it");
  declare(options, request);
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check(request); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto rom = rom_of(request.settings, diagnostics);
  print_warnings(diagnostics);
  if (!rom) return print_error(rom.error());
  if (!request.output.empty()) {
    const auto png = rom_png(*rom);
    if (!png) return print_error(png.error());
    if (const Status status = write_file(request.output, *png); !status) return print_error(status.error());
  }
  const double most_deg = request.max_excess_deg.value_or(kMostExcess_deg);
  const bool too_far = rom->check && largest_excess_deg(*rom) > most_deg;
  if (request.json) return print_json(rom_json(*rom), too_far ? 1 : 0);
  std::string text = rom_text(*rom);
  if (too_far)
    text += fmt::format("{:.2f} degrees outside, more than --max-excess {:g}\n", largest_excess_deg(*rom),
                        most_deg);
  if (!request.output.empty()) text += fmt::format("wrote {}\n", request.output.string());
  return print_result(text, too_far ? 1 : 0);
}

}  // namespace ukemi
