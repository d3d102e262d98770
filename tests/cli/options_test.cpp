#include "cli/options.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

constexpr Range kRange{1.0, 1000.0};

/// One option of each kind.
struct Example {
  std::string file;
  double fps = 60.0;
  std::string region = "human";
  std::vector<std::filesystem::path> outputs;
  bool json = false;
  bool until_rest = true;
  double lead_s = 1.0;
  Options options{"example", "does nothing"};

  Example() {
    options.argument("FILE", file, "what to read");
    options.group("numbers");
    options.number("--fps", "N", fps, kRange, "frames per second");
    options.group("words");
    options.text("--region", "NAME", region, "range of motion");
    options.paths("-o,--output", outputs, "the clip");
    options.flag("--json", json, "as JSON");
    options.on_off(
        "until-rest", true, [this](bool on) { until_rest = on; }, "end at rest", "go on");
    options.everyday(false);
    options.number("--pre-roll,--lead", "S", lead_s, kRange, "time before the blow");
  }
};

Error refused(const std::vector<std::string>& arguments) {
  Example example;
  const auto outcome = example.options.parse(arguments);
  EXPECT_FALSE(outcome);
  return outcome ? Error{} : outcome.error();
}

TEST(Options, ReachTheirTargets) {
  Example example;
  const auto outcome = example.options.parse(
      {"--fps", "30", "-o", "a.glb", "in.glb", "--output=b.bvh", "--json", "--no-until-rest"});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(*outcome, Options::Outcome::run);
  EXPECT_EQ(example.file, "in.glb");
  EXPECT_DOUBLE_EQ(example.fps, 30.0);
  EXPECT_EQ(example.outputs, (std::vector<std::filesystem::path>{"a.glb", "b.bvh"}));
  EXPECT_TRUE(example.json);
  EXPECT_FALSE(example.until_rest);
}

TEST(Options, DoNotTakeTheArgumentThatFollowsTheirValue) {
  Example example;
  ASSERT_TRUE(example.options.parse({"-o", "a.glb", "in.glb"}));
  EXPECT_EQ(example.file, "in.glb");
  EXPECT_EQ(example.outputs.size(), 1u);
}

TEST(Options, RefuseWhatIsWrongAndNameIt) {
  EXPECT_EQ(refused({}).what, "FILE is missing");
  EXPECT_EQ(refused({"in.glb", "--fsp", "3"}).fix, "did you mean '--fps'?");
  EXPECT_EQ(refused({"--fsp=3"}).what, "unknown option '--fsp'");
  EXPECT_EQ(refused({"in.glb", "more.glb"}).what, "unexpected argument 'more.glb'");
  EXPECT_EQ(refused({"in.glb", "--fps", "0"}).what, "--fps: 0 is out of range");
  EXPECT_EQ(refused({"in.glb", "--fps", "0"}).fix, "give a number, 1 to 1000");
  EXPECT_EQ(refused({"in.glb", "--fps", "-5"}).what, "--fps: -5 is out of range");
  EXPECT_EQ(refused({"in.glb", "--fps=-5"}).what, "--fps: -5 is out of range");
  EXPECT_EQ(refused({"in.glb", "--fps", "3", "--fps", "4"}).what, "--fps is given 2 times");
  EXPECT_EQ(refused({"in.glb", "-o", ""}).what, "--output: the file's name is empty");
  EXPECT_EQ(refused({""}).what, "FILE is empty");
  EXPECT_EQ(refused({"--", "in.glb", "more.glb"}).what, "unexpected argument 'more.glb'");
  EXPECT_EQ(refused({"in.glb", "--fps"}).kind, ErrorKind::usage);
}

TEST(Options, HelpTellsDefaultsAndLegalRanges) {
  Example example;
  const auto outcome = example.options.parse({"--help"});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(*outcome, Options::Outcome::help);
  const std::string help = example.options.help();
  EXPECT_NE(help.find("usage: ukemi example FILE [options]"), std::string::npos) << help;
  EXPECT_NE(help.find("frames per second [default 60; 1 to 1000]"), std::string::npos) << help;
  EXPECT_NE(help.find("[may be repeated]"), std::string::npos) << help;
}

TEST(Options, HaveOtherNamesAndRefusalsNameTheFirst) {
  for (const char* name : {"--pre-roll", "--lead"}) {
    Example example;
    ASSERT_TRUE(example.options.parse({"in.glb", name, "2"}));
    EXPECT_DOUBLE_EQ(example.lead_s, 2.0);
  }
  EXPECT_EQ(refused({"in.glb", "--lead", "0"}).what, "--pre-roll: 0 is out of range");
  EXPECT_EQ(refused({"in.glb", "--lead", "2", "--pre-roll", "3"}).what, "--pre-roll is given 2 times");
  EXPECT_EQ(refused({"in.glb", "--pre-rol", "2"}).fix, "did you mean '--pre-roll'?");
}

TEST(Options, ThatFewNeedAreInHelpAllAlone) {
  for (const std::string word : {"--help", "--help-all"}) {
    Example example;
    ASSERT_TRUE(example.options.parse({word}));
    const std::string help = example.options.help();
    const bool all = word == "--help-all";
    EXPECT_EQ(help.find("--pre-roll") != std::string::npos, all) << help;
    EXPECT_EQ(help.find("--help-all shows all options, 1 more") != std::string::npos, !all) << help;
    EXPECT_NE(help.find("--fps"), std::string::npos) << help;
  }
}

}  // namespace
}  // namespace ukemi
