#include <gtest/gtest.h>

#include <toml++/toml.h>

#include <filesystem>
#include <fstream>

#include "restrict/range_of_motion.h"
#include "restrict/region_tables.h"
#include "support/random.h"

namespace ukemi {
namespace {

const char* const kElbow = R"([[joint]]
name = "elbow_r"
neutral_link_dir = [0, -1, 0]
x_axis = [0.9397, -0.342, 0]
y_axis = [0.342, 0.9397, 0]
)";

TEST(Region, AllThreeLoadWithSeventeenJoints) {
  for (const char* name : {"human", "diamond", "box"}) {
    const auto range = load_range_of_motion(name);
    ASSERT_TRUE(range) << range.error().message();
    for (const JointRange& joint : range->joints) {
      EXPECT_GE(joint.polygon.size(), 4u);
      EXPECT_LT(polygon_distance(joint.polygon, Vec2::Zero()), 0.0);
    }
  }
}

TEST(Region, AFileThatIsBasedOnItselfIsRefused) {
  const std::string file = testing::TempDir() + "ukemi_region_of_itself.toml";
  std::ofstream(file) << "base = \"" << file << "\"\n" << kElbow;
  const auto range = load_range_of_motion(file);
  std::filesystem::remove(file);
  ASSERT_FALSE(range);
  EXPECT_EQ(range.error().what, "more than 8 regions are based on one another");
}

TEST(Region, LeftIsTheMirrorOfRight) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  int pairs = 0;
  for (int j = 0; j < kJointCount; ++j) {
    if (!is_left(joint_at(j))) continue;
    ++pairs;
    const JointRange& left = range->joints[j];
    const JointRange other = mirrored(range->joints[index(mirror_of(joint_at(j)))]);
    EXPECT_LT(angle_between(left.frame.parent_from_joint, other.frame.parent_from_joint), 2e-4);
    EXPECT_LT(angle_between(left.frame.reference, other.frame.reference), 2e-4);
    EXPECT_NEAR(left.twist_min, other.twist_min, 1e-12);
    EXPECT_NEAR(left.twist_max, other.twist_max, 1e-12);
    for (const Vec2& corner : left.polygon)
      EXPECT_NEAR(polygon_distance(other.polygon, corner), 0.0, 1e-9) << name(joint_at(j));
    EXPECT_EQ(left.polygon.size(), other.polygon.size());
  }
  EXPECT_EQ(pairs, 7);
}

TEST(Region, AMirroredPoseHasTheMirroredChart) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range);
  Random random(4);
  for (int j = 0; j < kJointCount; ++j) {
    const JointRange& right = range->joints[j];
    const JointRange left = mirrored(right);
    const SwingTwist chart{test::random_vector2(random, 0.5), random.uniform(-0.5, 0.5)};
    const Quat q = right.frame.relative_from_joint(joint_rotation(chart));
    const SwingTwist seen = swing_twist(left.frame.joint_from_relative(Quat(q.w(), -q.x(), -q.y(), q.z())));
    EXPECT_NEAR(seen.swing.x(), -chart.swing.x(), 1e-9);
    EXPECT_NEAR(seen.swing.y(), chart.swing.y(), 1e-9);
    EXPECT_NEAR(seen.twist, -chart.twist, 1e-9);
  }
}

TEST(Region, OverridesSingleJointsOfABase) {
  const auto range = parse_range_of_motion(
      "base = \"human\"\n[[joint]]\nname = \"elbow_l\"\npolygon = [[5, -10], [5, 10], [-5, 10], [-5, -10]]\n",
      "robot.toml");
  ASSERT_TRUE(range) << range.error().message();
  const auto human = load_range_of_motion("human");
  EXPECT_EQ(range->joints[index(Joint::elbow_l)].polygon.size(), 4u);
  EXPECT_EQ(range->joints[index(Joint::elbow_r)].polygon, human->joints[index(Joint::elbow_r)].polygon);
}

/// The joints of a recipe's table put into the human range.
Result<RangeOfMotion> human_with(std::string_view recipe) {
  const toml::table document = toml::parse(recipe);
  return with_joint_tables(*load_range_of_motion("human"), *document["body"]["joint"].as_array(), "my.toml");
}

TEST(Region, ChangesSingleJointsInsideAnotherDocument) {
  const auto human = load_range_of_motion("human");
  const auto range = human_with("[[body.joint]]\nname = \"knee_l\"\nalpha = [-1, 2]\n");
  ASSERT_TRUE(range) << range.error().message();
  const JointRange& knee = range->joints[index(Joint::knee_l)];
  EXPECT_NEAR(knee.twist_min, radians(-1.0), 1e-12);
  EXPECT_NEAR(knee.twist_max, radians(2.0), 1e-12);
  EXPECT_EQ(knee.polygon, human->joints[index(Joint::knee_l)].polygon);
  EXPECT_EQ(range->joints[index(Joint::knee_r)].twist_max, human->joints[index(Joint::knee_r)].twist_max);
  EXPECT_EQ(range->name, "human with knee_l");
}

TEST(Region, FaultsInsideAnotherDocumentAreNamedWithLineAndJoint) {
  const auto inverted = human_with("x = 1\n\n[[body.joint]]\nname = \"knee_l\"\nalpha = [9, -9]\n");
  ASSERT_FALSE(inverted);
  EXPECT_EQ(inverted.error().file, "my.toml");
  EXPECT_EQ(inverted.error().line, 5);
  EXPECT_EQ(inverted.error().joint, "knee_l");
  const auto twice =
      human_with("[[body.joint]]\nname = \"knee_l\"\nalpha = [-9, 9]\n[[body.joint]]\nname = \"knee_l\"\n");
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().what.find("twice"), std::string::npos);
  EXPECT_EQ(twice.error().line, 4);
}

struct Fault {
  const char* text;
  const char* what;
  int line;
};

class RegionFault : public testing::TestWithParam<Fault> {};

TEST_P(RegionFault, IsNamedWithItsLine) {
  const std::string text = std::string("base = \"human\"\n") + GetParam().text;
  const auto range = parse_range_of_motion(text, "my.toml");
  ASSERT_FALSE(range);
  EXPECT_EQ(range.error().kind, ErrorKind::input);
  EXPECT_EQ(range.error().file, "my.toml");
  EXPECT_EQ(range.error().line, GetParam().line);
  EXPECT_NE(range.error().what.find(GetParam().what), std::string::npos) << range.error().what;
  EXPECT_FALSE(range.error().fix.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, RegionFault,
    testing::Values(Fault{"[[joint]]\nname = \"elbo_r\"\n", "unknown joint", 2},
                    Fault{"[[joint]]\nname = \"elbow_r\"\nalpha = [10, -10]\n", "inverted", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\nalpha = [10, 20]\n", "must hold 0", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\npolygon = [[1, 1], [9, 1], [9, 9], [1, 9]]\n",
                          "star-shaped", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\npolygon = [[9, 0], [0, -9], [-9, 0], [0, 9]]\n",
                          "counter-clockwise", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\npolygon = [[9, 0], [0, \"x\"], [-9, 0]]\n",
                          "pair of numbers", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\npolygon = [[9, 0], [0, 175], [-9, -9]]\n",
                          "170 degrees", 4},
                    Fault{"[[joint]]\nname = \"elbow_r\"\nx_axis = [1, 1, 0]\n", "unit vectors", 2},
                    Fault{"[[joint]\n", "", 2}, Fault{"", "no [[joint]]", 1}));

TEST(Region, SaysWhichJointIsMissing) {
  const auto range = parse_range_of_motion(
      std::string(kElbow) + "polygon = [[5, -10], [5, 10], [-5, 0]]\nalpha = [-9, 9]\n", "one.toml");
  ASSERT_FALSE(range);
  EXPECT_EQ(range.error().joint, "spine");
}

TEST(Region, SaysWhatNamesThereAre) {
  const auto range = load_range_of_motion("humann");
  ASSERT_FALSE(range);
  EXPECT_NE(range.error().fix.find("diamond"), std::string::npos);
}

}  // namespace
}  // namespace ukemi
