// tools/mutants without its builds: the list of planted faults, and what it says of lists that are wrong.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/command.h"
#include "tools/folder.h"

namespace ukemi {
namespace {

std::pair<std::string, int> mutants(const std::string& arguments) {
  return run_command("'" UKEMI_TOOLS_FOLDER "/mutants/run' " + arguments);
}

std::pair<std::string, int> check_list(const std::string& list) {
  const test::Folder folder;
  return mutants("--check --faults '" + folder.write("faults.tsv", list) + "'");
}

class Mutants : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run_command("python3 --version").second != 0) GTEST_SKIP() << "left out: python3 is not installed";
  }
};

TEST_F(Mutants, EveryFaultOfTheListAppliesOnceToTheSources) {
  const auto [said, status] = mutants("--check");
  EXPECT_EQ(status, 0) << said;
  EXPECT_NE(said.find(" faults, 0 of them stale\n"), std::string::npos) << said;
}

TEST_F(Mutants, AreAHundredOverEveryFolder) {
  const auto [said, status] = mutants("--list");
  EXPECT_EQ(status, 0) << said;
  EXPECT_GE(std::count(said.begin(), said.end(), '\n'), 100);
  for (const char* folder :
       {"base",   "load",  "bones",  "humanoid", "restrict", "body", "physics", "simulate",
        "behave", "rise",  "export", "fbx",      "render",   "clip", "judge",   "prepare",
        "bake",   "check", "study",  "batch",    "review",   "cli"})
    EXPECT_NE(said.find(std::string(" ") + folder + "/"), std::string::npos) << folder;
}

TEST_F(Mutants, AFaultThatNoLongerAppliesIsSaidWithTheReason) {
  const auto [said, status] = check_list(
      "gone-text\tbase/math.cpp\tno such text\tanother\t\n"
      "twice\tbase/math.cpp\treturn\tthrow\t\n"
      "gone-file\tbase/no_such_file.cpp\ta\tb\t\n"
      "good\tbase/math.cpp\t: 2.0 * v;\t: v;\n"
      "# a remark\n");
  EXPECT_EQ(status, 1);
  EXPECT_NE(said.find("found 0 times: no such text"), std::string::npos) << said;
  EXPECT_NE(said.find("stale     twice"), std::string::npos) << said;
  EXPECT_NE(said.find("the file is gone"), std::string::npos) << said;
}

TEST_F(Mutants, WhatIsNoListOfFaultsIsRefusedWithItsLine) {
  const auto [columns, columns_status] = check_list("\nname\tbase/math.cpp\ttext\n");
  EXPECT_EQ(columns_status, 2);
  EXPECT_NE(columns.find("faults.tsv:2: a fault is name, file, text, replacement, tests"), std::string::npos)
      << columns;
  const auto [twice, twice_status] = check_list("same\tbase/math.cpp\ta\tb\t\nsame\tbase/math.cpp\tc\td\t\n");
  EXPECT_EQ(twice_status, 2);
  EXPECT_NE(twice.find("faults.tsv:2: 'same' is the name of two faults"), std::string::npos) << twice;
  EXPECT_EQ(mutants("--jobs 0").second, 2);
  EXPECT_EQ(mutants("--only nothing_has_this_name").second, 2);
  EXPECT_EQ(mutants("--help").second, 0);
}

}  // namespace
}  // namespace ukemi
