#include "base/base64.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

std::vector<std::uint8_t> bytes(std::string_view text) { return {text.begin(), text.end()}; }

/// Texts of RFC 4648, section 10.
constexpr std::pair<std::string_view, std::string_view> kPairs[] = {{"", ""},
                                                                    {"f", "Zg=="},
                                                                    {"fo", "Zm8="},
                                                                    {"foo", "Zm9v"},
                                                                    {"foob", "Zm9vYg=="},
                                                                    {"fooba", "Zm9vYmE="},
                                                                    {"foobar", "Zm9vYmFy"}};

TEST(Base64, WritesAndReadsTheTextsOfItsStandard) {
  for (const auto& [plain, text] : kPairs) {
    EXPECT_EQ(base64(bytes(plain)), text);
    const Base64Bytes decoded = base64_decoded(text);
    EXPECT_TRUE(decoded.whole()) << text;
    EXPECT_EQ(decoded.bytes, bytes(plain)) << text;
  }
}

TEST(Base64, ReadsTheUrlSafeAlphabetAndTextWithoutPadding) {
  EXPECT_EQ(base64_decoded("+/+/").bytes, base64_decoded("-_-_").bytes);
  EXPECT_EQ(base64_decoded("Zm8").bytes, bytes("fo"));
}

TEST(Base64, SaysWhereTextIsNone) {
  EXPECT_EQ(base64_decoded("Zm*v").bad_at, 2u);
  EXPECT_FALSE(base64_decoded("Zm*v").whole());
  EXPECT_TRUE(base64_decoded("Zm9vY").cut_off);
  EXPECT_FALSE(base64_decoded("Zm9vY").whole());
}

}  // namespace
}  // namespace ukemi
