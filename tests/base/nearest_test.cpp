#include "base/nearest.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Nearest, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("haed", "head"), 1) << "a swap of neighbours is one edit";
}

TEST(Nearest, FindsTheTypoAndNothingForNonsense) {
  const std::vector<std::string> known = {"bake", "inspect", "render", "diff"};
  EXPECT_EQ(nearest_word("bkae", known), "bake");
  EXPECT_EQ(nearest_word("INSPCET", known), "inspect");
  EXPECT_EQ(nearest_word("qqqqqqqq", known), "");
  EXPECT_EQ(suggestion("dif", known), "did you mean 'diff'?");
  EXPECT_EQ(suggestion("qqqqqqqq", known), "choose one of: bake inspect render diff");
}

}  // namespace
}  // namespace ukemi
