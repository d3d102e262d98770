#include "batch/batch.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace ukemi {
namespace fs = std::filesystem;
namespace {

/// A batch of one short reaction in a folder of its own.
class BatchOfOne : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("ukemi_batch_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "r.toml") << "format = 1\ncharacters = [\"mannequin\"]\n[settings]\n"
                                         "duration = 0.1\n[[matrix]]\nhit = [\"head\"]\n";
    settings_.recipe = folder_ / "r.toml";
    settings_.folder = folder_ / "out";
    settings_.resume = true;
    settings_.workers.workers = 1;
  }
  void TearDown() override { fs::remove_all(folder_); }

  BatchPlan plan(const std::string& program) {
    settings_.program = program;
    auto plan = plan_batch(settings_);
    EXPECT_TRUE(plan) << plan.error().message();
    return std::move(*plan);
  }
  /// Bakes what the program `program` would bake.
  void run(const std::string& program) {
    const auto result = run_batch(
        plan(program), settings_, [](const BatchProgress&) {}, [] { return false; });
    EXPECT_TRUE(result) << result.error().message();
  }
  std::string manifest() const {
    std::ostringstream text;
    text << std::ifstream(settings_.folder / "manifest.json").rdbuf();
    return text.str();
  }

  fs::path folder_;
  BatchSettings settings_;
};

TEST_F(BatchOfOne, IsOfThisProgramUnlessToldOtherwise) { EXPECT_EQ(BatchSettings().program, build_id()); }

TEST_F(BatchOfOne, KeepsWhatTheSameProgramBakedAndBakesAgainWithAnother) {
  EXPECT_EQ(plan("one").count(Plan::bake), 1u);
  run("one");
  EXPECT_EQ(plan("one").count(Plan::keep), 1u);
  EXPECT_EQ(plan("another").count(Plan::bake), 1u);
}

TEST_F(BatchOfOne, TriesAgainWhatFailed) {
  std::ofstream(folder_ / "r.toml") << "format = 1\ncharacters = [\"mannequin\"]\n[settings]\n"
                                       "clip = \"no such clip\"\n[[matrix]]\nhit = [\"head\"]\n";
  run("one");
  EXPECT_NE(manifest().find("\"failed\""), std::string::npos) << manifest();
  EXPECT_EQ(plan("one").count(Plan::bake), 1u);
  EXPECT_EQ(plan("one").count(Plan::keep), 0u);
}

TEST_F(BatchOfOne, SaysNothingOfTheProgramInItsManifest) {
  run("one");
  const std::string first = manifest();
  EXPECT_FALSE(first.empty());
  run("another");
  EXPECT_EQ(plan("another").count(Plan::keep), 1u);
  EXPECT_EQ(manifest(), first);
}

}  // namespace
}  // namespace ukemi
