// tools/bench: the program on one short hit, and what it makes of costs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/table.h"
#include "support/command.h"
#include "tools/folder.h"

namespace ukemi {
namespace {

std::pair<std::string, int> bench(const std::string& arguments) {
  return run_command("'" UKEMI_BENCH "' " + arguments);
}

TEST(Bench, OneHitPrintsEveryRowAndColumnAndTheSameAsJson) {
  const test::Folder folder;
  const std::string file = folder.write("old.json", "");
  const auto [said, status] = bench("mannequin 1 --seconds 0.3 --json '" + file + "'");
  ASSERT_EQ(status, 0) << said;
  for (const char* column : {"ratio", "us/step", "rows", "contacts", "rejected", "over 1"})
    EXPECT_NE(said.find(column), std::string::npos) << column;
  for (const char* row : {"limp", "fixed:480"})
    EXPECT_NE(said.find(std::string("\n") + row + " "), std::string::npos) << row << "\n" << said;
  EXPECT_NE(said.find("Bullet"), std::string::npos) << "there or left out, it is said";
  const auto json = nlohmann::json::parse(std::ifstream(file));
  ASSERT_GE(json["samples"].size(), 7u);
  for (const auto& row : json["rows"]) {
    if (row["hits"] == 0) continue;
    EXPECT_GT(row["ratio"], 0.0) << row;
    EXPECT_GT(row["us_per_step"], 0.0) << row;
    if (row["row"] == "Bullet 1000") continue;
    EXPECT_GE(row["rows"], 51.0) << "three for each of 17 joints: " << row;
    EXPECT_GT(row["contacts"], 0.0) << row;
  }
  const auto [compared, compared_status] = bench("mannequin 1 --seconds 0.3 --compare '" + file + "'");
  EXPECT_EQ(compared_status, 0);
  EXPECT_NE(compared.find("each over its own fixed:480"), std::string::npos) << compared;
}

TEST(Bench, ABuildAgainstItselfMovesAlikeInEveryPair) {
  const auto [said, status] = bench("mannequin 1 --seconds 0.3 --against '" UKEMI_BENCH "'");
  ASSERT_EQ(status, 0) << said;
  const auto table = said.find("interleaved in one run");
  ASSERT_NE(table, std::string::npos) << said;
  std::istringstream lines(said.substr(table));
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("limp ") && !line.starts_with("fixed:480")) continue;
    ++rows;
    std::istringstream words(line);
    std::string name, pairs, ratio, interval, otherwise;
    words >> name >> pairs >> ratio >> interval >> otherwise;
    EXPECT_EQ(pairs, "1") << line;
    EXPECT_EQ(otherwise, "0") << line;
  }
  EXPECT_EQ(rows, 2) << said;
}

TEST(Bench, WhatCannotBeComparedIsSaid) {
  const test::Folder folder;
  const auto [other, other_status] = bench("mannequin 1 --seconds 0.3 --against /bin/true");
  EXPECT_EQ(other_status, 2);
  EXPECT_NE(other.find("'/bin/true' does not answer as a bench program"), std::string::npos) << other;
  const auto [file, file_status] =
      bench("mannequin 1 --seconds 0.3 --compare '" + folder.write("no.json", "{}") + "'");
  EXPECT_EQ(file_status, 2);
  EXPECT_NE(file.find("is not what a bench wrote with --json"), std::string::npos) << file;
}

TEST(Bench, RatiosHaveTheIntervalsOfTheirSpread) {
  const Ratio same = ratio_of_sums({1.0, 2.0, 3.0}, {2.0, 4.0, 6.0});
  EXPECT_NEAR(same.value, 0.5, 1e-12);
  EXPECT_NEAR(same.high - same.low, 0.0, 1e-12);
  // Residuals -1, 1 over a mean of 2: a spread of sqrt(2) / 2, an error of 1 / 2.
  const Ratio apart = ratio_of_sums({1.0, 3.0}, {2.0, 2.0});
  EXPECT_NEAR(apart.value, 1.0, 1e-12);
  EXPECT_NEAR(apart.high, 1.0 + 1.96 * 0.5, 1e-12);
  const Ratio mean = mean_ratio({1.0, 4.0}, {1.0, 1.0});
  EXPECT_EQ(mean.pairs, 2);
  EXPECT_NEAR(mean.value, 2.0, 1e-12);
  EXPECT_NEAR(std::log(mean.high / mean.value), 1.96 * std::log(2.0), 1e-12);
}

}  // namespace
}  // namespace ukemi
