// Who reads a report looks where the writer puts things.
#include "bake/report_keys.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>

#include "bake/bake.h"
#include "bake/record.h"
#include "bake/report.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

class ReportKeys : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    BakeSettings settings;
    settings.simulation.duration_s = 0.3;
    settings.report = testing::TempDir() + "report_keys.json";
    Diagnostics diagnostics;
    const auto baked = bake_file("mannequin", settings, diagnostics);
    ASSERT_TRUE(baked) << baked.error().message();
    report = Json::parse(baked->report);
    figures = figures_of(*baked);
  }
  void expect_written(std::span<const ReportKey> keys) {
    for (const ReportKey& place : keys) {
      ASSERT_TRUE(report.contains(place.section)) << place.section;
      EXPECT_TRUE(report[place.section].contains(place.key)) << place.section << "." << place.key;
    }
  }
  static Json report;
  static ReactionFigures figures;
};
Json ReportKeys::report;
ReactionFigures ReportKeys::figures;

TEST_F(ReportKeys, ThatReadersLookForAreWritten) {
  expect_written(kReportSettings);
  expect_written(kReportFigures);
}

TEST_F(ReportKeys, AManifestUsesTheSameNamesForTheSameFigures) {
  std::set<std::string> shown;
  for (const ReportKey& place : kReportFigures) shown.insert(place.shown);
  int found = 0;
  for_each_figure(figures, [&](const std::string& key, const auto&) {
    if (key == "travel_m") return;  // of the library's row
    EXPECT_TRUE(shown.contains(key)) << key;
    ++found;
  });
  EXPECT_GE(found, 10);
}

}  // namespace
}  // namespace ukemi
