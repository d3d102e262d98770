// Recipes: TOML files that describe many reactions, and the reactions that they describe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "prepare/settings.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// Files that a reaction may have.
enum class OutputKind { glb, gltf, fbx, vrma, bvh, sheet, report, events };
std::string_view extension(OutputKind kind);  // ".glb", ".png" of the sheet, ".json" of the report

/// What a recipe says of one setting: texts as Setting::set takes them, and where it says so.
struct RecipeValue {
  std::vector<std::string> texts;
  int line = 0;
  int column = 0;
};
using RecipeSettings = std::map<std::string, RecipeValue>;  // by the setting's name

/// How far variations of a reaction differ from what is written: each quantity by up to this much either way.
struct Jitter {
  double direction_deg = 0.0;     // azimuth and elevation
  double point_m = 0.0;           // where on the segment: up and sideways
  double strength_percent = 0.0;  // of the momentum
};

/// Every combination of the axes' values.
struct RecipeMatrix {
  std::string name;                                                    // pattern: "{hit}_{from}"
  RecipeSettings settings;                                             // the same in all of its reactions
  std::vector<std::pair<std::string, std::vector<RecipeValue>>> axes;  // the first varies slowest
  std::vector<std::size_t> characters;                                 // of the recipe's
  std::vector<OutputKind> outputs;
  int variations = 1;
  Jitter jitter;
};

struct RecipeCharacter {
  std::string name;     // its folder in the output
  std::string written;  // as the recipe names it: "mannequin", or the file relative to the recipe's folder
  std::string file;     // "mannequin", or the path of the file
  RecipeSettings settings;
  /// The range of motion with the recipe's own joints in it.
  std::function<Result<RangeOfMotion>(RangeOfMotion)> limits;
};

struct Recipe {
  std::string file;
  std::uint64_t seed = 0;
  std::vector<RecipeCharacter> characters;
  RecipeSettings settings;
  std::vector<RecipeMatrix> matrices;  // in the order of the file; a [[reaction]] is one without axes
};

/// Errors: usage, with line and column (TOML syntax, unknown key, wrong type, value that is not legal, a
/// pattern that names nothing); input (cannot be read).
Result<Recipe> load_recipe(const std::filesystem::path& file);
/// `file` names the recipe in errors; what the text names is looked for beside it.
Result<Recipe> parse_recipe(std::string_view toml, const std::filesystem::path& file);

/// One reaction to bake.
struct Reaction {
  std::string name;                            // unique among its character's; also of its files and its clip
  std::size_t character;                       // of the recipe's
  int variation = 0;                           // of its matrix's, from 0
  std::uint64_t seed = 0;                      // of its jitter
  bool varies = false;                         // another seed gives another motion
  std::map<std::string, std::string> written;  // settings as the recipe has them, without jitter
  BakeSettings settings;  // outputs, sheet and report are named relative to the batch's folder
};

/// Takes that were rejected of each reaction: {character's name, reaction's name}.
using Takes = std::map<std::pair<std::string, std::string>, int>;

/// What the recipe describes, character by character. Override order: the program's defaults, the recipe's
/// [settings], the character's, those of the matrix or reaction, the values of its axes. A reaction's seed is
/// the recipe's and one more for each rejected take. Errors: usage (too many, a value that is not legal),
/// input (range of motion).
Result<std::vector<Reaction>> reactions_of(const Recipe& recipe, const Takes& takes);

/// A commented recipe with every key and every setting, itself a valid recipe, also when its lines that begin
/// with a single "# " are put to work. Lines that begin with "##" explain.
std::string recipe_reference();

}  // namespace ukemi
