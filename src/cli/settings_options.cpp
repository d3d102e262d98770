#include "cli/settings_options.h"

#include <fmt/format.h>

#include "prepare/setting_table.h"

namespace ukemi {
namespace {

/// The help line of a setting, with its default and its legal values.
template <typename Target>
std::string help_of(const SettingOf<Target>& setting, const Target& target) {
  const std::vector<std::string> values = setting.get(target);
  std::vector<std::string> notes;
  if (!values.empty())
    notes.push_back("default " + values.front());
  else if (!setting.unset.empty())
    notes.push_back("default: " + setting.unset);
  if (setting.kind == SettingOf<Target>::Kind::number) notes.push_back(setting.range.text());
  return notes.empty() ? setting.help : fmt::format("{} [{}]", setting.help, fmt::join(notes, "; "));
}

/// "--pre-roll,--lead"
template <typename Target>
std::string names_of(const SettingOf<Target>& setting) {
  std::string names;
  for (const std::string_view word : setting.also) names += fmt::format("--{},", word);
  return names + fmt::format("--{}", setting.name);
}

template <typename Target>
void declare(Options& options, const SettingOf<Target>& setting, Target& target) {
  using Kind = typename SettingOf<Target>::Kind;
  const auto take = [&setting, &target](const std::string& text) { return setting.set(target, text); };
  const std::string option = names_of(setting);
  if (setting.kind != Kind::on_off)
    return options.custom(option, setting.value, take, help_of(setting, target), setting.kind == Kind::list,
                          setting.bare);
  const auto turn = [&setting, &target](bool on) {  // both words are legal
    static_cast<void>(setting.set(target, on ? "true" : "false"));
  };
  if (setting.get(target).front() == "true")
    options.on_off(std::string(setting.name), true, turn, setting.help, setting.opposite);
  else
    options.flag(
        option, [turn] { turn(true); }, setting.help);
}

}  // namespace

void declare_humanoid_options(Options& options, HumanoidOptions& target) {
  for (const HumanoidSetting& setting : humanoid_settings()) declare(options, setting, target);
}

void declare_bake_options(Options& options, BakeSettings& target) {
  for (const Setting& setting : bake_settings()) {
    options.group(std::string(setting.group));
    options.everyday(setting.everyday);
    declare(options, setting, target);
  }
  options.everyday(true);
}

}  // namespace ukemi
