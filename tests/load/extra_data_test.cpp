// Files made by others, where UKEMI_EXTRA_DATA names their folder: what is sound loads, what is not is
// refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

/// Every pose of every track at start, middle and end must be finite, and every index in range.
void expect_consistent(const Character& c) {
  EXPECT_EQ(c.skeleton.order.size(), c.skeleton.nodes.size());
  for (const Animation& animation : c.animations)
    for (const double time :
         {animation.start_s, 0.5 * (animation.start_s + animation.end_s), animation.end_s})
      for (const LocalTransform& local : sample(c.skeleton, animation, time)) {
        EXPECT_TRUE(local.translation.allFinite() && local.rotation.coeffs().allFinite() &&
                    local.scale.allFinite());
        EXPECT_NEAR(local.rotation.norm(), 1.0, 1e-6);
      }
  for (const MeshPart& part : c.parts) {
    for (const std::uint32_t index : part.indices) ASSERT_LT(index, part.positions.size());
    ASSERT_EQ(part.normals.size(), part.positions.size());
    ASSERT_EQ(part.skin >= 0, !part.weights.empty());
    for (std::size_t v = 0; v < part.weights.size(); ++v) {
      float sum = 0.0f;
      for (int k = 0; k < 4; ++k) {
        sum += part.weights[v][k];
        ASSERT_LT(part.joints[v][k], c.skins[part.skin].joints.size());
      }
      ASSERT_NEAR(sum, 1.0f, 1e-5f);
    }
  }
}

class ExtraData : public testing::Test {
 protected:
  void SetUp() override {
    const auto named = extra_data();
    if (!named) GTEST_SKIP() << kNoExtraData;
    folder = *named;
    entries = extra_files(folder);
    ASSERT_FALSE(entries.empty()) << "no MANIFEST.tsv in " << folder;
  }
  fs::path folder;
  std::vector<ExtraFile> entries;
};

TEST_F(ExtraData, EveryCharacterMotionAndPropLoads) {
  int count = 0;
  for (const ExtraFile& entry : entries) {
    if (entry.verdict == "malformed" || entry.file.starts_with("malformed/")) continue;
    SCOPED_TRACE(entry.file);
    Diagnostics diagnostics;
    const auto c = load_character(folder / entry.file, {}, diagnostics);
    ASSERT_TRUE(c) << c.error().message();
    expect_consistent(*c);
    ++count;
  }
  EXPECT_GT(count, 50);
}

/// Called malformed by their makers for something that does no harm here: two roots of a skin, which are also
/// what a VRM with several roots has, and a box whose texture is missing.
const std::set<std::string> kHarmless{"malformed/assimp/BoxTextured.gltf",
                                      "malformed/gltf_validator/skin/no_common_root.gltf"};

TEST_F(ExtraData, EveryMalformedFileIsRefused) {
  int count = 0;
  for (const ExtraFile& entry : entries) {
    if (entry.verdict != "malformed") continue;
    SCOPED_TRACE(entry.file);
    Diagnostics diagnostics;
    const auto c = load_character(folder / entry.file, {}, diagnostics);
    if (kHarmless.contains(entry.file)) {
      EXPECT_TRUE(c);
      continue;
    }
    ASSERT_FALSE(c);
    EXPECT_EQ(c.error().kind, ErrorKind::input);
    EXPECT_EQ(c.error().file, (folder / entry.file).string());
    EXPECT_FALSE(c.error().what.empty() || c.error().fix.empty());
    ++count;
  }
  EXPECT_GT(count, 40);
}

}  // namespace
}  // namespace ukemi
