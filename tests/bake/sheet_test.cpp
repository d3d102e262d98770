#include "bake/sheet.h"

#include "bake/bake.h"

#include <gtest/gtest.h>

#include "base/character_path.h"
#include "load/load.h"

namespace ukemi {
namespace {

TEST(BakePictures, thumbnail_of_a_bake_is_a_small_webp) {
  Diagnostics diagnostics;
  const auto path = character_path("mannequin");
  ASSERT_TRUE(path);
  const auto character = load_character(*path, LoadOptions{}, diagnostics);
  ASSERT_TRUE(character);
  BakeSettings settings;
  settings.simulation.duration_s = 0.5;
  const auto outcome = bake(*character, settings, diagnostics);
  ASSERT_TRUE(outcome) << outcome.error().message();
  const auto thumbnail = bake_thumbnail(*character, settings, *outcome);
  ASSERT_TRUE(thumbnail) << thumbnail.error().message();
  EXPECT_EQ(std::string(thumbnail->begin() + 8, thumbnail->begin() + 12), "WEBP");
  EXPECT_GT(thumbnail->size(), 1000u);
  EXPECT_LT(thumbnail->size(), 12000u);
}

}  // namespace
}  // namespace ukemi
