#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "export/euler.h"
#include "export/export.h"
#include "export/puppet.h"
#include "load/load.h"
#include "support/random.h"

namespace ukemi {
namespace {

Diagnostics diagnostics;

constexpr const char* kSource = R"(HIERARCHY
ROOT Hips of mine
{
	OFFSET 1 2 3
	CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition Zposition
	JOINT Spine
	{
		OFFSET 0 10.25 0
		CHANNELS 3 Yrotation Zrotation Xrotation
		JOINT Hinge
		{
			OFFSET 0 5 0.1
			CHANNELS 1 Xrotation
			End Site
			{
				OFFSET 0 3 0
			}
		}
		JOINT Fixed
		{
			OFFSET 4 0 0
			CHANNELS 0
			JOINT Slider
			{
				OFFSET 1 1 1
				CHANNELS 6 Zposition Xposition Yposition Yrotation Xrotation Zrotation
				End Site
				{
					OFFSET -1e-05 0 2
				}
			}
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.008333333333333333
10 20 30 1 2 3 40 50 60 70 5 6 7 -10 -20 -30
11 21 31 1 2 3 41 51 61 71 5 6 8 -11 -21 -31
)";

Character load(const std::string& text) {
  auto character = read_bvh(text, "source.bvh", diagnostics);
  if (!character) throw std::runtime_error(character.error().message());
  return std::move(*character);
}

Clip own_clip(const Character& character) {
  return sample_clip(character.skeleton, character.animations[0], character.animations[0].fps);
}

double largest_turn_deg(const Clip& a, const Clip& b) {
  double largest = a.frames.size() == b.frames.size() ? 0.0 : 180.0;
  for (std::size_t f = 0; f < std::min(a.frames.size(), b.frames.size()); ++f)
    for (std::size_t i = 0; i < a.frames[f].size(); ++i)
      largest = std::max(largest, degrees(angle_between(a.frames[f][i].rotation, b.frames[f][i].rotation)));
  return largest;
}

/// Between the joints of a BVH in centimetres and the nodes of the same name, metres.
double largest_distance_m(const Skeleton& skeleton, const Clip& clip, const Character& bvh) {
  const Clip read = own_clip(bvh);
  EXPECT_EQ(read.frames.size(), clip.frames.size());
  double largest_m = 0.0;
  for (std::size_t f = 0; f < std::min(clip.frames.size(), read.frames.size()); ++f) {
    const auto wanted = world_transforms(skeleton, clip.frames[f]);
    const auto seen = world_transforms(bvh.skeleton, read.frames[f]);
    for (int i = 0; i < bvh.skeleton.size(); ++i) {
      const Vec3 at = wanted.at(skeleton.find(bvh.skeleton.nodes[i].name)).translation();
      largest_m = std::max(largest_m, (0.01 * seen[i].translation() - at).norm());
    }
  }
  return largest_m;
}

/// Any rotation at all, and runs of them ever nearer to where the middle axis of three is at a quarter turn.
std::vector<Quat> rotations_of_every_kind(const AxisOrder& order, unsigned seed) {
  Random random(seed);
  const auto angle = [&] { return random.uniform(-kPi, kPi); };
  std::vector<Quat> rotations;
  for (int i = 0; i < 300; ++i) rotations.push_back(from_euler({angle(), angle(), angle()}, order));
  for (const double quarter : {kPi / 2, -kPi / 2})
    for (double off = 0.1; off > 1e-18; off /= 2) {
      rotations.push_back(from_euler({angle(), quarter + off, angle()}, order));
      rotations.push_back(from_euler({0.3, quarter - off, off}, order));
    }
  for (const double turn : {0.0, kPi, -kPi, kPi / 2, 2 * kPi})
    rotations.push_back(from_euler({turn, 0, turn}, order));
  return rotations;
}

TEST(WriteBvh, WritesASourceBackAsItWas) {
  const Character character = load(kSource);
  const auto text = write_bvh(character, {}, own_clip(character), {}, diagnostics);
  ASSERT_TRUE(text);
  const std::string_view source = kSource;
  EXPECT_EQ(text->substr(0, text->find("Frame Time")), source.substr(0, source.find("Frame Time")))
      << "names, offsets, channels and End Sites";
  const Character again = load(*text);
  ASSERT_EQ(again.bvh->frames.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t c = 0; c < again.bvh->frames[f].size(); ++c)
      EXPECT_NEAR(again.bvh->frames[f][c], character.bvh->frames[f][c], 1e-12) << f << ' ' << c;
  EXPECT_DOUBLE_EQ(again.bvh->frame_time_s, 1.0 / 120);
}

TEST(WriteBvh, GivesTheSameRotationsToAMillionthOfADegree) {
  Character character = load(kSource);
  character.bvh->channels[2] = character.bvh->channels[1];  // the hinge turns freely
  character.bvh->channels[3] = {};
  Clip clip = test::falling_clip(character.skeleton, 300);
  for (Pose& pose : clip.frames) pose[3].rotation = Quat::Identity();
  const auto text = write_bvh(character, {}, clip, {}, diagnostics);
  ASSERT_TRUE(text);
  EXPECT_LT(largest_turn_deg(own_clip(load(*text)), clip), 1e-6);
}

constexpr AxisOrder kOrders[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};

TEST(WriteBvh, GivesBackEveryRotationInEveryOrderOfChannels) {
  for (const AxisOrder& order : kOrders) {
    Character character = load(kSource);
    std::vector<BvhChannel> channels;
    for (const int axis : order)
      channels.push_back(static_cast<BvhChannel>(static_cast<int>(BvhChannel::x_rotation) + axis));
    character.bvh->channels[1] = channels;
    character.bvh->channels[2] = channels;
    const std::vector<Quat> first = rotations_of_every_kind(order, 1);
    const std::vector<Quat> second = rotations_of_every_kind(order, 2);
    Clip clip{"all", 60, {}, {}};
    for (std::size_t i = 0; i < first.size(); ++i) {
      clip.frames.push_back(rest_pose(character.skeleton));
      clip.frames.back()[1].rotation = first[i];
      clip.frames.back()[2].rotation = second[first.size() - 1 - i];
    }
    const auto text = write_bvh(character, {}, clip, {}, diagnostics);
    ASSERT_TRUE(text);
    EXPECT_LT(largest_turn_deg(own_clip(load(*text)), clip), 1e-6);
  }
}

TEST(WriteBvh, GivesBackEveryRotationOfItsOwnHierarchy) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const std::vector<Quat> rotations = rotations_of_every_kind({2, 1, 0}, 3);
  Clip clip{"all", 60, {}, {}};
  for (std::size_t f = 0; f < rotations.size(); ++f) {
    clip.frames.push_back(rest_pose(skeleton));
    for (std::size_t i = 1; i < clip.frames[f].size(); ++i)
      clip.frames[f][i].rotation = clip.frames[f][i].rotation * rotations[(f + 7 * i) % rotations.size()];
  }
  const auto text = write_bvh(puppet.character, puppet.humanoid, clip, {}, diagnostics);
  ASSERT_TRUE(text);
  const Character bvh = load(*text);
  const Clip read = own_clip(bvh);
  const auto rest = world_transforms(skeleton, rest_pose(skeleton));
  double largest_deg = 0.0;
  for (std::size_t f = 0; f < rotations.size(); ++f) {
    const auto wanted = world_transforms(skeleton, clip.frames[f]);
    const auto seen = world_transforms(bvh.skeleton, read.frames[f]);
    for (int i = 0; i < bvh.skeleton.size(); ++i) {
      const int node = skeleton.find(bvh.skeleton.nodes[i].name);
      const Quat turned =
          rotation_part(wanted[node].linear()) * rotation_part(rest[node].linear()).conjugate();
      largest_deg = std::max(largest_deg, degrees(angle_between(rotation_part(seen[i].linear()), turned)));
    }
  }
  EXPECT_LT(largest_deg, 1e-6);
}

TEST(WriteBvh, LetsAnglesRunOnInsteadOfJumping) {
  Character character = load(kSource);
  Clip clip{"spin", 60, {}, {}};
  for (int f = 0; f < 240; ++f) {
    clip.frames.push_back(rest_pose(character.skeleton));
    clip.frames.back()[0].rotation = exp_rotation(Vec3(0.1, 1.0, 0.2).normalized() * (0.08 * f));
  }
  const auto text = write_bvh(character, {}, clip, {}, diagnostics);
  ASSERT_TRUE(text);
  const Character again = load(*text);
  double largest = 0.0;
  for (std::size_t f = 1; f < again.bvh->frames.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(again.bvh->frames[f][c] - again.bvh->frames[f - 1][c]));
  EXPECT_LT(largest, 12.0) << "4.6 degrees of turn per frame";
  EXPECT_GT(again.bvh->frames.back()[2], 1000.0);
}

TEST(WriteBvh, BuildsItsOwnHierarchyForOtherSources) {
  test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Clip clip = test::falling_clip(skeleton);
  const auto text = write_bvh(puppet.character, puppet.humanoid, clip, {}, diagnostics);
  ASSERT_TRUE(text);
  const Character bvh = load(*text);
  EXPECT_EQ(bvh.skeleton.size(), 20) << "the nodes of the chains";
  EXPECT_TRUE(bvh.skeleton.nodes[0].rest.translation.isZero());
  EXPECT_EQ(bvh.bvh->channels[0].size(), 6u);
  for (int i = 1; i < bvh.skeleton.size(); ++i) EXPECT_EQ(bvh.bvh->channels[i].size(), 3u);
  EXPECT_LT(largest_distance_m(skeleton, clip, bvh), 1e-12);
}

TEST(WriteBvh, TakesTheLengthsOfBonesFromTheClip) {
  test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  Clip clip = test::falling_clip(skeleton);
  for (Pose& pose : clip.frames) {
    pose[skeleton.find("LeftLeg")].translation += Vec3(1, -3, 2);
    pose[skeleton.find("Hips")].scale = Vec3::Constant(1.1);
    pose[skeleton.find("Spine")].scale = Vec3::Constant(0.9);
  }
  const auto text = write_bvh(puppet.character, puppet.humanoid, clip, {}, diagnostics);
  ASSERT_TRUE(text);
  EXPECT_LT(largest_distance_m(skeleton, clip, load(*text)), 1e-12);
}

TEST(WriteBvh, HangsDetachedFeetOnTheSegmentAbove) {
  test::Puppet puppet = test::make_puppet();
  Skeleton& skeleton = puppet.character.skeleton;
  const int foot = skeleton.find("LeftFoot");
  const Affine rest = world_transforms(skeleton, rest_pose(skeleton))[foot];
  skeleton.nodes[foot].parent = -1;
  skeleton.nodes[foot].rest = {rest.translation(), rotation_part(rest.linear()), Vec3::Constant(0.01)};
  ASSERT_TRUE(skeleton.sort());
  puppet.humanoid.reference = rest_pose(skeleton);
  puppet.humanoid.segments[index(Segment::foot_l)].detached = true;
  const auto text =
      write_bvh(puppet.character, puppet.humanoid, {"still", 30, {rest_pose(skeleton)}, {}}, {}, diagnostics);
  ASSERT_TRUE(text);
  const Character bvh = load(*text);
  const int written = bvh.skeleton.find("LeftFoot");
  ASSERT_GE(written, 0);
  EXPECT_EQ(bvh.skeleton.nodes[bvh.skeleton.nodes[written].parent].name, "LeftLeg");
  EXPECT_LT((bvh.skeleton.nodes[written].rest.translation - Vec3(0, -42, -2)).norm(), 1e-9);
}

TEST(WriteBvh, SaysItsUnitWhereReadersSkipIt) {
  const test::Puppet puppet = test::make_puppet();
  for (const double unit : {0.01, 1.0}) {
    const auto text = write_bvh(puppet.character, puppet.humanoid,
                                test::falling_clip(puppet.character.skeleton, 2), {unit}, diagnostics);
    ASSERT_TRUE(text);
    EXPECT_EQ(text->find("End Site unit="), text->find("End Site"));
    EXPECT_EQ(load(*text).metres_per_unit.value(), unit);
    // Once, and it stays when the file goes through the program again.
    const Character again = load(*text);
    const auto second = write_bvh(again, {}, own_clip(again), {}, diagnostics);
    ASSERT_TRUE(second);
    EXPECT_EQ(load(*second).metres_per_unit.value(), unit);
    EXPECT_EQ(second->find("unit="), second->rfind("unit="));
  }
}

TEST(WriteBvh, HoldsAFigureBelowAMirror) {
  test::Puppet puppet = test::make_puppet();
  Skeleton& skeleton = puppet.character.skeleton;
  Clip clip = test::falling_clip(skeleton);
  int armature = skeleton.find("Hips");
  while (skeleton.nodes[armature].parent >= 0) armature = skeleton.nodes[armature].parent;
  ASSERT_NE(armature, puppet.humanoid.root);
  skeleton.nodes[armature].rest.scale.x() *= -1.0;
  for (Pose& pose : clip.frames) pose[armature].scale.x() *= -1.0;
  puppet.humanoid.reference = rest_pose(skeleton);
  Diagnostics said;
  const auto text = write_bvh(puppet.character, puppet.humanoid, clip, {}, said);
  ASSERT_TRUE(text);
  EXPECT_LT(largest_distance_m(skeleton, clip, load(*text)), 1e-12);
  EXPECT_TRUE(said.warnings().empty());
}

TEST(WriteBvh, SaysWhichJointItCannotHold) {
  test::Puppet puppet = test::make_puppet();
  Clip clip = test::falling_clip(puppet.character.skeleton);
  clip.frames[7][puppet.character.skeleton.find("LeftLeg")].translation.y() -= 0.2;
  Diagnostics said;
  ASSERT_TRUE(write_bvh(puppet.character, puppet.humanoid, clip, {}, said));
  ASSERT_EQ(said.warnings().size(), 1u);
  EXPECT_NE(said.warnings()[0].what.find("2.0 mm"), std::string::npos) << said.warnings()[0].what;
  EXPECT_NE(said.warnings()[0].what.find("'LeftLeg'"), std::string::npos);
}

/// Hips below a root; the hips have rotation channels only, or all six.
std::string with_hips_below_root(const std::string& hips_channels) {
  return "HIERARCHY\nROOT Root\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation "
         "Xrotation "
         "Yrotation\n JOINT Hips\n {\n  OFFSET 0 90 0\n  CHANNELS " +
         hips_channels +
         "\n  End Site\n  {\n   OFFSET 0 50 0\n  }\n }\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n";
}

TEST(WriteBvh, HipsWithoutPositionChannelsMoveTheRootAboveThem) {
  const Character character =
      load(with_hips_below_root("3 Zrotation Xrotation Yrotation") + "1 2 3 10 20 30 40 50 60\n");
  Humanoid humanoid;
  humanoid.root = 1;
  humanoid.world_from_file.scale = 0.01;
  Clip clip = own_clip(character);
  clip.frames.push_back(clip.frames[0]);
  clip.frames[1][1].translation = Vec3(30, 20, -60);
  Diagnostics said;
  const auto text = write_bvh(character, humanoid, clip, {}, said);
  ASSERT_TRUE(text);
  EXPECT_TRUE(said.warnings().empty());
  const Character again = load(*text);
  const Clip read = own_clip(again);
  for (std::size_t f = 0; f < 2; ++f) {
    const Affine wanted = world_transforms(character.skeleton, clip.frames[f])[1];
    const Affine seen = world_transforms(again.skeleton, read.frames[f])[1];
    EXPECT_LT((wanted.matrix() - seen.matrix()).norm(), 1e-9);
  }
}

TEST(WriteBvh, PositionsThatAreAddedToOffsetsAreWrittenSo) {
  const Character character =
      load(with_hips_below_root("6 Xposition Yposition Zposition Zrotation Xrotation Yrotation") +
           "1 2 3 10 20 30 0 1 0 40 50 60\n");
  ASSERT_TRUE(character.bvh->positions_add);
  const auto text = write_bvh(character, {}, own_clip(character), {}, diagnostics);
  ASSERT_TRUE(text);
  const Character again = load(*text);
  for (std::size_t c = 0; c < 12; ++c)
    EXPECT_NEAR(again.bvh->frames[0][c], character.bvh->frames[0][c], 1e-12);
}

TEST(WriteBvh, RefusesAClipThatIsNotOfTheSkeleton) {
  const test::Puppet puppet = test::make_puppet();
  EXPECT_FALSE(write_bvh(puppet.character, puppet.humanoid, {"empty", 60, {}, {}}, {}, diagnostics));
  EXPECT_FALSE(write_bvh(puppet.character, puppet.humanoid, {"other", 60, {Pose(3)}, {}}, {}, diagnostics));
  EXPECT_FALSE(
      write_bvh(puppet.character, {}, test::falling_clip(puppet.character.skeleton, 2), {}, diagnostics));
}

}  // namespace
}  // namespace ukemi
