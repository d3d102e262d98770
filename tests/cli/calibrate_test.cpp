// Thresholds of the active restriction, measured and used by the whole program.
#include "program.h"

namespace ukemi {
namespace {

using Calibrate = Program;

TEST_F(Calibrate, WritesThresholdsThatABakeUses) {
  const Ran ran = run({"calibrate", "--factor", "4", "-o", "active.toml"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("shoulder"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("wrote active.toml"), std::string::npos) << ran.out;
  const std::string written = read("active.toml");
  EXPECT_NE(written.find("knee = ["), std::string::npos) << written;
  EXPECT_NE(written.find("4 times the 99th percentile of calm standing"), std::string::npos) << written;
  const std::vector<std::string> bake = {"bake",          "mannequin",   "--duration", "0.3",
                                         "--active-file", "active.toml", "-o",         "a.bvh"};
  EXPECT_EQ(run(bake).status, 0);
  const std::string high = read("a.bvh");
  std::string low = written;  // "x = [150, 120, 385]" with every threshold at a tenth
  for (std::size_t at = low.find("[threshold]"); (at = low.find("\n", at)) != low.npos; ++at)
    if (const auto open = low.find(" = [", at); open != low.npos && low[at + 1] != '#')
      low.replace(open, low.find(']', open) - open, " = [15, 15, 15");
  write("active.toml", low);
  EXPECT_EQ(run(bake).status, 0);
  EXPECT_NE(read("a.bvh"), high) << "the thresholds make no difference";
  std::string broken = written;
  broken.replace(broken.find("knee = ["), 8, "knie = [");
  write("active.toml", broken);
  expect_refused(bake, 2, "joint 'knee': has no threshold");
}

TEST_F(Calibrate, MeasuresTheFilesItIsGiven) {
  const std::string mannequin = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh";
  ASSERT_EQ(run({"calibrate", mannequin, "-o", "both.toml"}).status, 0);
  EXPECT_NE(read("both.toml").find("mannequin, mannequin.bvh"), std::string::npos) << read("both.toml");
  EXPECT_EQ(files(), std::vector<std::string>{"both.toml"});
}

TEST_F(Calibrate, WalkingAndStandingCountAsTheyAreTold) {
  const std::string mannequin = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.bvh";
  const auto measured = [&](std::vector<std::string> more) {
    more.insert(more.begin(), "calibrate");
    more.insert(more.end(), {"-o", "a.toml"});
    EXPECT_EQ(run(more).status, 0);
    return read("a.toml");
  };
  const std::string both = measured({});
  EXPECT_NE(both.find("walking ["), std::string::npos);
  const std::string standing = measured({"--exclude-walking"});
  EXPECT_EQ(standing.find("walking ["), std::string::npos);
  EXPECT_NE(standing.substr(standing.find("\nhip = ")), both.substr(both.find("\nhip = ")));
  EXPECT_NE(measured({"--exclude-walking", "--factor", "60"}).substr(standing.find("\nhip = ")),
            standing.substr(standing.find("\nhip = ")));
  EXPECT_NE(measured({"--standing", mannequin}).find("mannequin.bvh (standing)"), std::string::npos);
}

TEST_F(Calibrate, RefusesWhatItCannotMeasure) {
  expect_refused({"calibrate"}, 2, "no output");
  expect_refused({"calibrate", "nowhere.bvh", "-o", "a.toml"}, 2, "nowhere.bvh");
  expect_refused({"calibrate", "--factor", "0.5", "-o", "a.toml"}, 2, "--factor");
  expect_refused({"calibrate", "-o", "missing/a.toml"}, 4, "missing");
  write("stone.bvh", "HIERARCHY\nROOT stone\n{\n");
  expect_refused({"calibrate", "stone.bvh", "-o", "a.toml"}, 2, "stone.bvh");
}

}  // namespace
}  // namespace ukemi
