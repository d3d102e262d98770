// The experiment as a whole program: table, JSON, folder, refusals.
#include <nlohmann/json.hpp>

#include "program.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;
using Compare = Program;

TEST_F(Compare, PrintsTheFiguresOfEveryMethodAsJson) {
  const Ran ran = run({"compare", "mannequin", "--hits", "1", "--seed", "7", "--duration", "0.3", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["character"], "mannequin");
  EXPECT_EQ(json["hits"], 1);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["region"], "human");
  ASSERT_GE(json["methods"].size(), 6u);
  for (const Json& method : json["methods"])
    for (const char* key : {"method", "limits", "active", "samples", "over_1deg", "excess_p999_deg",
                            "excess_max_deg", "worst_joint", "joint_separation_max_m", "energy_gain_max_j",
                            "exploded", "angular_momentum_mean_kg_m2_s", "airborne_mean_s", "us_per_step"})
      EXPECT_TRUE(method.contains(key)) << key;
  for (const Json& method : json["methods"]) {
    EXPECT_GE(method["samples"], 17 * 0.3 * 60) << method["method"];
    EXPECT_GT(method["us_per_step"], 0.0) << method["method"];
    EXPECT_GT(method["angular_momentum_mean_kg_m2_s"], 0.0) << method["method"];
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(Compare, WritesTableJsonAndPicturesIntoItsFolder) {
  const Ran ran = run({"compare", "mannequin", "--hits", "1", "--duration", "0.3", "-o", "out"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("b-euler"), std::string::npos);
  EXPECT_EQ(read("out/compare.txt"), ran.out);
  EXPECT_EQ(Json::parse(read("out/compare.json"))["seed"], 1);
  for (const char* name : {"compare", "hit", "a", "b", "c", "ours", "unnatural", "slope", "fall"})
    EXPECT_TRUE(read(std::string("out/") + name + ".png").starts_with("\x89PNG")) << name;
}

TEST_F(Compare, TakesTheRegionTheSeedAndTheTimeItIsTold) {
  const auto figures = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"compare", "mannequin", "--hits", "1", "--json"});
    const Ran ran = run(more);
    EXPECT_EQ(ran.status, 0) << ran.err;
    Json json = Json::parse(ran.out);
    for (Json& method : json["methods"])
      for (const char* time : {"us_per_step", "cpu_s_per_s"}) method.erase(time);
    return json;
  };
  const Json plain = figures({"--duration", "0.2"});
  EXPECT_EQ(figures({"--duration", "0.2"}), plain);
  EXPECT_GT(figures({"--duration", "0.4"})["methods"][0]["samples"],
            1.5 * plain["methods"][0]["samples"].get<double>());
  EXPECT_NE(figures({"--duration", "0.2", "--seed", "2"})["methods"], plain["methods"]);
  const Json box = figures({"--duration", "0.2", "--region", "box"});
  EXPECT_EQ(box["region"], "box");
  EXPECT_NE(box["methods"], plain["methods"]);
}

TEST_F(Compare, RefusesWhatMakesNoExperiment) {
  constexpr int kMustChange = 2;
  constexpr int kCannotWrite = 4;
  const auto refused = [this](std::vector<std::string> options, int status, const std::string& what) {
    options.insert(options.begin(), {"compare", "mannequin"});
    expect_refused(options, status, what);
  };
  for (const char* hits : {"0", "-3", "2.5", "many", "1000000"})
    refused({"--hits", hits}, kMustChange, "--hits: '" + std::string(hits) + "' is not a whole number");
  refused({"--seed", "-1"}, kMustChange, "--seed");
  refused({"--show", "4", "--hits", "3"}, kMustChange, "--show 4 is beyond the last hit");
  refused({"--duration", "0"}, kMustChange, "--duration");
  refused({"--hits", "1", "--region", "humna"}, kMustChange, "humna");
  refused({"--json", "--quiet"}, kMustChange, "exclude each other");
  refused({"--quiet"}, kMustChange, "nothing to write");
  refused({"-o", "missing/out"}, kCannotWrite, "there is no folder");
  expect_refused({"compare"}, kMustChange, "CHARACTER is missing");
  expect_refused({"compare", "none.glb"}, kMustChange, "none.glb");
}

}  // namespace
}  // namespace ukemi
