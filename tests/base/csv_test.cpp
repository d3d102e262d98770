#include "base/csv.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Csv, QuotesWhatWouldEndAFieldAndDisarmsFormulas) {
  EXPECT_EQ(csv_text("plain text"), "plain text");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_text("=1+1"), "'=1+1");
  EXPECT_EQ(csv_text("-x,y"), "\"'-x,y\"");
  EXPECT_EQ(csv_text(""), "");
}

}  // namespace
}  // namespace ukemi
