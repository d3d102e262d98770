// What the program writes is what assets/schemas describe.
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "program.h"
#include "support/json_schema.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;
using test::JsonSchema;
using Words = std::vector<std::string>;

Words faults(const Json& schema, const Json& value) { return JsonSchema(schema).faults(value); }

Json schema(const std::string& format) {
  std::ifstream file(std::string(UKEMI_ASSETS_FOLDER) + "/schemas/" + format + ".schema.json");
  EXPECT_TRUE(file) << format;
  return Json::parse(file);
}

TEST(JsonSchema, TakesWhatIsDescribed) {
  const Json described = Json::parse(R"({"type": "object", "required": ["a"], "properties": {
      "a": {"$ref": "#/$defs/pair"}, "b": {"enum": ["x", null]}, "c": {"const": 1}},
      "additionalProperties": false, "$defs": {"pair": {"type": ["array", "null"], "minItems": 2,
      "maxItems": 2, "items": {"type": "number"}}}})");
  EXPECT_EQ(faults(described, Json::parse(R"({"a": [1, 2.5], "b": "x", "c": 1})")), Words{});
  EXPECT_EQ(faults(described, Json::parse(R"({"a": null, "b": null})")), Words{});
  EXPECT_EQ(faults(Json::parse(R"({"type": "integer"})"), 2.0), Words{});
}

TEST(JsonSchema, RefusesEachFaultByItsPlace) {
  const Json number = {{"type", "number"}};
  EXPECT_EQ(faults(number, "1"), Words{": is of the wrong type: \"1\""});
  EXPECT_EQ(faults({{"type", "integer"}}, 1.5), Words{": is of the wrong type: 1.5"});
  EXPECT_EQ(faults({{"type", {"string", "null"}}}, true), Words{": is of the wrong type: true"});
  EXPECT_EQ(faults({{"const", 1}}, 2), Words{": is not 1"});
  EXPECT_EQ(faults({{"enum", {"a", nullptr}}}, "b"), Words{": is none of the words: \"b\""});
  EXPECT_EQ(faults({{"required", {"a"}}}, Json::object()), Words{"/a: is missing"});
  EXPECT_EQ(faults({{"properties", {{"a", number}}}}, {{"a", nullptr}}),
            Words{"/a: is of the wrong type: null"});
  EXPECT_EQ(faults({{"additionalProperties", false}}, {{"b", 1}}), Words{"/b: is not described"});
  EXPECT_EQ(faults({{"additionalProperties", number}}, {{"b", "x"}}),
            Words{"/b: is of the wrong type: \"x\""});
  EXPECT_EQ(faults({{"propertyNames", {{"enum", {"a"}}}}}, {{"b", 1}}),
            Words{"/b: is none of the words: \"b\""});
  EXPECT_EQ(faults({{"minProperties", 1}}, Json::object()), Words{": has too few keys"});
  EXPECT_EQ(faults({{"items", number}}, {1, "x"}), Words{"/1: is of the wrong type: \"x\""});
  EXPECT_EQ(faults({{"minItems", 2}}, {1}), Words{": has too few items"});
  EXPECT_EQ(faults({{"maxItems", 0}}, {1}), Words{": has too many items"});
  EXPECT_EQ(faults({{"$ref", "#/$defs/a"}, {"$defs", {{"a", number}}}}, "x"),
            Words{": is of the wrong type: \"x\""});
  EXPECT_EQ(faults({{"pattern", "x"}}, "y"), Words{": the schema has the unknown keyword pattern"});
}

class Schema : public Program {
 protected:
  void expect_described(const std::string& format, const std::string& text) {
    SCOPED_TRACE(format + ": what is not described goes into assets/schemas");
    EXPECT_EQ(faults(schema(format), Json::parse(text)), Words{});
  }
  /// What the command says on stdout.
  Json said(const std::string& format, const Words& arguments, int status = 0) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, status) << ran.err;
    expect_described(format, ran.out);
    return Json::parse(ran.out);
  }
};

TEST_F(Schema, ReportsOfEveryKindOfBake) {
  const Words bake = {"bake", "mannequin", "--json"};
  const auto with = [&](const Words& options) {
    Words words = bake;
    words.insert(words.end(), options.begin(), options.end());
    return said("report", words);
  };
  EXPECT_GT(with({"--duration", "1"})["response"]["steps"].size(), 0u);
  const Json limp = with({"--behaviour", "limp", "--hit", "head", "--duration", "1.2", "--lead", "0.2",
                          "--keys", "all", "--limits", "axis", "--until-rest"});
  EXPECT_FALSE(limp["response"]["pelvis_contact"].is_null());
  with({"--preset", "football", "--recover", "0.3"});
  EXPECT_FALSE(with({"--behaviour", "limp", "--get-up", "0.5"})["response"]["get_up"].is_null());
  const Words kick = {"--preset", "kick", "--strength", "2", "--steps", "0"};
  Words library = {"bake", "mannequin", "--get-up", "--clip-only", "-o", "getups.glb", "--quiet"};
  library.insert(library.end(), kick.begin(), kick.end());
  ASSERT_EQ(run(library).status, 0);
  Words led = kick;
  led.insert(led.end(), {"--get-up-clip", "getups.glb"});
  const Json get_up = with(led)["response"]["get_up"];
  EXPECT_EQ(get_up["route"], "clip");
  EXPECT_TRUE(get_up["clip"]["leads"]);
  EXPECT_FALSE(with({"--clip", "walk", "--at", "0.4", "--duration", "0.3", "--root-motion",
                     "root"})["clip"]["root_curve_m"]
                   .is_null());
  for (const char* scene : {"slope", "fall", "push", "impulse", "box", "none"})
    with({"--scene", scene, "--duration", "0.2"});
}

TEST_F(Schema, AReportThatLacksAKeyOrHasAnotherIsRefused) {
  Json report = Json::parse(run({"bake", "mannequin", "--duration", "0.2", "--json"}).out);
  report["impact"].erase("momentum_n_s");
  report["limits"]["worst_joint"] = 3;
  report["clip"]["mood"] = "fine";
  EXPECT_EQ(faults(schema("report"), report),
            (Words{"/clip/mood: is not described", "/impact/momentum_n_s: is missing",
                   "/limits/worst_joint: is of the wrong type: 3"}));
}

TEST_F(Schema, ManifestOfReactionsThatWereDoneAndThatFailed) {
  write("r.toml", R"(format = 1
characters = ["mannequin"]
outputs = ["glb", "report"]
[settings]
duration = 0.2
clip-only = true
[[matrix]]
hit = ["head", "chest"]
variations = 2
jitter = { direction-deg = 10, strength-percent = 10, point-m = 0.02 }
[[reaction]]
name = "walking"
hit = "chest"
clip = "walk"
at = 0.2
[[reaction]]
name = "too_late"
hit = "chest"
clip = "walk"
at = 20
)");
  EXPECT_NE(run({"batch", "r.toml", "-o", "out", "--no-review"}).status, 0);
  const std::string text = read("out/manifest.json");
  expect_described("manifest", text);
  const Json manifest = Json::parse(text);
  std::set<std::string> statuses;
  for (const Json& reaction : manifest["reactions"]) statuses.insert(reaction["status"]);
  EXPECT_EQ(statuses, (std::set<std::string>{"done", "failed"}));
}

TEST_F(Schema, LibraryAndEventsOfABatch) {
  write("r.toml", R"(format = 1
characters = ["mannequin"]
outputs = ["glb", "events", "report"]
[settings]
duration = 0.4
clip-only = true
[[matrix]]
hit = ["head", "chest"]
from = ["left", "60,70"]
[[reaction]]
name = "walking"
hit = "chest"
clip = "walk"
at = 0.2
)");
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out", "--no-review"}).status, 0);
  const std::string text = read("out/library.json");
  expect_described("library", text);
  EXPECT_EQ(Json::parse(text).size(), 5u);
  expect_described("events", read("out/mannequin/walking.events.json"));
  const Json report = Json::parse(read("out/mannequin/walking.json"));
  Json row = Json::parse(text).back();
  EXPECT_EQ(row["Name"], "mannequin_walking");
  EXPECT_EQ(report["library"], row) << "the same record in the report";
}

TEST_F(Schema, InspectionOfCharactersAndOfOtherFiles) {
  EXPECT_GT(said("inspect", {"inspect", "mannequin", "--json"})["clips"].size(), 0u);
  write("thing.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"name":"box"}],"scenes":[{"nodes":[0]}],"scene":0})");
  EXPECT_EQ(said("inspect", {"inspect", "thing.gltf", "--json"}, 1)["verdict"], "not-humanoid");
  write("junk.bvh", "junk");
  EXPECT_EQ(said("inspect", {"inspect", "junk.bvh", "--json"}, 2)["verdict"], "malformed");
}

TEST_F(Schema, RangesOfMotionWithEveryQuestion) {
  EXPECT_EQ(said("rom", {"rom", "--json"})["joints"].size(), 17u);
  EXPECT_TRUE(said("rom", {"rom", "--check", "walk", "--json"}).contains("check"));
  said("rom", {"rom", "--joint", "shoulder_r", "--swing", "--json"});
  said("rom", {"rom", "--joint", "shoulder_r", "--state", "30,20", "--json"});
}

TEST_F(Schema, JudgementsOfWhoStaysUpAndOfWhoFalls) {
  const Json stands = said("judge", {"judge", "mannequin#walk", "--json"});
  EXPECT_TRUE(stands["events"]["pelvis_contact"].is_null());
  EXPECT_EQ(run({"bake", "mannequin", "--behaviour", "limp", "--clip-only", "-o", "a.glb"}).status, 0);
  EXPECT_FALSE(said("judge", {"judge", "a.glb", "--json"})["events"]["pelvis_contact"].is_null());
}

TEST_F(Schema, ComparisonAndDifference) {
  EXPECT_GT(said("compare", {"compare", "mannequin", "--hits", "1", "--duration", "0.1", "--json"})["methods"]
                .size(),
            0u);
  EXPECT_EQ(run({"bake", "mannequin", "--duration", "0.2", "-o", "a.glb"}).status, 0);
  EXPECT_EQ(run({"bake", "mannequin", "--duration", "0.2", "--hit", "head", "-o", "b.bvh"}).status, 0);
  EXPECT_TRUE(said("diff", {"diff", "a.glb", "a.glb", "--json"})["within_tolerance"].get<bool>());
  EXPECT_FALSE(said("diff", {"diff", "a.glb", "b.bvh", "--json"}, 1)["within_tolerance"].get<bool>());
}

}  // namespace
}  // namespace ukemi
