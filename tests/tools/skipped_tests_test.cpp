// tools/skipped_tests: skips are counted with their reasons, and one that nobody listed fails a strict run.
#include <gtest/gtest.h>

#include "support/command.h"
#include "tools/folder.h"

namespace ukemi {
namespace {

constexpr const char* kPassed =
    "1/3 Testing: base.A.Passes\n1/3 Test: base.A.Passes\nOutput:\n[ RUN      ] A.Passes\n"
    "[       OK ] A.Passes (0 ms)\n";
constexpr const char* kListed =
    "2/3 Testing: load.B.NeedsData\nOutput:\n[ RUN      ] B.NeedsData\n"
    "tests/load/b_test.cpp:7: Skipped\nUKEMI_EXTRA_DATA names no folder\n\n"
    "[  SKIPPED ] B.NeedsData (0 ms)\n[  SKIPPED ] 1 test, listed below:\n[  SKIPPED ] B.NeedsData\n";
constexpr const char* kUnlisted =
    "3/3 Testing: cli.All/C.NeedsATool/x\nOutput:\n[ RUN      ] All/C.NeedsATool/x\n"
    "tests/cli/c_test.cpp:9: Skipped\nthe tool is not installed\n\n"
    "[  SKIPPED ] All/C.NeedsATool/x, where GetParam() = 4 bytes (0 ms)\n";

std::pair<std::string, int> skipped_in(const std::string& log, const std::string& arguments = "") {
  const test::Folder folder;
  return run_command("'" UKEMI_TOOLS_FOLDER "/skipped_tests' '" + folder.write("LastTest.log", log) + "' " +
                     arguments);
}

class SkippedTests : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run_command("python3 --version").second != 0) GTEST_SKIP() << "left out: python3 is not installed";
  }
};

TEST_F(SkippedTests, AreCountedWithTheirReasons) {
  const auto [said, status] = skipped_in(std::string(kPassed) + kListed + kUnlisted);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(said,
            "tests skipped: 2\n  UKEMI_EXTRA_DATA names no folder: B.NeedsData\n"
            "  the tool is not installed: All/C.NeedsATool/x\n");
  EXPECT_EQ(skipped_in(kPassed).first, "tests skipped: 0\n");
}

TEST_F(SkippedTests, MustBeListedInAStrictRun) {
  EXPECT_EQ(skipped_in(std::string(kPassed) + kListed, "--strict").second, 0);
  const auto [said, status] = skipped_in(std::string(kListed) + kUnlisted, "--strict");
  EXPECT_EQ(status, 1);
  EXPECT_NE(said.find("tests/skips.txt: All/C.NeedsATool/x\n"), std::string::npos) << said;
  EXPECT_EQ(skipped_in(kUnlisted, "--strict --allow 'tool is not'").second, 0);
}

TEST_F(SkippedTests, WithoutALogAreAMistakeOfTheCommandLine) {
  EXPECT_EQ(run_command("'" UKEMI_TOOLS_FOLDER "/skipped_tests' /no/such/log").second, 2);
  EXPECT_EQ(run_command("'" UKEMI_TOOLS_FOLDER "/skipped_tests'").second, 2);
  EXPECT_EQ(run_command("'" UKEMI_TOOLS_FOLDER "/skipped_tests' --help").second, 0);
}

}  // namespace
}  // namespace ukemi
