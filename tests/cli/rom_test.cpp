// The rom command, as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

class Rom : public Program {
 protected:
  Json json(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "rom");
    arguments.push_back("--json");
    const Ran result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out);
  }
  std::string picture(const std::string& name) { return read(name).substr(1, 3); }
};

TEST_F(Rom, TellsTheRangeOfEveryJoint) {
  const Json rom = json({});
  EXPECT_EQ(rom["joints"].size(), 17u);
  const Json& knee = rom["joints"]["knee_r"];
  EXPECT_EQ(knee["twist_deg"], Json({-22.0, 28.0}));
  EXPECT_EQ(knee["polygon_deg"].size(), 8u);
  EXPECT_EQ(knee["meanings"]["a_z"], Json({"extension", "flexion"}));
  // The rectangle of 10 by 164 degrees without its four cut corners.
  EXPECT_NEAR(knee["area_deg2"], 10.0 * 164.0 - 2.0 * 2.0 * (13.0 + 17.0) / 2.0, 1e-6);
  const Ran text = run({"rom"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("shoulder_r"), std::string::npos);
}

TEST_F(Rom, FollowsAClipThroughTheRanges) {
  const Json rom = json({"--check", "walk", "-o", "walk.png"});
  EXPECT_EQ(rom["check"]["clip"], "walk");
  EXPECT_EQ(rom["joints"]["knee_l"]["check"]["excess_deg"].size(), rom["check"]["frames"]);
  EXPECT_EQ(rom["check"]["over_5deg_fraction"], 0.0);
  EXPECT_EQ(picture("walk.png"), "PNG");
  EXPECT_EQ(json({"--check", "mannequin", "--clip", "walk", "--joint", "knee_l"})["joints"].size(), 1u);
}

TEST_F(Rom, SaysNoToAClipThatLeavesTheRangeTooFar) {
  EXPECT_EQ(run({"rom", "--check", "walk", "--max-excess", "1"}).status, 0);
  const Ran ran =
      run({"rom", "--check", "walk", "--region", "diamond", "--max-excess", "1", "-o", "walk.png"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("outside, more than --max-excess 1"), std::string::npos) << ran.out;
  EXPECT_EQ(picture("walk.png"), "PNG");
  EXPECT_EQ(run({"rom", "--check", "walk", "--region", "diamond"}).status, 1) << "1 degree unless said";
  EXPECT_EQ(run({"rom", "--check", "walk", "--region", "diamond", "--max-excess", "180"}).status, 0);
  expect_refused({"rom", "--max-excess", "1"}, 2, "--max-excess needs --check");
}

TEST_F(Rom, TellsTheStopsThroughAState) {
  const Json rom = json({"--region", "diamond", "--joint", "neck", "--state=10,20", "-o", "state.png"});
  const Json& state = rom["joints"]["neck"]["state"];
  // Corners (46, 0), (0, 60), (-46, 0): a third of the way up, two thirds of the width are left.
  EXPECT_NEAR(state["chord_a_y_deg"][0], -46.0 * 2.0 / 3.0, 1e-5);
  EXPECT_NEAR(state["chord_a_y_deg"][1], 46.0 * 2.0 / 3.0, 1e-5);
  EXPECT_NEAR(state["chord_a_z_deg"][1], 60.0 * (1.0 - 10.0 / 46.0), 1e-5);
  EXPECT_EQ(picture("state.png"), "PNG");
}

TEST_F(Rom, SwingsALinkIntoTheBoundary) {
  const Json swing =
      json({"--joint", "shoulder_r", "--swing", "-o", "swing.png"})["joints"]["shoulder_r"]["swing"];
  EXPECT_GT(swing["axis"]["excess_max_deg"], 10.0);
  EXPECT_LT(swing["edges"]["excess_max_deg"], 0.5);
  EXPECT_EQ(picture("swing.png"), "PNG");
}

TEST_F(Rom, RefusesWhatItCannotDraw) {
  expect_refused({"rom", "--joint", "knee"}, 2, "unknown joint 'knee'");
  expect_refused({"rom", "--state=1,2"}, 2, "--state needs a joint");
  expect_refused({"rom", "--joint", "neck", "--state=1"}, 2, "is not AY,AZ");
  expect_refused({"rom", "--joint", "neck", "--swing", "--check", "walk"}, 2, "exclude each other");
  expect_refused({"rom", "-o", "rom.jpg"}, 2, ".png");
  expect_refused({"rom", "--check", "nowhere.bvh"}, 2, "nowhere.bvh");
}

}  // namespace
}  // namespace ukemi
