// The review command, as a user runs it.
#include <filesystem>

#include "program.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Reviewing = Program;

TEST_F(Reviewing, OfAFolderOfBakes) {
  ASSERT_EQ(run({"bake", "mannequin", "--hit", "head", "-o", "a.glb", "--report", "a.json"}).status, 0);
  const Ran result = run({"review", "."});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "1 reaction, 1 clip, 1 character\nwrote index.html\n");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.glb", "a.json", "index.html", "review"}));
  EXPECT_NE(read("index.html").find("review/review.js"), std::string::npos);
  EXPECT_EQ(run({"review", ".", "--quiet", "-j", "1"}).out, "");
}

TEST_F(Reviewing, RefusesWhatHasNoReactions) {
  expect_refused({"review"}, 2, "DIR is missing");
  expect_refused({"review", "nowhere"}, 2, "nowhere: there is no such folder");
  expect_refused({"review", "."}, 2, "holds no manifest.json");
  expect_refused({"review", ".", "-j", "0"}, 2, "--jobs");
  write("index.html", "mine");
  write("a.bvh", "HIERARCHY");
  expect_refused({"review", "."}, 4, "is not a page of this program");
}

}  // namespace
}  // namespace ukemi
