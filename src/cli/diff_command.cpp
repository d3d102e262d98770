#include <string>

#include "check/difference.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {

int diff_command(const Arguments& arguments) {
  std::string a, b;
  DifferenceSettings settings;
  bool json = false;
  Options options(
      "diff",
      "compares two clips joint by joint, by world position and by local rotation.\nExit status: 0 the same "
      "within the tolerances, 1 different");
  options.argument("A", a, "a file with a clip");
  options.argument("B", b, "another file with a clip");
  options.text("--clip", "NAME", settings.clip,
               "clip of both, by its name or #INDEX [default: the last of each]");
  options.number("--tolerance-deg", "DEG", settings.tolerance_deg, Range{0.0, 360.0},
                 "how far rotations may differ");
  options.number("--tolerance-mm", "MM", settings.tolerance_mm, Range{0.0, 1e6},
                 "how far positions may differ");
  options.flag("--json", json, "as JSON");
  if (const auto status = status_at_once(options, arguments)) return *status;

  Diagnostics diagnostics;
  const auto difference = difference_of_files(a, b, settings, diagnostics);
  print_warnings(diagnostics);
  if (!difference) return print_error(difference.error());
  const int status = difference->within_tolerance ? 0 : 1;
  return json ? print_json(difference_json(a, b, *difference, settings), status)
              : print_result(difference_text(a, b, *difference, settings), status);
}

}  // namespace ukemi
