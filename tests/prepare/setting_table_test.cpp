#include "prepare/setting_table.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>
#include <set>

#include "bake/bake.h"

namespace ukemi {
namespace {

/// A legal value that is not the default.
std::string another_value(const Setting& setting) {
  static const std::map<std::string_view, std::string> texts = {
      {"hit", "head"},           {"from", "30,10"},         {"preset", "kick"},    {"scene", "fall"},
      {"region", "diamond"},     {"active-file", "a.toml"}, {"rate", "fixed:480"}, {"map", "head=Head"},
      {"unit", "0.0254"},        {"root", "Hips"},          {"pose", "guard"},     {"clip", "walk"},
      {"get-up-clip", "getups"}, {"knockout-at", "0.3"}};
  const BakeSettings defaults;
  const auto values = setting.get(defaults);
  const std::string current = values.empty() ? "" : values.front();
  switch (setting.kind) {
    case Setting::Kind::number:
      return fmt::format("{}", current == "1" ? 2 : 1);
    case Setting::Kind::choice:
      return setting.words[setting.words[0] == current ? 1 : 0];
    case Setting::Kind::on_off:
      return current == "true" ? "false" : "true";
    default:
      return texts.count(setting.name) ? texts.at(setting.name) : "";
  }
}

TEST(Settings, ValuesGoInAndComeOutAgain) {
  for (const Setting& setting : bake_settings()) {
    BakeSettings settings;
    const std::string value = another_value(setting);
    ASSERT_FALSE(value.empty()) << setting.name;
    const Status status = setting.set(settings, value);
    ASSERT_TRUE(status) << setting.name << ": " << status.error().message();
    EXPECT_EQ(setting.get(settings), std::vector<std::string>{value}) << setting.name;
    EXPECT_NE(setting.get(BakeSettings()), std::vector<std::string>{value}) << setting.name;
    EXPECT_TRUE(check_values(settings));
  }
}

TEST(Settings, AreHeldInTheUnitsThatTheProgramWorksIn) {
  const auto held = [](const char* name, const char* value, const auto& access) {
    BakeSettings settings;
    EXPECT_TRUE((*find_setting(name))->set(settings, value)) << name;
    return static_cast<double>(access(settings));
  };
  EXPECT_DOUBLE_EQ(held("key-error-mm", "2", [](auto& s) { return s.keys.tolerance_m; }), 0.002);
  EXPECT_DOUBLE_EQ(held("bvh-unit", "cm", [](auto& s) { return *s.bvh_metres_per_unit; }), 0.01);
  EXPECT_DOUBLE_EQ(held("unit", "in", [](auto& s) { return *s.humanoid.metres_per_unit; }), 0.0254);
  EXPECT_DOUBLE_EQ(held("fps", "30", [](auto& s) { return s.simulation.fps; }), 30.0);
  EXPECT_DOUBLE_EQ(held("rate", "fixed:480", [](auto& s) { return s.simulation.fixed_hz; }), 480.0);
  EXPECT_DOUBLE_EQ(held("strength", "1.5", [](auto& s) { return s.strength; }), 1.5);
  EXPECT_DOUBLE_EQ(held("from", "30,10", [](auto& s) { return degrees(s.from.azimuth); }), 30.0);
  EXPECT_DOUBLE_EQ(BakeSettings().keys.tolerance_m, 0.0005);
}

TEST(Settings, AKnockoutIsATimeOrAMoment) {
  const auto setting = find_setting("knockout-at");
  ASSERT_TRUE(setting);
  BakeSettings settings;
  for (const char* word : {"blow", "step", "landing", "0.25"}) {
    ASSERT_TRUE((*setting)->set(settings, word)) << word;
    EXPECT_EQ((*setting)->get(settings), std::vector<std::string>{word});
  }
  for (const char* bad : {"-1", "61", "never", ""}) EXPECT_FALSE((*setting)->set(settings, bad)) << bad;
}

TEST(Settings, EachHasOneNameAndTheGroupsAreContiguous) {
  std::set<std::string_view> names, closed;
  std::string_view group;
  for (const Setting& setting : bake_settings()) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    for (const std::string_view word : setting.also) EXPECT_TRUE(names.insert(word).second) << word;
    EXPECT_FALSE(setting.help.empty()) << setting.name;
    if (setting.group == group) continue;
    EXPECT_TRUE(closed.insert(setting.group).second) << setting.group;
    group = setting.group;
  }
}

TEST(Settings, RefuseWhatIsNotLegalAndTellWhatIs) {
  BakeSettings settings;
  EXPECT_EQ((*find_setting("fps"))->set(settings, "0").error().what, "0 is out of range");
  EXPECT_EQ((*find_setting("keys"))->set(settings, "al").error().fix, "did you mean 'all'?");
  EXPECT_EQ((*find_setting("hit"))->set(settings, "haed").error().fix, "did you mean 'head'?");
  EXPECT_EQ(find_setting("fsp").error().fix, "did you mean 'fps'?");
}

TEST(Settings, GoByTheWordsOfArtistsAsWell) {
  EXPECT_EQ(*find_setting("pre-roll"), *find_setting("lead"));
  EXPECT_EQ(*find_setting("muscle-strength"), *find_setting("muscle"));
  EXPECT_EQ((*find_setting("recover"))->shown(), "return");
  EXPECT_EQ((*find_setting("fps"))->shown(), "fps");
  EXPECT_EQ(find_setting("pre-rol").error().fix, "did you mean 'pre-roll'?");
}

TEST(Settings, AValueThatALibraryUserPutsThereIsCheckedToo) {
  BakeSettings settings;
  settings.ball_mass_kg = -1.0;
  const Status status = check_values(settings);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "ball-mass: -1 is out of range");
}

}  // namespace
}  // namespace ukemi
