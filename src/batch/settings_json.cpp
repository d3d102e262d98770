#include "batch/settings_json.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "bake/bake.h"
#include "base/or_null.h"
#include "base/segments.h"
#include "base/version.h"
#include "prepare/impact.h"
#include "prepare/setting_table.h"
#include "prepare/settings.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

/// How the help's placeholders of numbers are written as units.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kUnits = {{{"KG", "kg"},
                                                                                   {"M_S", "m/s"},
                                                                                   {"M", "m"},
                                                                                   {"MM", "mm"},
                                                                                   {"DEG", "deg"},
                                                                                   {"S", "s"},
                                                                                   {"HZ", "Hz"},
                                                                                   {"1_S", "1/s"},
                                                                                   {"N", "1"},
                                                                                   {"TIMES", "1"},
                                                                                   {"0..1", "1"}}};

/// Settings that take only one of a list of words.
constexpr std::array<std::string_view, 3> kWordsOnly = {"hit", "preset", "scene"};

std::string_view type_of(const Setting& setting) {
  if (std::find(kWordsOnly.begin(), kWordsOnly.end(), setting.name) != kWordsOnly.end()) return "choice";
  switch (setting.kind) {
    case Setting::Kind::number:
      return "number";
    case Setting::Kind::choice:
      return "choice";
    case Setting::Kind::on_off:
      return "switch";
    case Setting::Kind::list:
      return "list";
    default:
      return "text";
  }
}

Json value_of(Setting::Kind kind, const std::string& text) {
  if (kind == Setting::Kind::on_off) return text == "true";
  const auto number = kind == Setting::Kind::number ? number_in(text) : std::nullopt;
  return number ? Json(*number) : Json(text);
}

Json default_of(const Setting& setting) {
  const std::vector<std::string> values = setting.get(BakeSettings());
  if (setting.kind == Setting::Kind::list) return Json(values);
  return values.empty() ? Json(nullptr) : value_of(setting.kind, values.front());
}

Json unit_of(const Setting& setting) {
  if (setting.kind != Setting::Kind::number) return nullptr;
  for (const auto& [placeholder, unit] : kUnits)
    if (setting.value == placeholder) return unit;
  return nullptr;
}

Json range_of(const Setting& setting) {
  if (setting.kind != Setting::Kind::number) return nullptr;
  return {{"min", setting.range.min}, {"max", setting.range.max}, {"above_min", setting.range.above_min}};
}

/// Words of the help's placeholder: those of "rest|stand|guard|FILE" in small letters.
std::vector<std::string> words_of(std::string_view placeholder) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= placeholder.size();) {
    const std::size_t end = std::min(placeholder.find('|', begin), placeholder.size());
    const std::string_view word = placeholder.substr(begin, end - begin);
    const bool small = std::all_of(word.begin(), word.end(), [](char c) { return c >= 'a' && c <= 'z'; });
    if (!word.empty() && small) words.emplace_back(word);
    begin = end + 1;
  }
  return words;
}

Result<std::vector<std::string>> choices_of(const Setting& setting) {
  std::vector<std::string> choices = setting.words;
  if (setting.kind == Setting::Kind::on_off) return std::vector<std::string>();
  if (setting.name == "from") return std::vector<std::string>{"front", "back", "left", "right", "above"};
  if (setting.name == "region") return std::vector<std::string>{"human", "diamond", "box"};
  if (setting.name == "hit") {
    for (int s = 0; s < kSegmentCount; ++s) choices.emplace_back(name(segment_at(s)));
  } else if (setting.name == "preset") {
    const auto presets = load_presets();
    if (!presets) return presets.error();
    for (const ImpactPreset& preset : *presets) choices.push_back(preset.name);
  } else if (setting.kind == Setting::Kind::text) {
    return words_of(setting.value);
  }
  return choices;
}

}  // namespace

Result<std::string> settings_json() {
  Json json = {{"format", 1}, {"generator", generator()}, {"settings", Json::array()}};
  for (const Setting& setting : bake_settings()) {
    const auto choices = choices_of(setting);
    if (!choices) return choices.error();
    json["settings"].push_back({{"name", setting.name},
                                {"also", Json(setting.also)},
                                {"group", setting.group},
                                {"type", type_of(setting)},
                                {"default", default_of(setting)},
                                {"unset", text_or_null<Json>(setting.unset)},
                                {"range", range_of(setting)},
                                {"choices", choices->empty() ? Json(nullptr) : Json(*choices)},
                                {"unit", unit_of(setting)},
                                {"value", text_or_null<Json>(setting.value)},
                                {"help", setting.help}});
  }
  return json.dump(2) + "\n";
}

}  // namespace ukemi
