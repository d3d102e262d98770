// Recipes as TOML, and the reactions of those that are accepted.
#include "batch/recipe.h"
#include "fuzz/checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  const auto recipe = parse_recipe(fuzz::text_of(data, size), "folder/recipe.toml");
  if (!recipe) {
    fuzz::require_clear(recipe.error());
    return 0;
  }
  const auto reactions = reactions_of(*recipe, {});
  if (!reactions) {
    fuzz::require_clear(reactions.error());
    return 0;
  }
  for (const Reaction& reaction : *reactions) {
    fuzz::require(reaction.character < recipe->characters.size(), "a reaction's character exists");
    fuzz::require(!reaction.name.empty() && reaction.name.size() <= 255,
                  "a reaction's name is a file's name");
    fuzz::require(
        reaction.name.find('/') == std::string::npos && reaction.name != "." && reaction.name != "..",
        "a reaction's name leads nowhere else");
  }
  return 0;
}
