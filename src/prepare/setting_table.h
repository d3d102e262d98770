// Every setting of a bake, declared once. The command line, recipes, the printed reference and the digest of
// a reaction's inputs all read this table, so that a setting has one name, one check and one line of help.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/numbers.h"
#include "base/result.h"

namespace ukemi {

struct BakeSettings;
struct HumanoidOptions;

/// One setting of a `Target`.
template <typename Target>
struct SettingOf {
  enum class Kind {
    number,
    text,
    choice,  // one of `words`
    on_off,  // "true" or "false"
    list     // any number of texts
  };
  Kind kind = Kind::text;
  std::string_view group;              // heading in the help: hit, body, start, method, clip, out
  std::string_view name;               // "lead": in reports, manifests and digests
  std::vector<std::string_view> also;  // "pre-roll": taken like the name; the first is shown instead of it
  bool everyday = false;               // most people need it: in the short help
  std::string value;                   // placeholder: "KG", "SEGMENT", "y|z"
  std::string help;                    // what it does
  std::string opposite;                // on_off: what false does
  std::string unset;                   // default where `get` gives none: "found out"; may be empty
  std::string bare;                    // value where the command line names the setting alone; may be empty
  Range range;                         // number
  std::vector<std::string> words;      // choice
  /// Takes what the user wrote (a list: one entry at a time, added). Errors: usage; `what` does not name the
  /// setting.
  std::function<Status(Target&, const std::string&)> set;
  /// The value in force as `set` takes it, shortest form; nothing where the program finds it out.
  std::function<std::vector<std::string>(const Target&)> get;

  /// "pre-roll": --pre-roll on the command line, pre-roll = in a recipe.
  std::string_view shown() const { return also.empty() ? name : also.front(); }
};

using Setting = SettingOf<BakeSettings>;
using HumanoidSetting = SettingOf<HumanoidOptions>;

/// How a file's skeleton is read, the same for every command that reads one: map unit up height.
const std::vector<HumanoidSetting>& humanoid_settings();

/// All settings of a bake, in the order of the help; groups are contiguous.
const std::vector<Setting>& bake_settings();

/// The setting of that name or alias. Errors: usage, with the nearest name.
Result<const Setting*> find_setting(std::string_view name);

/// Whether every value in force is legal, however it came there. Errors: usage.
Status check_values(const BakeSettings& settings);

}  // namespace ukemi
