// The built-in character as the stages read it: assets/characters/mannequin.glb and .bvh.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>

#include "humanoid/humanoid.h"
#include "humanoid/rotations.h"
#include "load/load.h"
#include "restrict/range_of_motion.h"

namespace ukemi {
namespace {

constexpr double kHeight = 1.78;
constexpr double kWalkSpeed = 1.25;  // m/s

namespace fs = std::filesystem;

Character load(const std::string& file,
               const fs::path& folder = fs::path(UKEMI_ASSETS_FOLDER) / "characters") {
  Diagnostics diagnostics;
  auto character = load_character(folder / file, {}, diagnostics);
  EXPECT_TRUE(character) << (character ? "" : character.error().message());
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().what;
  return character ? *character : Character{};
}

Humanoid mapped(const Character& character) {
  Diagnostics diagnostics;
  auto humanoid = map_humanoid(character, {}, diagnostics);
  EXPECT_TRUE(humanoid) << (humanoid ? "" : humanoid.error().message());
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().what;
  return humanoid ? *humanoid : Humanoid{};
}

Clip clip(const Character& character, const std::string& name) {
  const auto found = std::find_if(character.animations.begin(), character.animations.end(),
                                  [&](const Animation& animation) { return animation.name == name; });
  EXPECT_NE(found, character.animations.end()) << name;
  return found == character.animations.end() ? Clip{} : sample_clip(character.skeleton, *found, 60.0);
}

/// Skinned vertices of a pose, metres.
std::vector<Vec3> vertices(const Character& character, const Pose& pose) {
  const std::vector<Affine> world = world_transforms(character.skeleton, pose);
  std::vector<Vec3> places;
  for (const MeshPart& part : character.parts) {
    const Skin& skin = character.skins[part.skin];
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      Vec3 place = Vec3::Zero();
      for (int k = 0; k < 4; ++k) {
        const int joint = part.joints[v][k];
        place += static_cast<double>(part.weights[v][k]) *
                 (world[skin.joints[joint]] * (skin.inverse_bind[joint] * part.positions[v].cast<double>()));
      }
      places.push_back(place);
    }
  }
  return places;
}

Vec3 position(const Character& character, const Pose& pose, const std::string& node) {
  return world_transforms(character.skeleton, pose)[character.skeleton.find(node)].translation();
}

TEST(Mannequin, HasEverySegmentByNameInTPoseAndItsHeight) {
  struct Case {
    const char* file;
    double metres_per_unit;
    double height_tolerance;  // a BVH has no skin: the height is guessed from the bones
  };
  for (const Case& c : {Case{"mannequin.glb", 1.0, 0.01}, Case{"mannequin.bvh", 0.01, 0.10}}) {
    const Character character = load(c.file);
    const Humanoid humanoid = mapped(character);
    for (int s = 0; s < kSegmentCount; ++s)
      EXPECT_EQ(humanoid.segments[s].by, "name") << c.file << " segment " << s;
    EXPECT_EQ(humanoid.rest_pose, RestPoseClass::t_pose) << c.file;
    EXPECT_EQ(humanoid.up_axis, 'y') << c.file;
    EXPECT_NEAR(humanoid.height_m, kHeight, c.height_tolerance) << c.file;
    EXPECT_NEAR(humanoid.world_from_file.scale, c.metres_per_unit, 1e-9) << c.file;
  }
}

TEST(Mannequin, StandsOnTheFloorFacingForwardWithTheLeftHandAtPlusX) {
  const Character character = load("mannequin.glb");
  const Pose rest = rest_pose(character.skeleton);
  double lowest = 1.0, highest = 0.0;
  for (const Vec3& vertex : vertices(character, rest)) {
    lowest = std::min(lowest, vertex.y());
    highest = std::max(highest, vertex.y());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-6);
  EXPECT_NEAR(highest, kHeight, 0.001);
  EXPECT_GT(position(character, rest, "LeftHand").x(), 0.7);
  EXPECT_GT(position(character, rest, "LeftToe_End").z(), position(character, rest, "LeftFoot").z() + 0.15);
}

TEST(Mannequin, IsAClosedSkinWithWeightsOnItsOwnBones) {
  const Character character = load("mannequin.glb");
  ASSERT_EQ(character.parts.size(), 2u);
  std::size_t triangles = 0;
  for (const MeshPart& part : character.parts) {
    triangles += part.indices.size() / 3;
    ASSERT_EQ(part.normals.size(), part.positions.size());
    for (const auto& weights : part.weights)
      EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1.0f, 1e-6f);
    std::multiset<std::pair<std::array<float, 3>, std::array<float, 3>>> edges;
    const auto place = [&](std::uint32_t i) {
      const Eigen::Vector3f& p = part.positions[i];
      return std::array<float, 3>{p.x(), p.y(), p.z()};
    };
    for (std::size_t i = 0; i < part.indices.size(); i += 3)
      for (int k = 0; k < 3; ++k)
        edges.emplace(place(part.indices[i + k]), place(part.indices[i + (k + 1) % 3]));
    for (const auto& [from, to] : edges)
      if (from != to) {
        ASSERT_EQ(edges.count({from, to}), edges.count({to, from})) << "a seam is open";
      }
  }
  EXPECT_GT(triangles, 6000u);
  EXPECT_LT(triangles, 12000u);
}

TEST(Mannequin, ClipsStayWithinTheRangeOfMotion) {
  const auto range = load_range_of_motion("human");
  ASSERT_TRUE(range) << range.error().message();
  const Character character = load("mannequin.glb");
  const Humanoid humanoid = mapped(character);
  for (const char* name : {"idle", "walk"}) {
    const Clip motion = clip(character, name);
    ASSERT_GT(motion.frames.size(), 50u);
    for (std::size_t frame = 0; frame < motion.frames.size(); ++frame) {
      const BodyPose body = canonical_segments_of(character.skeleton, humanoid, motion.frames[frame]);
      const auto charts = charts_of(*range, rotations_of(body));
      for (int j = 0; j < kJointCount; ++j)
        EXPECT_EQ(excess(range->joints[j], charts[j]), 0.0)
            << name << " frame " << frame << " joint " << j << " swing " << degrees(charts[j].swing.x())
            << " " << degrees(charts[j].swing.y()) << " twist " << degrees(charts[j].twist);
    }
  }
}

TEST(Mannequin, IdleIsALoopOnPlantedFeet) {
  const Character character = load("mannequin.glb");
  const Clip idle = clip(character, "idle");
  ASSERT_EQ(idle.frames.size(), 61u);
  const Vec3 left = position(character, idle.frames.front(), "LeftFoot");
  for (const Pose& pose : idle.frames) {
    EXPECT_NEAR((position(character, pose, "LeftFoot") - left).norm(), 0.0, 1e-5);
    for (const Vec3& vertex : vertices(character, pose)) ASSERT_GT(vertex.y(), -1e-4);
  }
  for (int n = 0; n < character.skeleton.size(); ++n)
    EXPECT_LT(angle_between(idle.frames.front()[n].rotation, idle.frames.back()[n].rotation), 1e-5);
}

TEST(Mannequin, WalkGoesForwardOneStrideALoop) {
  const Character character = load("mannequin.glb");
  const Clip walk = clip(character, "walk");
  const Vec3 moved =
      position(character, walk.frames.back(), "Hips") - position(character, walk.frames.front(), "Hips");
  EXPECT_NEAR(moved.z() / walk.duration_s(), kWalkSpeed, 0.01);
  EXPECT_NEAR(moved.x(), 0.0, 1e-5);
  EXPECT_NEAR(moved.y(), 0.0, 1e-5);
  for (int n = 0; n < character.skeleton.size(); ++n)
    EXPECT_LT(angle_between(walk.frames.front()[n].rotation, walk.frames.back()[n].rotation), 1e-5);
}

TEST(Mannequin, WalkKeepsTheStandingFootWhereItIs) {
  const Character character = load("mannequin.glb");
  const Clip walk = clip(character, "walk");
  const std::size_t frames = walk.frames.size() - 1;
  int standing = 0;
  for (const auto& [foot, toes, strike] :
       {std::tuple{"LeftFoot", "LeftToeBase", 0.0}, {"RightFoot", "RightToeBase", 0.5}}) {
    for (std::size_t i = 0; i + 1 <= frames; ++i) {
      const double phase =
          std::fmod(static_cast<double>(i) / static_cast<double>(frames) + 1.0 - strike, 1.0);
      const auto slide = [&](const char* node) {
        return (position(character, walk.frames[i + 1], node) - position(character, walk.frames[i], node))
            .norm();
      };
      if (phase > 0.10 && phase < 0.34) {
        EXPECT_LT(slide(foot), 1e-4) << foot << " frame " << i;
        ++standing;
      }
      if (phase > 0.10 && phase < 0.57) {
        EXPECT_LT(slide(toes), 1e-3) << toes << " frame " << i;
      }
    }
  }
  EXPECT_GT(standing, 20);
}

TEST(Mannequin, WalkTouchesTheFloorAndNeverSinksIntoIt) {
  const Character character = load("mannequin.glb");
  const Clip walk = clip(character, "walk");
  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    double lowest = 1.0;
    for (const Vec3& vertex : vertices(character, walk.frames[i])) lowest = std::min(lowest, vertex.y());
    EXPECT_GT(lowest, -0.010) << "frame " << i;
    EXPECT_LT(lowest, 0.010) << "frame " << i;
  }
}

TEST(Mannequin, BvhWalksLikeTheGlb) {
  const Character glb = load("mannequin.glb");
  const Character bvh = load("mannequin.bvh");
  ASSERT_EQ(bvh.animations.size(), 1u);
  const Clip walk = clip(glb, "walk");
  const Clip same = sample_clip(bvh.skeleton, bvh.animations.front(), 60.0);
  ASSERT_EQ(same.frames.size(), walk.frames.size());
  int compared = 0;
  for (std::size_t i = 0; i < walk.frames.size(); i += 4) {
    for (const Node& node : bvh.skeleton.nodes) {
      if (glb.skeleton.find(node.name) < 0) continue;
      ++compared;
      const Vec3 here = position(glb, walk.frames[i], node.name);
      EXPECT_LT((0.01 * position(bvh, same.frames[i], node.name) - here).norm(), 1e-5) << node.name;
    }
  }
  EXPECT_GT(compared, 30 * 16);
}

/// Largest difference of the numbers of two files with the same nodes, vertices and keys; infinite otherwise.
double difference(const Character& a, const Character& b) {
  double largest = 0.0;
  const auto compare = [&](auto one, auto other) {
    if (one.size() != other.size()) {
      largest = std::numeric_limits<double>::infinity();
      return;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(one.size()); ++i)
      largest = std::max(largest, std::abs(static_cast<double>(one[i]) - static_cast<double>(other[i])));
  };
  compare(std::vector<int>{a.skeleton.size(), static_cast<int>(a.parts.size()),
                           static_cast<int>(a.animations.size())},
          std::vector<int>{b.skeleton.size(), static_cast<int>(b.parts.size()),
                           static_cast<int>(b.animations.size())});
  if (largest > 0.0) return largest;
  for (int n = 0; n < a.skeleton.size(); ++n)
    compare(a.skeleton.nodes[n].rest.translation, b.skeleton.nodes[n].rest.translation);
  for (std::size_t p = 0; p < a.parts.size(); ++p) {
    const auto numbers = [](const MeshPart& part) {
      std::vector<double> all(part.indices.begin(), part.indices.end());
      for (std::size_t v = 0; v < part.positions.size(); ++v)
        for (int k = 0; k < 3; ++k) all.insert(all.end(), {part.positions[v][k], part.normals[v][k]});
      return all;
    };
    compare(numbers(a.parts[p]), numbers(b.parts[p]));
  }
  for (std::size_t i = 0; i < a.animations.size(); ++i) {
    const auto numbers = [](const Animation& animation) {
      std::vector<double> all;
      for (const Track& track : animation.tracks)
        all.insert(all.end(), track.values.begin(), track.values.end());
      return all;
    };
    compare(numbers(a.animations[i]), numbers(b.animations[i]));
  }
  return largest;
}

TEST(Mannequin, IsWhatItsToolMakes) {
  if (std::system("python3 --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "left out: python3, which tools/make_mannequin needs, is not installed";
  std::string folder = (fs::temp_directory_path() / "ukemi_mannequin_XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string command = "python3 '" UKEMI_TOOLS_FOLDER "/make_mannequin' '" + folder + "' > /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  for (const char* file : {"mannequin.glb", "mannequin.bvh"})
    EXPECT_LT(difference(load(file, folder), load(file)), 1e-4) << file;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace ukemi
