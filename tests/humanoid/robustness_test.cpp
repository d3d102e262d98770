// Odd hierarchies and maps give an error or a figure, never a crash or a number that is none.
#include <gtest/gtest.h>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"
#include "support/random.h"

namespace ukemi {
namespace {

using testing::figure;

bool is_finite(const BodyPose& body) {
  for (const Rigid& segment : body)
    if (!segment.translation.allFinite() || !segment.rotation.coeffs().allFinite()) return false;
  return true;
}

/// 1 when the character was accepted; everything computed from it must be finite.
int accepted(const Character& character, const HumanoidOptions& options) {
  Diagnostics diagnostics;
  const auto humanoid = map_humanoid(character, options, diagnostics);
  if (!humanoid) {
    EXPECT_FALSE(humanoid.error().what.empty());
    return 0;
  }
  for (const StartPose kind : {StartPose::rest, StartPose::stand, StartPose::guard}) {
    const Pose pose = start_pose(character, *humanoid, kind);
    EXPECT_TRUE(is_finite(segments_of(character.skeleton, *humanoid, pose)));
    EXPECT_TRUE(is_finite(canonical_segments_of(character.skeleton, *humanoid, pose)));
  }
  EXPECT_TRUE(std::isfinite(humanoid->height_m) && humanoid->height_m > 0.0);
  return 1;
}

TEST(Robustness, AnyUserMapIsTakenOrRefused) {
  const Character character = figure();
  Random random(3);
  int count = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    HumanoidOptions options;
    const int entries = 1 + static_cast<int>(test::random_below(random, 4));
    for (int i = 0; i < entries; ++i)
      options
          .map[std::string(name(segment_at(static_cast<int>(test::random_below(random, kSegmentCount)))))] =
          '#' + std::to_string(test::random_below(random, character.skeleton.nodes.size()));
    count += accepted(character, options);
  }
  EXPECT_GT(count, 100);
}

TEST(Robustness, AnyHierarchyOfHumanNamesIsTakenOrRefused) {
  Random random(4);
  int count = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Character character = figure();
    auto& nodes = character.skeleton.nodes;
    const int changes = 1 + static_cast<int>(test::random_below(random, 6));
    for (int i = 0; i < changes; ++i) {
      const auto a = test::random_below(random, nodes.size()), b = test::random_below(random, nodes.size());
      switch (test::random_below(random, 4)) {
        case 0:
          std::swap(nodes[a].name, nodes[b].name);
          break;
        case 1:
          if (b < a) nodes[a].parent = static_cast<int>(b);
          break;
        case 2:
          nodes[a].rest.translation.setZero();
          break;
        default:
          nodes[a].name.clear();
      }
    }
    ASSERT_TRUE(character.skeleton.sort());
    count += accepted(character, {});
  }
  EXPECT_GT(count, 100);
}

TEST(Robustness, NothingAtAllIsRefused) {
  Character character;
  EXPECT_EQ(accepted(character, {}), 0);
  character.skeleton.nodes.push_back({"Hips", -1, {}});
  ASSERT_TRUE(character.skeleton.sort());
  EXPECT_EQ(accepted(character, {}), 0);
}

}  // namespace
}  // namespace ukemi
