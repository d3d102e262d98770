#include "bake/recipe.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"

namespace ukemi {

int recipe_command(const Arguments& arguments) {
  Options options("recipe",
                  "prints a commented recipe with every key and every setting, ready for ukemi batch");
  const auto outcome = options.parse(arguments);
  if (!outcome) return print_error(outcome.error());
  return print_result(*outcome == Options::Outcome::help ? options.help() : recipe_reference(), 0);
}

}  // namespace ukemi
