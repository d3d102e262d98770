#include "base/uri.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Uri, EscapesAreReadAndMalformedOnesStandForThemselves) {
  EXPECT_EQ(percent_decoded("a%20b%2Fc%c3%A9"), "a b/c\xC3\xA9");
  EXPECT_EQ(percent_decoded("100%"), "100%");
  EXPECT_EQ(percent_decoded("5%2"), "5%2");
  EXPECT_EQ(percent_decoded("%zz%-1"), "%zz%-1");
}

}  // namespace
}  // namespace ukemi
