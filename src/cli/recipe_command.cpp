#include "batch/recipe.h"
#include "batch/settings_json.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {

int recipe_command(const Arguments& arguments) {
  Options options("recipe",
                  "prints a commented recipe with every key and every setting, ready for ukemi batch");
  bool json = false;
  options.flag("--json", json,
               "every setting as data instead: name, other names, type, default, range, choices, unit, help");
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (json) {
    const auto settings = settings_json();
    return settings ? print_result(*settings, 0) : print_error(settings.error());
  }
  return print_result(recipe_reference(), 0);
}

}  // namespace ukemi
