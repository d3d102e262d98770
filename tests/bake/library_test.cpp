// Names of the library's rows.
#include "bake/library.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace ukemi {
namespace {

TEST(Library, NameHoldsTheCharacterOnce) {
  EXPECT_EQ(library_name("hero", "head_left"), "hero_head_left");
  EXPECT_EQ(library_name("hero", "hero_head_left"), "hero_head_left");
  EXPECT_EQ(library_name("hero", "heroic_fall"), "hero_heroic_fall");
}

TEST(Library, NamesThatDifferByCaseAloneGetANumber) {
  const auto rows = nlohmann::json::parse(
      library_json({{R"({"Name": "Hero_head"})", ""}, {R"({"Name": "hero_head"})", ""}}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["Name"], "Hero_head");
  EXPECT_EQ(rows[1]["Name"], "hero_head_2");
}

}  // namespace
}  // namespace ukemi
