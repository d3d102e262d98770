#include "bake/bake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bake/other_man.h"
#include "bake/response.h"
#include "clip/ground_motion.h"
#include "clip/root_motion.h"
#include "clip/smooth.h"
#include "clip/start.h"
#include "export/additive.h"
#include "load/load.h"
#include "prepare/direction.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

const Character& mannequin() {
  static const Character character = [] {
    Diagnostics diagnostics;
    auto loaded =
        load_character(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb", {}, diagnostics);
    EXPECT_TRUE(loaded);
    return std::move(*loaded);
  }();
  return character;
}

/// A blow to the head, half a second of it.
BakeSettings flinch() {
  BakeSettings settings;
  settings.hit = Segment::head;
  settings.preset = "punch";
  settings.simulation.duration_s = 0.5;
  return settings;
}

BakedClip baked(const BakeSettings& settings) {
  Diagnostics diagnostics;
  auto outcome = bake(mannequin(), settings, diagnostics);
  EXPECT_TRUE(outcome) << outcome.error().message();
  return std::move(*outcome);
}

const BakedClip& plain() {
  static const BakedClip outcome = baked(flinch());
  return outcome;
}

Result<ExportedClip> exported_of(const BakedClip& outcome, const BakeSettings& settings) {
  return exported_clip(mannequin(), outcome.prepared.humanoid,
                       outcome.prepared.start.segments[index(Segment::pelvis)], outcome.timeline.clip,
                       settings.ground);
}

double largest_turn_deg(const Pose& a, const Pose& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, degrees(angle_between(a[i].rotation, b[i].rotation)));
  return largest;
}

double lowest_joint_m(const BakedClip& outcome, const Pose& pose) {
  double low = 1e9;
  for (const Affine& node : world_transforms(mannequin().skeleton, pose))
    low = std::min(low, (outcome.prepared.humanoid.world_from_file * Vec3(node.translation())).y());
  return low;
}

TEST(Lead, HoldsTheStartPoseAndLeavesTheImpactFrameAsItIs) {
  BakeSettings settings = flinch();
  settings.lead_s = 0.25;
  const BakedClip outcome = baked(settings);
  ASSERT_EQ(outcome.timeline.clip.frames.size(), plain().timeline.clip.frames.size() + 15);
  ASSERT_EQ(outcome.timeline.trajectory.frames.size(), outcome.timeline.clip.frames.size());
  EXPECT_DOUBLE_EQ(outcome.timeline.impact_s, 0.25);
  for (std::size_t f = 0; f < outcome.timeline.clip.frames.size(); ++f) {
    const Pose& expected = f < 15 ? outcome.prepared.start.pose : plain().timeline.clip.frames[f - 15];
    EXPECT_LT(largest_turn_deg(outcome.timeline.clip.frames[f], expected), 1e-9) << f;
  }
  for (const Mark& mark : outcome.timeline.clip.marks) {
    if (mark.name == "start") {
      EXPECT_EQ(mark.time_s, 0.0);
    } else if (mark.name == "impact") {
      EXPECT_DOUBLE_EQ(mark.time_s, 0.25);
    }
  }
}

TEST(Tail, GoesOnAfterRestForAsLongAsAskedOrToTheEndOfTheSimulation) {
  BakeSettings settings;
  settings.preset = "punch";
  settings.strength = 0.3;
  settings.simulation.duration_s = 3.0;
  for (const double hold_s : {0.1, 0.4}) {
    settings.hold_s = hold_s;
    const BakedClip outcome = baked(settings);
    ASSERT_TRUE(outcome.figures.rest_time_s);
    ASSERT_LT(*outcome.figures.rest_time_s, 2.5);
    EXPECT_NEAR(outcome.timeline.clip.duration_s(), *outcome.figures.rest_time_s + hold_s, 1.0 / 60.0);
  }
  settings.until_rest = false;
  EXPECT_NEAR(baked(settings).timeline.clip.duration_s(), 3.0, 1e-9);
}

TEST(Recovery, EndsInTheStartPoseOnTheFloorWithoutAPop) {
  BakeSettings settings = flinch();
  settings.recover_s = 0.5;
  const BakedClip outcome = baked(settings);
  const auto& frames = outcome.timeline.clip.frames;
  const std::size_t cut = plain().timeline.clip.frames.size() - 1;
  ASSERT_EQ(frames.size(), cut + 1 + 30);
  EXPECT_LT(largest_turn_deg(frames[cut], plain().timeline.clip.frames[cut]), 1e-9) << "the simulation stays";
  for (int i = 0; i < mannequin().skeleton.size(); ++i) {
    if (i == outcome.prepared.humanoid.root) continue;
    EXPECT_LT(degrees(angle_between(frames.back()[i].rotation, outcome.prepared.start.pose[i].rotation)),
              1e-6);
  }
  EXPECT_LT(largest_turn_deg(frames.back(), frames[frames.size() - 2]), 0.2) << "arrives at rest";
  double before = 0.0;
  for (std::size_t f = 1; f <= cut; ++f)
    before = std::max(before, largest_turn_deg(frames[f - 1], frames[f]));
  for (std::size_t f = cut + 1; f < frames.size(); ++f) {
    EXPECT_LT(largest_turn_deg(frames[f - 1], frames[f]), 1.5 * before) << f;
    EXPECT_GT(lowest_joint_m(outcome, frames[f]), -0.005) << f;
  }
}

TEST(Recovery, OfWhoLiesIsRefusedAndNamesTheWay) {
  BakeSettings settings;
  settings.behaviour = Behaviour::limp;
  settings.recover_s = 1.5;
  Diagnostics diagnostics;
  const auto outcome = bake(mannequin(), settings, diagnostics);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().fix.find("--get-up"), std::string::npos);
}

TEST(GettingUp, LiesAsLongAsAskedThenStandsInTheStartPose) {
  BakeSettings settings;
  settings.behaviour = Behaviour::limp;
  settings.get_up_s = 0.5;
  const BakedClip outcome = baked(settings);
  ASSERT_TRUE(outcome.get_up);
  ASSERT_TRUE(outcome.figures.rest_time_s);
  EXPECT_NEAR(outcome.get_up->begins_s, *outcome.figures.rest_time_s + 0.5, 0.02);
  EXPECT_NEAR(outcome.get_up->stands_s, outcome.timeline.clip.duration_s(), 1.0 / 60.0);
  const auto& frames = outcome.timeline.clip.frames;
  ASSERT_EQ(frames.size(), outcome.timeline.trajectory.frames.size());
  for (int i = 0; i < mannequin().skeleton.size(); ++i) {
    if (i == outcome.prepared.humanoid.root) continue;
    EXPECT_LT(degrees(angle_between(frames.back()[i].rotation, outcome.prepared.start.pose[i].rotation)),
              0.1);
  }
  const auto& marks = outcome.timeline.clip.marks;
  for (const char* name : {"get_up", "rises", "stands"})
    EXPECT_TRUE(std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.name == name; }))
        << name;
  for (std::size_t f = 0; f < frames.size(); ++f) EXPECT_GT(lowest_joint_m(outcome, frames[f]), -0.01) << f;
}

TEST(GettingUp, LeavesWhoStandsAlone) {
  BakeSettings settings = flinch();
  const std::size_t frames = baked(settings).timeline.clip.frames.size();
  settings.get_up_s = 0.0;
  const BakedClip outcome = baked(settings);
  EXPECT_FALSE(outcome.get_up);
  EXPECT_LE(outcome.timeline.clip.frames.size(), frames);
}

TEST(Recovery, ToAClipNeedsOne) {
  BakeSettings settings = flinch();
  settings.recover_s = 0.5;
  settings.recover_to = RecoverTo::clip;
  Diagnostics diagnostics;
  const auto outcome = bake(mannequin(), settings, diagnostics);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().what, "--return-to clip needs a start clip to go back to");
}

/// Hit on the chest while he walks, by so much of what the ball has.
BakeSettings hit_while_walking(double strength) {
  BakeSettings settings;
  settings.clip = "walk";
  settings.at_s = 0.278;
  settings.recover_to = RecoverTo::clip;
  settings.scene = strength > 0.0 ? SceneKind::impulse : SceneKind::none;
  settings.strength = strength > 0.0 ? strength : 1.0;
  return settings;
}

/// The last frame is the clip at the moment that the body has come to, wherever he is by then.
void expect_goes_on(const BakedClip& outcome) {
  ASSERT_TRUE(outcome.behaviour.goes_on);
  EXPECT_FALSE(outcome.behaviour.fall_begins_s);
  EXPECT_LT(outcome.timeline.clip.duration_s(), 3.0);
  EXPECT_GT(outcome.returns_s, 0.1);
  const Clip& clip = outcome.timeline.clip;
  const int frames = static_cast<int>(std::ceil(outcome.returns_s * clip.fps - 1e-9));
  const Pose there = unhit_pose(mannequin().skeleton, outcome.prepared.humanoid, outcome.prepared.start,
                                outcome.behaviour.goes_on->moment_s + frames / clip.fps);
  const Pose& last = clip.frames.back();
  const int hips = outcome.prepared.humanoid.segments[index(Segment::pelvis)].node();
  for (int i = 0; i < mannequin().skeleton.size(); ++i) {
    if (i == hips) continue;
    EXPECT_LT(degrees(angle_between(last[i].rotation, there[i].rotation)), 0.01) << i;
  }
  EXPECT_EQ(outcome.limits.over_1deg, 0);
}

TEST(GoingOn, WhoWalksUnhitWalksOn) { expect_goes_on(baked(hit_while_walking(0.0))); }

TEST(GoingOn, WhoWalksUnhitIsSoonWithHisClipFromAnyMoment) {
  for (const double at_s : {0.1, 0.3, 0.5, 0.6, 1.0}) {
    BakeSettings settings = hit_while_walking(0.0);
    settings.at_s = at_s;
    const BakedClip outcome = baked(settings);
    ASSERT_TRUE(outcome.behaviour.goes_on) << at_s;
    EXPECT_LT(outcome.behaviour.goes_on->time_s, 1.3) << at_s;
  }
}

/// A captured walk of another body on a character with short legs.
TEST(GoingOn, WithACapturedWalkToo) {
  const auto character = other_man();
  const auto walk = extra_data().value_or("") / "mocap/cmu_bvh/cmu_12_01_walk.bvh";
  if (!character || !std::filesystem::exists(walk)) GTEST_SKIP() << kNoExtraData;
  Diagnostics diagnostics;
  for (const double at_s : {0.5, 0.9}) {
    BakeSettings settings = hit_while_walking(0.0);
    settings.clip = walk.string();
    settings.at_s = at_s;
    const auto outcome = bake(*character, settings, diagnostics);
    ASSERT_TRUE(outcome);
    EXPECT_TRUE(outcome->behaviour.goes_on) << at_s;
    EXPECT_FALSE(outcome->behaviour.fall_begins_s) << at_s;
  }
}

/// The walk ends soon, on a foot that is never lifted again.
TEST(GoingOn, BeyondTheEndOfACapturedWalkIsNoErrorAndFallsNobody) {
  const auto folder = extra_data();
  if (!folder) GTEST_SKIP() << kNoExtraData;
  BakeSettings settings = hit_while_walking(0.0);
  settings.clip = (*folder / "mocap/cmu_bvh/cmu_12_01_walk.bvh").string();
  if (!std::filesystem::exists(*settings.clip)) GTEST_SKIP() << kNoExtraData;
  settings.scene = SceneKind::impulse;
  settings.ball_mass_kg = 1.0;
  settings.ball_speed_m_s = 20.0;
  settings.from = *parse_direction("left");
  settings.at_s = 1.0;
  Diagnostics diagnostics;
  const auto outcome = bake(mannequin(), settings, diagnostics);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_FALSE(outcome->behaviour.fall_begins_s);
}

TEST(GoingOn, WhoIsHitALittleWalksOn) {
  const BakedClip outcome = baked(hit_while_walking(0.33));
  expect_goes_on(outcome);
  EXPECT_GT(outcome.behaviour.steps.size(), 2u);
  const Response response = response_of(outcome);
  EXPECT_GT(response.travel_m.norm(), 0.8) << "and gets on";
}

TEST(GoingOn, WhoIsHitTooHardComesToStandAndItIsSaid) {
  BakeSettings settings = hit_while_walking(1.27);
  settings.from = *parse_direction("left");
  Diagnostics diagnostics;
  const auto outcome = bake(mannequin(), settings, diagnostics);
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->behaviour.goes_on);
  EXPECT_FALSE(outcome->behaviour.fall_begins_s);
  ASSERT_FALSE(diagnostics.warnings().empty());
  EXPECT_NE(diagnostics.warnings().back().what.find("comes to stand"), std::string::npos);
}

TEST(GoingOn, NobodyDoesWhoIsToKeepHisFeetInPlaceOrToFall) {
  const auto goes_on = [](const BakeSettings& settings) {
    Diagnostics diagnostics;
    const auto prepared = prepare_bake(mannequin(), settings, diagnostics);
    return prepared && prepared->behaviour.goes_on != nullptr;
  };
  BakeSettings planted = hit_while_walking(0.33), falls = planted, dazed = planted;
  EXPECT_TRUE(goes_on(planted));
  planted.most_steps = 0.0;
  falls.outcome = Wanted::fall;
  dazed.behaviour = Behaviour::dazed;
  EXPECT_FALSE(goes_on(planted));
  EXPECT_FALSE(goes_on(falls));
  EXPECT_FALSE(goes_on(dazed));
}

/// The mannequin with a thumb that turns steadily, 1 rad/s, in its clip "walk".
Character with_turning_thumb(int& thumb) {
  Character character = mannequin();
  thumb = character.skeleton.find("LeftHandThumb1");
  for (Animation& animation : character.animations) {
    if (animation.name != "walk") continue;
    std::erase_if(animation.tracks, [&](const Track& track) { return track.node == thumb; });
    const double half = 0.5 * animation.end_s;
    animation.tracks.push_back({thumb,
                                TrackPath::rotation,
                                Interpolation::linear,
                                {0.0, animation.end_s},
                                {0, 0, 0, 1, std::sin(half), 0, 0, std::cos(half)}});
  }
  return character;
}

BakedClip baked_from_walk(const Character& character, bool extra_bones_play) {
  BakeSettings settings = flinch();
  settings.clip = "walk";
  settings.at_s = 0.2;
  settings.lead_s = 0.1;
  settings.extra_bones_play = extra_bones_play;
  Diagnostics diagnostics;
  auto outcome = bake(character, settings, diagnostics);
  EXPECT_TRUE(outcome) << outcome.error().message();
  return std::move(*outcome);
}

TEST(ExtraBones, HoldWhatTheyHaveAtTheImpactOrPlayTheStartClipOn) {
  int thumb = -1;
  const Character character = with_turning_thumb(thumb);
  const auto held = baked_from_walk(character, false).timeline.clip.frames;
  const auto played = baked_from_walk(character, true).timeline.clip.frames;
  ASSERT_EQ(held.size(), played.size());
  const std::size_t impact = 6;
  ASSERT_GT(held.size(), impact + 20);
  for (std::size_t f = 0; f < held.size(); ++f) {
    const double clip_s = 0.1 + static_cast<double>(f) / 60.0;
    const auto turned_to = [&](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())); };
    const auto off = [&](const Pose& pose, double angle) {
      return angle_between(pose[thumb].rotation, turned_to(angle));
    };
    EXPECT_LT(off(held[f], std::min(clip_s, 0.2)), 1e-6) << f;
    EXPECT_LT(off(played[f], clip_s), 1e-6) << f;
    for (const SegmentNodes& segment : plain().prepared.humanoid.segments)
      for (const int node : segment.chain)
        EXPECT_EQ(held[f][node].rotation.coeffs(), played[f][node].rotation.coeffs()) << f << ' ' << node;
  }
}

TEST(Facing, OfLyingBodiesIsTowardsFeetOnTheBackAndHeadOnTheBelly) {
  const auto turned = [](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())); };
  EXPECT_NEAR(facing(Quat::Identity()), 0.0, 1e-12);
  EXPECT_NEAR(facing(turned(0.45 * kPi)), 0.0, 1e-12) << "falls back, the feet ahead";
  EXPECT_NEAR(facing(turned(-0.45 * kPi)), 0.0, 1e-12) << "falls on the face, the head ahead";
  const Quat yaw(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
  EXPECT_NEAR(facing(yaw * turned(0.4)), 0.7, 1e-12);
}

TEST(RootMotion, OnARootJointLeavesEveryJointInTheWorld) {
  BakeSettings settings = flinch();
  settings.ground.root_motion = RootMotion::root;
  const auto exported = exported_of(plain(), settings);
  ASSERT_TRUE(exported) << exported.error().message();
  ASSERT_TRUE(exported->with_root);
  const Skeleton& skeleton = exported->with_root->skeleton;
  ASSERT_EQ(exported->root_joint, mannequin().skeleton.size());
  EXPECT_EQ(skeleton.nodes[exported->humanoid.root].parent, exported->root_joint);
  const Skin& skin = exported->with_root->skins.at(0);
  EXPECT_EQ(skin.joints.back(), exported->root_joint) << "a bone among the others";
  EXPECT_EQ(skin.joints.size(), mannequin().skins.at(0).joints.size() + 1);
  EXPECT_LT(skin.inverse_bind.back().translation().norm(), 1e-6) << "bound where it rests, at the origin";
  for (std::size_t f = 0; f < exported->clip.frames.size(); f += 10) {
    const auto world = world_transforms(skeleton, exported->clip.frames[f]);
    const auto whole = world_transforms(mannequin().skeleton, plain().timeline.clip.frames[f]);
    for (std::size_t i = 0; i < whole.size(); ++i)
      EXPECT_LT((world[i].translation() - whole[i].translation()).norm(), 1e-9);
    const Vec3 root = world[static_cast<std::size_t>(exported->root_joint)].translation();
    EXPECT_NEAR(root.x(), exported->root_curve[f].x(), 1e-9);
    EXPECT_EQ(root.y(), 0.0);
  }
  EXPECT_GT(exported->root_curve.back().norm(), 0.01);
}

TEST(RootMotion, InPlaceKeepsThePelvisOverItsStart) {
  BakeSettings settings = flinch();
  settings.ground.root_motion = RootMotion::in_place;
  const auto exported = exported_of(plain(), settings);
  ASSERT_TRUE(exported);
  const auto pelvis = [&](const Pose& pose) {
    return segments_of(mannequin().skeleton, plain().prepared.humanoid, pose)[index(Segment::pelvis)]
        .translation;
  };
  const Vec3 start = pelvis(exported->clip.frames.front());
  for (const Pose& pose : exported->clip.frames) {
    EXPECT_NEAR(pelvis(pose).x(), start.x(), 1e-9);
    EXPECT_NEAR(pelvis(pose).z(), start.z(), 1e-9);
  }
}

TEST(Align, StartsAtTheOriginFacingForward) {
  BakeSettings settings = flinch();
  settings.ground.align = true;
  BakedClip turned = plain();
  const GroundMove away{1.0, Vec3::Zero(), Vec3(3.0, 0.0, -2.0)};
  for (Pose& pose : turned.timeline.clip.frames)
    pose = away.moved(mannequin().skeleton, turned.prepared.humanoid, pose);
  for (Rigid& segment : turned.prepared.start.segments) segment = away * segment;
  const auto exported = exported_of(turned, settings);
  ASSERT_TRUE(exported);
  const Rigid pelvis = canonical_segments_of(mannequin().skeleton, turned.prepared.humanoid,
                                             exported->clip.frames.front())[index(Segment::pelvis)];
  EXPECT_NEAR(facing(pelvis.rotation), -kPi / 2, 0.01) << "+z";
  EXPECT_NEAR(pelvis.translation.x(), 0.0, 1e-6);
  EXPECT_NEAR(pelvis.translation.z(), 0.0, 1e-6);
}

TEST(Additive, DeltasOnTopOfTheStartAreTheClip) {
  const Clip& clip = plain().timeline.clip;
  const ReducedClip whole =
      reduce_keys(mannequin().skeleton, clip, plain().prepared.humanoid.world_from_file, {false, 0.0});
  const ReducedClip delta = additive(whole, clip.frames.front());
  ASSERT_FALSE(delta.tracks.empty());
  EXPECT_LE(delta.tracks.size(), whole.tracks.size());
  for (const Track& track : delta.tracks) {
    const LocalTransform& start = clip.frames.front()[track.node];
    for (std::size_t k = 0; k < track.times.size(); ++k) {
      const auto frame = static_cast<std::size_t>(std::lround(track.times[k] * clip.fps));
      const LocalTransform& wanted = clip.frames[frame][track.node];
      if (track.path == TrackPath::rotation) {
        const double* v = track.values.data() + 4 * k;
        EXPECT_LT(angle_between(start.rotation * Quat(v[3], v[0], v[1], v[2]), wanted.rotation), 1e-7);
      } else if (track.path == TrackPath::translation) {
        const Vec3 v = Eigen::Map<const Vec3>(track.values.data() + 3 * k);
        EXPECT_LT((start.translation + v - wanted.translation).norm(), 1e-9);
      }
    }
  }
}

TEST(Additive, OfAScaleIsTheRatio) {
  ReducedClip clip;
  clip.tracks.push_back({0, TrackPath::scale, Interpolation::linear, {0.0, 1.0}, {2, 4, 5, 3, 4, 5}});
  Pose start(1);
  start[0].scale = Vec3(2, 4, 5);
  const ReducedClip delta = additive(clip, start);
  ASSERT_EQ(delta.tracks.size(), 1u);
  EXPECT_EQ(delta.tracks[0].values, (std::vector<double>{1, 1, 1, 1.5, 1, 1}));
}

/// One node that swings, slow or fast.
Clip swinging(double hz) {
  Clip clip{"swing", 60.0, {}, {}};
  for (int f = 0; f <= 240; ++f) {
    Pose pose(1);
    pose[0].translation.x() = std::sin(2 * kPi * hz * f / clip.fps);
    pose[0].rotation = exp_rotation(Vec3(0.2 * pose[0].translation.x(), 0, 0));
    clip.frames.push_back(pose);
  }
  return clip;
}

TEST(Smooth, KeepsSlowMotionWithoutLagAndHalvesTheCutOff) {
  Clip slow = swinging(0.5);
  smooth(slow, 10.0);
  const Clip expected = swinging(0.5);
  for (std::size_t f = 0; f < slow.frames.size(); ++f)
    EXPECT_NEAR(slow.frames[f][0].translation.x(), expected.frames[f][0].translation.x(), 1e-4);
  Clip fast = swinging(10.0);
  smooth(fast, 10.0);
  double largest = 0.0;
  for (std::size_t f = 100; f < 140; ++f)
    largest = std::max(largest, std::abs(fast.frames[f][0].translation.x()));
  EXPECT_NEAR(largest, 0.5 * std::sin(kPi / 3), 0.005) << "-6 dB; six samples a period";
}

TEST(Smooth, NeverMovesTheFirstFrame) {
  Clip clip = swinging(7.0);
  for (Pose& pose : clip.frames) pose[0].translation.x() += 1.0;
  const Clip before = clip;
  smooth(clip, 3.0);
  EXPECT_EQ(clip.frames.front()[0].translation, before.frames.front()[0].translation);
  EXPECT_LT((clip.frames[1][0].translation - before.frames[0][0].translation).norm(), 0.7);
}

}  // namespace
}  // namespace ukemi
