// From a recipe to its reactions: the matrices multiplied out, names, variations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/digest.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/random.h"
#include "batch/recipe.h"
#include "prepare/direction.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostReactions = 100000;  // 1 GB

void override_with(RecipeSettings& settings, const RecipeSettings& more) {
  for (const auto& [name, value] : more) settings[name] = value;
}

Error at(const Recipe& recipe, const RecipeValue& value, Error error) {
  error.file = recipe.file;
  error.line = value.line;
  error.column = value.column;
  return error;
}

/// In the order of the table of settings.
Result<BakeSettings> applied(const Recipe& recipe, const RecipeSettings& given) {
  BakeSettings settings;
  for (const Setting& setting : bake_settings()) {
    const auto value = given.find(std::string(setting.name));
    if (value == given.end()) continue;
    for (const std::string& text : value->second.texts)
      if (const Status status = setting.set(settings, text); !status)
        return at(recipe, value->second, status.error());
  }
  return settings;
}

/// The value in force of every setting that has one.
std::map<std::string, std::string> values_in_force(const BakeSettings& settings) {
  std::map<std::string, std::string> values;
  for (const Setting& setting : bake_settings()) {
    const std::vector<std::string> texts = setting.get(settings);
    if (!texts.empty()) values[std::string(setting.name)] = fmt::format("{}", fmt::join(texts, ","));
  }
  return values;
}

/// The same values under every word that a setting goes by.
std::map<std::string, std::string> with_other_words(std::map<std::string, std::string> values) {
  for (const Setting& setting : bake_settings()) {
    const auto value = values.find(std::string(setting.name));
    if (value == values.end()) continue;
    for (const std::string_view word : setting.also) values[std::string(word)] = value->second;
  }
  return values;
}

/// A file's name says enough.
std::string short_value(const std::string& value) {
  return value.find('/') == value.npos ? value : fs::path(value).stem().string();
}

std::string named(const std::string& pattern, const std::map<std::string, std::string>& values) {
  std::string name;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const std::size_t close = pattern[i] == '{' ? pattern.find('}', i) : pattern.npos;
    if (close == pattern.npos) {
      name += pattern[i];
      continue;
    }
    const auto value = values.find(pattern.substr(i + 1, close - i - 1));
    if (value != values.end()) name += short_value(value->second);
    i = close;
  }
  return file_name_from(name);
}

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

/// The same for every character, so that variation 2 (say) is the same blow for all of them.
Random random_of(const Reaction& reaction) {
  const std::string digest = digest_of(fmt::format("{}\n{}", reaction.name, reaction.seed));
  return Random(std::stoull(digest.substr(0, 16), nullptr, 16));
}

/// Values as people would write them: hundredths of a degree, tenths of a millimetre.
void vary(const Jitter& jitter, Reaction& reaction) {
  Random random = random_of(reaction);
  const auto within = [&random](double size) { return random.uniform(-size, size); };
  BakeSettings& settings = reaction.settings;
  const double turn = within(jitter.direction_deg), lift = within(jitter.direction_deg);
  const double up = within(jitter.point_m), left = within(jitter.point_m);
  const double stronger = within(0.01 * jitter.strength_percent);
  if (jitter.direction_deg > 0.0) {
    const Direction& from = settings.from;
    const double azimuth = std::remainder(degrees(from.azimuth) + turn, 360.0);
    const double elevation = std::clamp(degrees(from.elevation) + lift, -90.0, 90.0);
    settings.from = *parse_direction(fmt::format("{:.2f},{:.2f}", azimuth, elevation));
  }
  if (jitter.point_m > 0.0) {
    settings.aim_up_m += rounded(up, 1e-4);
    settings.aim_left_m += rounded(left, 1e-4);
  }
  if (jitter.strength_percent > 0.0) settings.strength *= 1.0 + rounded(stronger, 1e-4);
  const bool varies = behaviour_settings(settings).kind != Behaviour::limp || gets_up_after_s(settings);
  if (settings.seed == 0.0 && varies) settings.seed = static_cast<double>(random.next() >> 32);
}

bool has_any(const Jitter& jitter) {
  return jitter.direction_deg > 0.0 || jitter.point_m > 0.0 || jitter.strength_percent > 0.0;
}

/// Combination number `i` of the axes' values, the last axis fastest.
RecipeSettings combination(const RecipeMatrix& matrix, std::size_t i) {
  RecipeSettings settings;
  for (auto axis = matrix.axes.rbegin(); axis != matrix.axes.rend(); ++axis) {
    settings[axis->first] = axis->second[i % axis->second.size()];
    i /= axis->second.size();
  }
  return settings;
}

std::size_t combinations(const RecipeMatrix& matrix) {
  std::size_t count = 1;
  for (const auto& axis : matrix.axes) count *= axis.second.size();
  return count;
}

/// As a floating-point number: many axes multiply to more than any integer holds.
double reaction_count(const Recipe& recipe) {
  double count = 0.0;
  for (const RecipeMatrix& matrix : recipe.matrices) {
    double of_matrix = static_cast<double>(matrix.characters.size()) * matrix.variations;
    for (const auto& axis : matrix.axes) of_matrix *= static_cast<double>(axis.second.size());
    count += of_matrix;
  }
  return count;
}

/// Every matrix for one character.
class Expansion {
 public:
  Expansion(const Recipe& recipe, const Takes& takes, std::vector<Reaction>& reactions)
      : recipe_(recipe), takes_(takes), reactions_(reactions) {}

  Status expand(std::size_t character) {
    character_ = character;
    names_ = {};
    for (const RecipeMatrix& matrix : recipe_.matrices) {
      const auto& chosen = matrix.characters;
      if (std::find(chosen.begin(), chosen.end(), character) == chosen.end()) continue;
      for (std::size_t i = 0; i < combinations(matrix); ++i)
        if (const Status status = expand(matrix, combination(matrix, i)); !status) return status;
    }
    return Done{};
  }

 private:
  Status expand(const RecipeMatrix& matrix, const RecipeSettings& values) {
    const RecipeCharacter& character = recipe_.characters[character_];
    RecipeSettings given = recipe_.settings;
    override_with(given, character.settings);
    override_with(given, matrix.settings);
    override_with(given, values);
    auto settings = applied(recipe_, given);
    if (!settings) return settings.error();
    if (character.limits) {
      auto range = range_of(character, settings->region);
      if (!range) return range.error();
      settings->range = std::move(*range);
    }
    for (int variation = 0; variation < matrix.variations; ++variation)
      reactions_.push_back(reaction_of(matrix, *settings, variation));
    return Done{};
  }

  Reaction reaction_of(const RecipeMatrix& matrix, const BakeSettings& settings, int variation) {
    const std::string& folder = recipe_.characters[character_].name;
    Reaction reaction;
    reaction.character = character_;
    reaction.variation = variation;
    reaction.varies = has_any(matrix.jitter);
    reaction.settings = settings;
    reaction.written = values_in_force(settings);
    auto parts = with_other_words(reaction.written);
    const auto digits = fmt::format("{}", matrix.variations - 1).size();
    parts["variation"] = fmt::format("{:0{}}", variation, digits);
    parts["character"] = folder;
    reaction.name = names_.take(named(matrix.name, parts));
    const auto take = takes_.find({folder, reaction.name});
    reaction.seed = recipe_.seed + static_cast<std::uint64_t>(take == takes_.end() ? 0 : take->second);
    if (reaction.varies) vary(matrix.jitter, reaction);
    reaction.settings.reaction = reaction.name;
    for (const OutputKind kind : matrix.outputs) {
      const fs::path file = fs::path(folder) / (reaction.name + std::string(extension(kind)));
      if (kind == OutputKind::sheet)
        reaction.settings.sheet = file;
      else if (kind == OutputKind::report)
        reaction.settings.report = file;
      else if (kind == OutputKind::events)
        reaction.settings.events = file;
      else
        reaction.settings.outputs.push_back(file);
    }
    return reaction;
  }

  Result<RangeOfMotion> range_of(const RecipeCharacter& character, const std::string& region) {
    const auto key = std::pair(character.name, region);
    if (const auto known = ranges_.find(key); known != ranges_.end()) return known->second;
    auto range = load_range_of_motion(region);
    if (!range) return range.error();
    auto changed = character.limits(std::move(*range));
    if (changed) ranges_.emplace(key, *changed);
    return changed;
  }

  const Recipe& recipe_;
  const Takes& takes_;
  std::vector<Reaction>& reactions_;
  std::size_t character_ = 0;
  UniqueNames names_;
  std::map<std::pair<std::string, std::string>, RangeOfMotion> ranges_;
};

}  // namespace

Result<std::vector<Reaction>> reactions_of(const Recipe& recipe, const Takes& takes) {
  if (const double count = reaction_count(recipe); count > static_cast<double>(kMostReactions))
    return usage_error(recipe.file,
                       fmt::format("describes {:.7g} reactions; the limit is {}", count, kMostReactions),
                       "split it into several recipes");
  std::vector<Reaction> reactions;
  Expansion expansion(recipe, takes, reactions);
  for (std::size_t i = 0; i < recipe.characters.size(); ++i)
    if (const Status status = expansion.expand(i); !status) return status.error();
  return reactions;
}

}  // namespace ukemi
