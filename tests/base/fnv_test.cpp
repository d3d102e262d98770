#include "base/fnv.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

std::uint64_t hash_of(std::string_view text) {
  Fnv hash;
  hash.add(text);
  return hash.value();
}

TEST(Fnv, GivesTheValuesThatItsAuthorsPublish) {
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325u);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8u);
}

TEST(Fnv, PartsGiveWhatTheWholeGives) {
  Fnv parts;
  parts.add("foo");
  parts.add("bar");
  EXPECT_EQ(parts.value(), hash_of("foobar"));
}

}  // namespace
}  // namespace ukemi
