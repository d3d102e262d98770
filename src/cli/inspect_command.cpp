#include <string>

#include "check/inspect.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/settings_options.h"

namespace ukemi {

int inspect_command(const Arguments& arguments) {
  std::string file;
  InspectSettings settings;
  bool json = false;
  Options options(
      "inspect",
      "says what is in a file: skeleton, humanoid map, units, clips, and how far its poses lie outside the "
      "range of motion.\nExit status: 0 humanoid, 1 not a humanoid, 2 malformed");
  options.argument("FILE", file, "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin");
  declare_humanoid_options(options, settings.humanoid);
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion: human diamond box, or a TOML file");
  options.flag("--json", json, "as JSON");
  if (const auto status = status_at_once(options, arguments)) return *status;

  Diagnostics diagnostics;
  const auto inspection = inspect(file, settings, diagnostics);
  print_warnings(diagnostics);
  if (!inspection) return print_error(inspection.error());
  if (inspection->verdict == Verdict::malformed) print_error(*inspection->error);
  const int status = exit_status(inspection->verdict);
  return json ? print_json(inspection_json(*inspection, diagnostics), status)
              : print_result(inspection_text(file, *inspection), status);
}

}  // namespace ukemi
