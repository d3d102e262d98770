#include "bones/map_file.h"

#include <gtest/gtest.h>

#include "check/inspect.h"

namespace ukemi {
namespace {

using Map = std::map<std::string, std::string>;

TEST(MapFile, IsATableOfSegmentsInTomlOrJson) {
  const Map expected{{"hand_l", "#41"}, {"head", "Skull"}};
  EXPECT_EQ(*parse_map("head = \"Skull\"\nhand_l = \"#41\"\n", "a.toml"), expected);
  EXPECT_EQ(*parse_map("[map]\nhead = \"Skull\"\nhand_l = \"#41\"\n", "a.toml"), expected);
  EXPECT_EQ(*parse_map(R"({"head": "Skull", "hand_l": "#41", "hand_r": null})", "a.json"), expected);
  EXPECT_EQ(*parse_map(R"( {"format": 1, "map": {"head": "Skull", "hand_l": "#41"}, "clips": []})", "a.json"),
            expected);
}

TEST(MapFile, RefusesWhatItDoesNotUnderstandWithThePlace) {
  const auto unknown = parse_map("[map]\nhaed = \"Skull\"\n", "a.toml");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().line, 2);
  EXPECT_EQ(unknown.error().fix, "did you mean 'head'?");
  EXPECT_EQ(parse_map("[map]\n\nhead = 12\n", "a.toml").error().line, 3);
  EXPECT_EQ(parse_map("head = \n", "a.toml").error().line, 1);
  EXPECT_EQ(parse_map(R"({"haed": "Skull"})", "a.json").error().fix, "did you mean 'head'?");
  EXPECT_EQ(parse_map(R"({"head": 12})", "a.json").error().what, "the node of 'head' is not a text");
  EXPECT_EQ(parse_map(R"({"head": )", "a.json").error().fix, "correct the JSON syntax");
  EXPECT_EQ(parse_map(R"({"map": {}})", "a.json").error().what, "names no segment");
  EXPECT_EQ(parse_map("", "a.toml").error().what, "names no segment");
}

TEST(MapFile, WhatInspectPrintsGivesTheSameMapAgain) {
  Diagnostics diagnostics;
  const auto found = inspect("mannequin", {}, diagnostics);
  ASSERT_TRUE(found);
  InspectSettings settings;
  settings.humanoid.map = *parse_map(inspection_json(*found, diagnostics), "map.json");
  EXPECT_EQ(settings.humanoid.map.size(), 18u);
  const auto again = inspect("mannequin", settings, diagnostics);
  ASSERT_TRUE(again);
  ASSERT_TRUE(again->humanoid);
  for (int s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(again->humanoid->segments[s].chain, found->humanoid->segments[s].chain) << name(segment_at(s));
    EXPECT_EQ(again->humanoid->segments[s].by, "user") << name(segment_at(s));
  }
}

}  // namespace
}  // namespace ukemi
