#include "batch/input_faults.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include "base/character_path.h"
#include "load/load.h"
#include "prepare/prepared.h"

namespace ukemi {
namespace {

// Settings that a character may not fit, whatever hits it.
constexpr std::array<std::string_view, 10> kOfCharacter = {"map",  "root", "unit", "up", "height",
                                                           "mass", "pose", "clip", "at", "get-up-clip"};

/// Reactions that fail alike where they fail.
std::string key_of(const Reaction& reaction) {
  std::string key;
  for (const std::string_view setting : kOfCharacter)
    if (const auto value = reaction.written.find(std::string(setting)); value != reaction.written.end())
      key += std::string(setting) + "=" + value->second + "\n";
  return key;
}

class FaultFinder {
 public:
  explicit FaultFinder(const BatchPlan& plan) : plan_(plan) {}

  void look_at(const Reaction& reaction) {
    if (character_ != reaction.character) start(reaction.character);
    const std::string key = character_error_ ? std::string() : key_of(reaction);
    auto known = fault_of_.find(key);
    if (known == fault_of_.end()) known = fault_of_.emplace(key, error_of(reaction)).first;
    if (known->second) add(*known->second);
  }

  std::vector<InputFault> faults;

 private:
  void start(std::size_t character) {
    character_ = character;
    fault_of_.clear();
    loaded_.reset();
    character_error_.reset();
    first_fault_ = faults.size();
    const auto path = character_path(plan_.recipe.characters[character].file);
    Diagnostics said;
    auto loaded = path ? load_character(*path, LoadOptions{}, said) : Result<Character>(path.error());
    if (loaded)
      loaded_ = std::move(*loaded);
    else
      character_error_ = loaded.error();
  }

  std::optional<Error> error_of(const Reaction& reaction) const {
    if (character_error_) return character_error_;
    Diagnostics said;
    const auto prepared = prepare_bake(*loaded_, reaction.settings, said);
    return prepared ? std::nullopt : std::optional(prepared.error());
  }

  void add(const Error& error) {
    const auto same =
        std::find_if(faults.begin() + static_cast<std::ptrdiff_t>(first_fault_), faults.end(),
                     [&](const InputFault& fault) { return fault.error.message() == error.message(); });
    if (same != faults.end())
      ++same->reactions;
    else
      faults.push_back({plan_.recipe.characters[*character_].name, error, 1});
  }

  const BatchPlan& plan_;
  std::optional<std::size_t> character_;
  std::optional<Character> loaded_;
  std::optional<Error> character_error_;
  std::map<std::string, std::optional<Error>> fault_of_;  // of the character
  std::size_t first_fault_ = 0;                           // of the character
};

}  // namespace

std::vector<InputFault> input_faults(const BatchPlan& plan) {
  FaultFinder finder(plan);
  for (std::size_t i = 0; i < plan.reactions.size(); ++i)
    if (plan.planned[i].plan == Plan::bake) finder.look_at(plan.reactions[i]);
  return std::move(finder.faults);
}

}  // namespace ukemi
