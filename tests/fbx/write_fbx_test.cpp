#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/files.h"
#include "export/puppet.h"
#include "fbx/fbx.h"
#include "fbx/models.h"
#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes written(const Character& character, const Humanoid& humanoid, const Clip& clip,
              const FbxOptions& options = {}, Diagnostics* diagnostics = nullptr) {
  Diagnostics own;
  auto bytes = write_fbx(character, humanoid, clip, options, diagnostics ? *diagnostics : own);
  EXPECT_TRUE(bytes) << bytes.error().message();
  return bytes ? *bytes : Bytes{};
}

Character read(const Bytes& bytes, const fs::path& path = "made.fbx") {
  Diagnostics diagnostics;
  auto character = read_with_assimp(bytes, path, diagnostics);
  EXPECT_TRUE(character) << character.error().message();
  return character ? std::move(*character) : Character{};
}

FbxTree tree_of(const Bytes& bytes) {
  auto tree = read_fbx_tree(bytes, "made.fbx");
  EXPECT_TRUE(tree) << tree.error().message();
  return tree ? std::move(*tree) : FbxTree{};
}

std::map<std::string, Vec3> positions(const Skeleton& skeleton, const Pose& pose, double scale) {
  const auto worlds = world_transforms(skeleton, pose);
  std::map<std::string, Vec3> by_name;
  for (int i = 0; i < skeleton.size(); ++i)
    by_name.try_emplace(skeleton.nodes[i].name, scale * worlds[i].translation());
  return by_name;
}

/// Largest distance of a node from where the clip has it, at every frame, in the units of `metres` of each.
double farthest_m(const Character& read, double metres_read, const Skeleton& skeleton, const Clip& clip,
                  double metres) {
  if (read.animations.empty()) return 1e9;
  double farthest = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const double time_s = static_cast<double>(i) / clip.fps;
    const auto theirs =
        positions(read.skeleton, sample(read.skeleton, read.animations.back(), time_s), metres_read);
    for (const auto& [name, ours] : positions(skeleton, clip.frames[i], metres)) {
      const auto found = theirs.find(name);
      if (found == theirs.end()) continue;
      ++compared;
      farthest = std::max(farthest, (found->second - ours).norm());
    }
  }
  EXPECT_GT(compared, 10);
  return farthest;
}

/// Same bytes, whatever the offsets.
bool same(const FbxRecord& a, const FbxRecord& b) {
  const auto same_property = [](const FbxProperty& x, const FbxProperty& y) {
    return x.type == y.type && x.bytes == y.bytes;
  };
  return a.name == b.name && a.is_closed == b.is_closed &&
         std::equal(a.properties.begin(), a.properties.end(), b.properties.begin(), b.properties.end(),
                    same_property) &&
         std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(), same);
}

/// Every record of the source is in the other, as it was and where it was, but for counts of definitions.
void expect_kept(const FbxTree& source, const FbxTree& other) {
  ASSERT_EQ(source.records.size(), other.records.size());
  EXPECT_EQ(source.version, other.version);
  int compared = 0;
  for (std::size_t i = 0; i < source.records.size(); ++i) {
    const FbxRecord& before = source.records[i];
    const FbxRecord& after = other.records[i];
    ASSERT_EQ(before.name, after.name);
    ASSERT_LE(before.children.size(), after.children.size());
    if (before.name == "Definitions") continue;
    for (std::size_t k = 0; k < before.children.size(); ++k, ++compared)
      EXPECT_TRUE(same(before.children[k], after.children[k])) << before.name << " record " << k;
    const bool grows = before.name == "Objects" || before.name == "Connections" || before.name == "Takes";
    EXPECT_TRUE(grows || before.children.size() == after.children.size()) << before.name;
  }
  EXPECT_GT(compared, 20);
}

struct Made {
  test::Puppet puppet = test::make_puppet();
  Clip clip = test::falling_clip(puppet.character.skeleton, 61);
  Bytes bytes = written(puppet.character, puppet.humanoid, clip);
};

TEST(WriteFbx, AnotherReaderSeesTheClip) {
  const Made made;
  const Character read = ukemi::read(made.bytes);
  ASSERT_EQ(read.animations.size(), 1u);
  EXPECT_EQ(read.animations[0].name, made.clip.name);
  EXPECT_EQ(read.metres_per_unit, 0.01);
  EXPECT_LT(farthest_m(read, 0.01, made.puppet.character.skeleton, made.clip, 1.0), 1e-5);
}

TEST(WriteFbx, TurnsAndScalesTheFileToCentimetresAndYUp) {
  Made made;
  made.puppet.humanoid.world_from_file = {0.0254, exp_rotation(Vec3(-kPi / 2, 0, 0)), Vec3::Zero()};
  const Character read = ukemi::read(written(made.puppet.character, made.puppet.humanoid, made.clip));
  Skeleton turned = made.puppet.character.skeleton;
  Clip clip = made.clip;
  const auto turn = [&](LocalTransform& root) {
    root.rotation = made.puppet.humanoid.world_from_file.rotation * root.rotation;
    root.translation = made.puppet.humanoid.world_from_file.rotation * root.translation;
  };
  for (Pose& pose : clip.frames) turn(pose[0]);
  EXPECT_LT(farthest_m(read, 0.01, turned, clip, 0.0254), 1e-5);
}

/// Mean of all corners of all triangles, and the box around them, as the skin puts them.
struct Outline {
  Vec3 mean = Vec3::Zero();
  Eigen::AlignedBox3d box;
};
Outline outline(const Character& character, const Pose& pose, double scale) {
  const auto worlds = world_transforms(character.skeleton, pose);
  Outline result;
  double corners = 0;
  for (const MeshPart& part : character.parts)
    for (const std::uint32_t v : part.indices) {
      const Vec3 bound = part.positions[v].cast<double>();
      Vec3 point = part.skin < 0 ? Vec3(worlds[part.node] * bound) : Vec3(Vec3::Zero());
      for (std::size_t k = 0; part.skin >= 0 && k < 4; ++k) {
        const Skin& skin = character.skins[part.skin];
        const auto joint = part.joints[v][k];
        point += static_cast<double>(part.weights[v][k]) *
                 (worlds[skin.joints[joint]] * (skin.inverse_bind[joint] * bound));
      }
      result.mean += scale * point;
      result.box.extend(Vec3(scale * point));
      ++corners;
    }
  result.mean /= corners;
  return result;
}

TEST(WriteFbx, SkinFollowsTheBones) {
  Diagnostics diagnostics;
  const fs::path path = fs::path(UKEMI_ASSETS_FOLDER) / "characters" / "mannequin.glb";
  auto character = load_character(path, {}, diagnostics);
  ASSERT_TRUE(character);
  auto humanoid = map_humanoid(*character, {}, diagnostics);
  ASSERT_TRUE(humanoid);
  Clip clip{"wave", 30.0, {}, {}};
  for (int i = 0; i <= 30; ++i) {
    Pose pose = rest_pose(character->skeleton);
    for (LocalTransform& local : pose)
      local.rotation = local.rotation * exp_rotation(Vec3(0.01 * i, 0.005 * i, 0));
    pose[humanoid->root].translation += Vec3(0.01 * i, 0, 0);
    clip.frames.push_back(std::move(pose));
  }
  const Character read = ukemi::read(written(*character, *humanoid, clip));
  ASSERT_EQ(read.skins.size(), character->skins.size());
  EXPECT_EQ(read.materials.size(), character->materials.size());
  EXPECT_EQ(read.images.size(), character->images.size());
  for (const std::size_t frame : {std::size_t{0}, std::size_t{15}, std::size_t{30}}) {
    const Outline ours = outline(*character, clip.frames[frame], 1.0);
    const Pose pose = sample(read.skeleton, read.animations.at(0), static_cast<double>(frame) / 30.0);
    const Outline theirs = outline(read, pose, 0.01);
    EXPECT_LT((ours.mean - theirs.mean).norm(), 1e-4) << frame;
    EXPECT_LT((ours.box.min() - theirs.box.min()).norm(), 1e-4) << frame;
    EXPECT_LT((ours.box.max() - theirs.box.max()).norm(), 1e-4) << frame;
  }
}

TEST(WriteFbx, IntoASourceNothingElseChanges) {
  const Made made;
  const Character source = read(made.bytes);
  Clip clip = test::falling_clip(made.puppet.character.skeleton, 31);
  // The source's nodes are the puppet's behind the scene's node, in its order, in centimetres.
  std::map<std::string, int> puppet_node;
  for (int i = 0; i < made.puppet.character.skeleton.size(); ++i)
    puppet_node.emplace(made.puppet.character.skeleton.nodes[i].name, i);
  for (Pose& pose : clip.frames) {
    Pose theirs = rest_pose(source.skeleton);
    for (int i = 0; i < source.skeleton.size(); ++i) {
      const auto found = puppet_node.find(source.skeleton.nodes[i].name);
      if (found == puppet_node.end()) continue;
      theirs[i] = pose[found->second];
      theirs[i].translation *= 100.0;
    }
    pose = std::move(theirs);
  }
  const Bytes twice = written(source, made.puppet.humanoid, clip, {made.bytes, "made.fbx", false});
  expect_kept(tree_of(made.bytes), tree_of(twice));
  const Character read = ukemi::read(twice);
  ASSERT_EQ(read.animations.size(), 2u);
  EXPECT_EQ(read.animations[1].name, clip.name + "_2") << "a name of its own";
  EXPECT_LT(farthest_m(read, 0.01, source.skeleton, clip, 0.01), 1e-5);

  const Bytes bare = written(source, made.puppet.humanoid, clip, {made.bytes, "made.fbx", true});
  EXPECT_LT(bare.size(), twice.size());
  const Character clip_only = ukemi::read(bare);
  EXPECT_EQ(clip_only.animations.size(), 1u);
  EXPECT_TRUE(clip_only.parts.empty());
}

/// Gives the model of that name two limits: one that every rotation leaves, and one that none does.
Bytes with_limits(const Bytes& bytes, const std::string& name) {
  FbxTree tree = tree_of(bytes);
  for (FbxRecord& object : section(tree, "Objects")->children) {
    if (object.name != "Model" || object_title(object) != name) continue;
    auto& properties = child_of(object, "Properties70")->children;
    const auto vector = [](double v) {
      return std::vector<FbxProperty>{fbx_double(v), fbx_double(v), fbx_double(v)};
    };
    properties.push_back(property_record("RotationMinX", "bool", "", "", {fbx_int(1)}));
    properties.push_back(property_record("RotationMaxX", "bool", "", "", {fbx_int(1)}));
    properties.push_back(property_record("RotationMin", "Vector3D", "Vector", "", vector(-0.01)));
    properties.push_back(property_record("RotationMax", "Vector3D", "Vector", "", vector(9999)));
  }
  auto result = write_fbx_tree(tree, "made.fbx");
  EXPECT_TRUE(result);
  return *result;
}

std::int64_t switch_of(const FbxTree& tree, const std::string& model, const std::string& name) {
  for (const FbxRecord& object : section(tree, "Objects")->children)
    if (object.name == "Model" && object_title(object) == model)
      for (const FbxRecord& record : child_of(object, "Properties70")->children)
        if (text_at(record, 0) == name) return integer_at(record, 4).value_or(-1);
  return -1;
}

TEST(WriteFbx, LimitsThatTheClipLeavesAreSwitchedOff) {
  const Made made;
  const Bytes limited = with_limits(made.bytes, "Spine");
  const Character source = read(limited);
  Clip clip{"bow", 60.0, {}, {}};
  const int spine = source.skeleton.find("Spine");
  ASSERT_GE(spine, 0);
  for (const double angle : {0.0, -0.5, -1.0}) {
    clip.frames.push_back(rest_pose(source.skeleton));
    LocalTransform& local = clip.frames.back()[spine];
    local.rotation = local.rotation * exp_rotation(Vec3(angle, 0, 0));
  }
  Diagnostics diagnostics;
  const FbxTree tree =
      tree_of(written(source, made.puppet.humanoid, clip, {limited, "made.fbx", false}, &diagnostics));
  EXPECT_EQ(switch_of(tree, "Spine", "RotationMinX"), 0);
  EXPECT_EQ(switch_of(tree, "Spine", "RotationMaxX"), 1) << "kept to, so it stays";
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("'Spine'"), std::string::npos);
}

TEST(WriteFbx, RefusesASourceOfAnotherSkeleton) {
  const Made made;
  Character source = read(made.bytes);
  Clip clip{"x", 60.0, {rest_pose(source.skeleton)}, {}};
  const int hips = source.skeleton.find("Hips");
  clip.frames[0][hips].translation.x() += 1.0;
  source.skeleton.nodes[hips].name = "Pelvis";
  Diagnostics diagnostics;
  const auto renamed =
      write_fbx(source, made.puppet.humanoid, clip, {made.bytes, "made.fbx", false}, diagnostics);
  ASSERT_FALSE(renamed);
  EXPECT_NE(renamed.error().message().find("joint 'Pelvis': has no model"), std::string::npos)
      << renamed.error().message();
  source.skeleton.nodes[hips].name = "Hips";
  source.skeleton.nodes[hips].rest.translation.y() += 1.0;
  const auto moved =
      write_fbx(source, made.puppet.humanoid, clip, {made.bytes, "made.fbx", false}, diagnostics);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().message().find("stands elsewhere"), std::string::npos) << moved.error().message();
}

TEST(WriteFbx, FilesOfOthersAreKeptAndReproduceAnyMotion) {
  const auto data = extra_data();
  if (!data) GTEST_SKIP() << kNoExtraData;
  int files = 0;
  for (const char* prefix : {"characters/quaternius_fbx/", "characters/ozz_pab_fbx/", "mocap/cmu_fbx/"})
    for (const ExtraFile& file : extra_files(*data, prefix)) {
      SCOPED_TRACE(file.file);
      const fs::path path = *data / file.file;
      const auto bytes = read_file(path, 1u << 30);
      ASSERT_TRUE(bytes);
      const FbxTree before = tree_of(*bytes);
      const auto again = write_fbx_tree(before, path);
      ASSERT_TRUE(again);
      EXPECT_EQ(*again, *bytes) << "read and written, byte for byte";
      const Character source = read(*bytes, path);
      Clip clip{"sway", 60.0, {}, {}};
      for (int i = 0; i <= 20; ++i) {
        clip.frames.push_back(rest_pose(source.skeleton));
        for (int node = 1; node < source.skeleton.size(); ++node) {
          LocalTransform& local = clip.frames.back()[node];
          local.rotation =
              local.rotation * exp_rotation(Vec3(0.03 * i, -0.02 * i, 0.05 * i) / (1 + node % 5));
        }
      }
      const Bytes made = written(source, {}, clip, {*bytes, path, false});
      const Character read = ukemi::read(made, path);
      const double size = (outline(source, rest_pose(source.skeleton), 1.0).box.sizes()).norm();
      const double metres = source.parts.empty() ? 0.01 : 1.8 / std::max(size, 1e-6);
      EXPECT_LT(farthest_m(read, metres, source.skeleton, clip, metres), 1e-4);
      ++files;
    }
  EXPECT_GE(files, 12);
}

TEST(WriteFbx, TheTakeBeginsAtZeroAndLastsAsLongAsTheClip) {
  constexpr std::int64_t kSecond = 46186158000;  // ticks
  const test::Puppet puppet = test::make_puppet();
  const Clip clip = test::falling_clip(puppet.character.skeleton, 91, 60.0);
  FbxTree tree = tree_of(written(puppet.character, puppet.humanoid, clip));
  const FbxRecord* objects = section(tree, "Objects");
  ASSERT_NE(objects, nullptr);
  std::map<std::string, std::int64_t> spans;
  int curves = 0;
  for (const FbxRecord& object : objects->children) {
    if (object.name == "AnimationStack")
      for (const FbxRecord& property : child_of(object, "Properties70")->children)
        spans[std::string(*text_at(property, 0))] = *integer_at(property, 4);
    if (object.name != "AnimationCurve") continue;
    ++curves;
    const auto ticks = numbers_at(*child_of(object, "KeyTime"), 0);
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->front(), 0.0);
    EXPECT_EQ(ticks->back(), 1.5 * static_cast<double>(kSecond));
  }
  EXPECT_GT(curves, 100);
  EXPECT_EQ(spans["LocalStart"], 0);
  EXPECT_EQ(spans["LocalStop"], kSecond * 3 / 2);
}

}  // namespace
}  // namespace ukemi
