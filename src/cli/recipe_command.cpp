#include "batch/recipe.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {

int recipe_command(const Arguments& arguments) {
  Options options("recipe",
                  "prints a commented recipe with every key and every setting, ready for ukemi batch");
  if (const auto status = status_at_once(options, arguments)) return *status;
  return print_result(recipe_reference(), 0);
}

}  // namespace ukemi
