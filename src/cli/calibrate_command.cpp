#include <fmt/format.h>

#include "bake/outputs.h"
#include "base/errors.h"
#include "base/files.h"
#include "check/calibrate.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {
namespace {

Status check_output(const std::filesystem::path& output) {
  if (output.empty()) return usage_error("no output", "add -o FILE.toml");
  return check_writable(output);
}

}  // namespace

int calibrate_command(const Arguments& arguments) {
  CalibrationSettings settings;
  std::filesystem::path output;
  bool exclude_walking = false;
  std::vector<std::filesystem::path> standing;
  Options options("calibrate",
                  "measures the thresholds of the active restriction: from the frames of the clips in which "
                  "somebody stands calmly or walks, and from the mannequin's own clips");
  options.arguments("FILE", settings.files, "files with motion");
  options.paths("--standing", standing, "further files, of which only calm standing is measured");
  options.number("--factor", "X", settings.factor, Range{1.0, 100.0},
                 "threshold over the 99th percentile of standing");
  options.flag("--exclude-walking", exclude_walking, "let walking exceed the thresholds");
  options.path("-o,--output", output, "the thresholds, as .toml: bake --active-file reads them");
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check_output(output); !status) return print_error(status.error());
  settings.walking = !exclude_walking;
  for (const auto& file : standing) settings.standing_files.push_back(file.string());

  Diagnostics diagnostics;
  const auto calibration = calibrate(settings, diagnostics);
  print_warnings(diagnostics);
  if (!calibration) return print_error(calibration.error());
  if (const Status status = write_file(output, calibration_toml(*calibration)); !status)
    return print_error(status.error());
  return print_result(calibration_text(*calibration) + fmt::format("wrote {}\n", output.string()), 0);
}

}  // namespace ukemi
