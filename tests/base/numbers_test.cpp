#include "base/numbers.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(Numbers, AreWholeFiniteAndInRange) {
  constexpr Range range{1.0, 1000.0};
  EXPECT_DOUBLE_EQ(*parse_number("29.97", range), 29.97);
  EXPECT_DOUBLE_EQ(*parse_number("1e2", range), 100.0);
  for (const char* text : {"", "x", "12x", "0", "-5", "1001", "nan", "inf", "1e999", "1,5", " 5"}) {
    const auto value = parse_number(text, range);
    ASSERT_FALSE(value) << text;
    EXPECT_NE(value.error().fix.find("1 to 1000"), std::string::npos);
  }
  EXPECT_FALSE(parse_number("0", Range{0.0, 60.0, true}));
}

}  // namespace
}  // namespace ukemi
