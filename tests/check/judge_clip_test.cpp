// Captured people score like people, limp bodies do not.
#include "check/judge_clip.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "bake/bake.h"
#include "bake/record.h"
#include "base/character_path.h"
#include "judge/judge.h"
#include "load/load.h"
#include "prepare/direction.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kBoxer = "mocap/other_bvh/Boxing_Toes.bvh";

JudgeClipSettings clip_of(const fs::path& file) {
  JudgeClipSettings settings;
  settings.file = file.string();
  return settings;
}

Judgement judgement_of(const JudgeClipSettings& settings) {
  Diagnostics diagnostics;
  const auto judged = judge_clip(settings, diagnostics);
  EXPECT_TRUE(judged) << settings.file << ": " << judged.error().message();
  return judged ? judged->judgement : Judgement{};
}

/// A part of the boxer's recording, from an event to the next or to the end of the answer to it, seconds.
Judgement boxer(const fs::path& data, double impact_s, double to_s) {
  JudgeClipSettings settings = clip_of(data / kBoxer);
  settings.judge.impact_s = impact_s;
  settings.judge.to_s = to_s;
  return judgement_of(settings);
}

TEST(JudgeClip, TheBoxersKnockDownIsFoundWithItsTimes) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  JudgeClipSettings settings = clip_of(*data / kBoxer);
  settings.judge.from_s = 22.0;
  settings.judge.to_s = 31.0;
  const Judgement judgement = judgement_of(settings);
  EXPECT_EQ(judgement.kind, ReactionKind::fall);
  EXPECT_EQ(judgement.final_pose, JudgedPose::standing);
  ASSERT_TRUE(judgement.fall && judgement.fall->pelvis_down && judgement.fall->hand);
  EXPECT_NEAR(judgement.fall->fall_begins_s, 23.74, 0.03);
  EXPECT_NEAR(judgement.fall->pelvis.time_s, 24.02, 0.02);
  EXPECT_NEAR(judgement.fall->pelvis.speed_m_s, 1.165, 0.05);
  EXPECT_NEAR(judgement.fall->hand->time_s, 24.02, 0.03);
  EXPECT_FALSE(judgement.fall->head);
  ASSERT_TRUE(judgement.fall->rest_s && judgement.get_up && judgement.get_up->stands_s);
  EXPECT_NEAR(*judgement.fall->rest_s, 25.6, 0.1);
  EXPECT_NEAR(*judgement.get_up->stands_s, 30.2, 0.1);
}

TEST(JudgeClip, TheBoxersFirstStepsAreFound) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  for (const auto& [impact_s, to_s] : {std::pair{16.84, 18.2}, {19.61, 20.5}, {21.93, 22.42}}) {
    const Judgement judgement = boxer(*data, impact_s, to_s);
    ASSERT_FALSE(judgement.steps.empty()) << impact_s;
    const Step& first = judgement.steps.front();
    EXPECT_NEAR(first.lift_s - impact_s, 0.24, 0.045) << impact_s;
    EXPECT_NEAR(first.contact_s - impact_s, 0.455, 0.06) << impact_s;
    EXPECT_NEAR(first.length_m, 0.13, 0.055) << impact_s;
  }
}

TEST(JudgeClip, CapturedPeopleScoreLikePeople) {
  const auto data = extra_data();
  const char* truth = std::getenv("UKEMI_TRUTH");
  if (!data || truth == nullptr) GTEST_SKIP() << "UKEMI_EXTRA_DATA or UKEMI_TRUTH name no folder";
  std::vector<double> scores;
  for (const auto& [impact_s, to_s] : {std::pair{14.53, 16.3},
                                       {16.84, 18.2},
                                       {19.61, 20.5},
                                       {20.53, 21.9},
                                       {21.93, 22.42},
                                       {22.45, 26.8},
                                       {27.1, 30.8}})
    scores.push_back(boxer(*data, impact_s, to_s).score);
  for (const char* clip : {"dm_getup_facedown.bvh", "dm_getup_faceup.bvh"}) {
    JudgeClipSettings settings = clip_of(fs::path(truth) / "clips" / clip);
    settings.humanoid.up_axis = 'y';
    const Judgement judgement = judgement_of(settings);
    EXPECT_EQ(judgement.kind, ReactionKind::get_up) << clip;
    scores.push_back(judgement.score);
  }
  double mean = 0.0;
  for (const double score : scores) {
    EXPECT_GE(score, 0.85);
    mean += score / static_cast<double>(scores.size());
  }
  EXPECT_GE(mean, 0.93);
}

Character mannequin() {
  Diagnostics diagnostics;
  const auto path = character_path("mannequin");
  EXPECT_TRUE(path);
  auto character = load_character(*path, LoadOptions{}, diagnostics);
  EXPECT_TRUE(character);
  return std::move(*character);
}

TEST(JudgeClip, LimpBodiesFallLikeNoConsciousPerson) {
  const Character character = mannequin();
  for (const char* from : {"front", "back", "left"}) {
    BakeSettings settings;
    settings.preset = "kick";
    settings.from = *parse_direction(from);
    settings.behaviour = Behaviour::limp;
    Diagnostics diagnostics;
    const auto outcome = bake(character, settings, diagnostics);
    ASSERT_TRUE(outcome) << outcome.error().message();
    JudgeSettings blow;
    blow.impact_s = 0.0;
    const Judgement judgement =
        judge(judged_motion(character, outcome->prepared.humanoid, outcome->timeline.clip), blow);
    EXPECT_EQ(judgement.outcome, JudgedOutcome::fell) << from;
    EXPECT_LT(judgement.score, 0.7) << from;
    int failed = 0;  // of those of a conscious person's landing
    for (const int number : {14, 15, 16, 17, 18})
      if (const Criterion* criterion = find_criterion(judgement, number))
        failed += criterion->passed == false;
    EXPECT_GE(failed, 2) << from;
    EXPECT_EQ(find_criterion(judgement, 15)->passed, false) << from;
  }
}

/// Baked files in a folder of their own.
class JudgedFiles : public testing::Test {
 protected:
  JudgedFiles() {
    std::string name = (fs::temp_directory_path() / "ukemi_judge_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~JudgedFiles() override { fs::remove_all(folder_); }

  fs::path baked(BakeSettings settings) const {
    settings.simulation.duration_s = 0.5;
    settings.clip_only = true;
    settings.outputs = {folder_ / "hit.glb"};
    Diagnostics diagnostics;
    const auto file = bake_file("mannequin", settings, diagnostics);
    EXPECT_TRUE(file) << file.error().message();
    return folder_ / "hit.glb";
  }

  static Error refusal(const JudgeClipSettings& settings) {
    Diagnostics diagnostics;
    const auto judged = judge_clip(settings, diagnostics);
    EXPECT_FALSE(judged);
    return judged ? Error{} : judged.error();
  }

  fs::path folder_;
};

TEST_F(JudgedFiles, TellWhereTheirBlowIs) {
  BakeSettings settings;
  settings.lead_s = 0.5;
  const fs::path file = baked(settings);
  const Judgement judgement = judgement_of(clip_of(file));
  EXPECT_FALSE(judgement.impact_found);
  EXPECT_DOUBLE_EQ(judgement.impact_s, 0.5);
  JudgeClipSettings from = clip_of(file);
  from.judge.from_s = 0.1;
  EXPECT_TRUE(judgement_of(from).impact_found);
}

TEST_F(JudgedFiles, ScoreAsTheirReportsSay) {
  BakeSettings settings;
  settings.preset = "kick";
  settings.from = *parse_direction("left");
  settings.behaviour = Behaviour::limp;
  settings.keys.enabled = false;
  settings.outputs = {folder_ / "hit.glb"};
  Diagnostics diagnostics;
  const auto file = bake_file("mannequin", settings, diagnostics);
  ASSERT_TRUE(file) << file.error().message();
  JudgeClipSettings judged = clip_of(folder_ / "hit.glb");
  judged.judge.momentum_n_s = file->outcome.figures.momentum_n_s;
  const Json response = Json::parse(file->report)["response"];
  const Judgement judgement = judgement_of(judged);
  EXPECT_DOUBLE_EQ(response["score"].get<double>(), judgement.score);
  EXPECT_LT(judgement.score, 0.9);
  EXPECT_EQ(figures_of(*file).score, judgement.score);
}

TEST_F(JudgedFiles, AreRefusedWhereThereIsNothingToJudge) {
  const fs::path file = baked({});
  JudgeClipSettings settings = clip_of(file.string() + "#gone");
  EXPECT_EQ(refusal(settings).kind, ErrorKind::usage);
  settings = clip_of(file);
  settings.judge.impact_s = 3.0;
  EXPECT_NE(refusal(settings).what.find("the clip ends at"), std::string::npos);
  settings.judge.impact_s = 0.4;
  settings.judge.to_s = 0.3;
  EXPECT_NE(refusal(settings).what.find("--to"), std::string::npos);
  BakeSettings additive;
  additive.additive = Additive::identity;
  EXPECT_NE(refusal(clip_of(baked(additive))).what.find("additive"), std::string::npos);
}

TEST_F(JudgedFiles, AreToldAsJson) {
  JudgeClipSettings settings = clip_of(baked({}));
  settings.file += "#0";
  Diagnostics diagnostics;
  const auto judged = judge_clip(settings, diagnostics);
  ASSERT_TRUE(judged);
  const Json json = Json::parse(judgement_json(*judged, diagnostics));
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["mode"], name(judged->judgement.kind));
  EXPECT_EQ(json["score"], judged->judgement.score);
  std::set<int> numbers;
  int passed = 0, applicable = 0;
  for (const Json& criterion : json["criteria"]) {
    numbers.insert(criterion["number"].get<int>());
    EXPECT_EQ(criterion["values"].size(), criterion["bands"].size());
    EXPECT_EQ(criterion["passed"].is_null(), criterion["values"].empty()) << criterion.dump();
    passed += criterion["passed"] == true;
    applicable += criterion["passed"].is_boolean();
  }
  EXPECT_EQ(numbers.size(), json["criteria"].size());
  EXPECT_DOUBLE_EQ(json["score"].get<double>(), static_cast<double>(passed) / applicable);
  EXPECT_EQ(json["events"]["impact_s"], 0.0);
}

}  // namespace
}  // namespace ukemi
