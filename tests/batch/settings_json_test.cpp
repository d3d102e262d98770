#include "batch/settings_json.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "prepare/impact.h"
#include "prepare/setting_table.h"
#include "base/version.h"

namespace ukemi {
namespace {

/// What settings_json() says, by name.
std::map<std::string, nlohmann::json> described() {
  std::map<std::string, nlohmann::json> all;
  const auto text = settings_json();
  EXPECT_TRUE(text);
  const auto json = nlohmann::json::parse(*text);
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["generator"], generator());
  for (const auto& setting : json["settings"]) all[setting["name"]] = setting;
  return all;
}

TEST(SettingsAsData, AreAllOfThemWithUnitsRangesAndChoices) {
  const auto all = described();
  EXPECT_EQ(all.size(), bake_settings().size());
  for (const Setting& setting : bake_settings()) {
    const auto& told = all.at(std::string(setting.name));
    SCOPED_TRACE(told.dump());
    const bool number = setting.kind == Setting::Kind::number;
    EXPECT_EQ(told["unit"].is_string(), number);
    EXPECT_EQ(told["range"].is_object(), number);
    EXPECT_EQ(told["type"] == "number", number);
    EXPECT_TRUE(told["type"] != "choice" || told["choices"].size() >= 2);
    EXPECT_FALSE(told["help"].get<std::string>().empty());
    EXPECT_EQ(told["also"].size(), setting.also.size());
  }
}

TEST(SettingsAsData, HaveTheDefaultsInTheirOwnTypes) {
  const auto all = described();
  const BakeSettings defaults;
  EXPECT_EQ(all.at("hit")["default"], std::string(name(defaults.hit)));
  EXPECT_TRUE(all.at("duration")["default"].is_null());
  EXPECT_EQ(all.at("until-rest")["default"], defaults.until_rest);
  EXPECT_EQ(all.at("map")["default"], nlohmann::json::array());
  EXPECT_EQ(all.at("mass")["default"], nullptr);
  EXPECT_NE(all.at("mass")["unset"], nullptr);
}

TEST(SettingsAsData, CallAChoiceWhatTakesNothingButItsWords) {
  for (const auto& [name, told] : described()) {
    if (told["type"] != "choice") continue;
    BakeSettings settings;
    const Setting* setting = *find_setting(name);
    EXPECT_FALSE(setting->set(settings, "0")) << name;
    EXPECT_FALSE(setting->set(settings, "no-such-word")) << name;
  }
}

TEST(SettingsAsData, OfferOnlyWhatIsLegal) {
  const auto all = described();
  int offered = 0;
  for (const Setting& setting : bake_settings()) {
    for (const auto& choice : all.at(std::string(setting.name))["choices"]) {
      BakeSettings settings;
      EXPECT_TRUE(setting.set(settings, choice)) << setting.name << " " << choice;
      ++offered;
    }
  }
  EXPECT_GT(offered, 40);
  EXPECT_EQ(all.at("hit")["choices"].size(), static_cast<std::size_t>(kSegmentCount));
  EXPECT_EQ(all.at("preset")["choices"].size(), load_presets()->size());
}

}  // namespace
}  // namespace ukemi
