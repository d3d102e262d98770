// Getting up: bodies that lie as a fall left them stand up, and every frame on the way is looked at.
#include "rise/get_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bake/bake.h"
#include "body/ground.h"
#include "body/weight.h"
#include "judge/skin_on_floor.h"
#include "rise/fallen.h"
#include "rise/whole_body.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

/// The last frame is the standing pose, moved over the ground.
double from_standing(const BodyPose& standing, const BodyPose& last) {
  double worst = 0.0;
  const Rigid move = last[0] * standing[0].inverse();
  for (int s = 0; s < kSegmentCount; ++s)
    worst = std::max(worst, ((move * standing[s]).translation - last[s].translation).norm());
  const Vec3 up = move.rotation * Vec3::UnitY();
  return std::max({worst, (up - Vec3::UnitY()).norm(), std::abs(move.translation.y())});
}

/// How far a get-up was off balance at worst.
double expect_sound(const Fallen& man, const GetUp& get_up) {
  const Found found = look_at(man, get_up);
  EXPECT_LT(found.excess_deg, 1.0) << man.what;
  EXPECT_LT(found.slide_m, 0.010) << man.what;
  EXPECT_LT(found.sunk_m, 0.040) << man.what;
  EXPECT_LT(found.step_m, 9.5 / get_up.fps) << man.what;
  EXPECT_LT(from_standing(man.standing, get_up.frames.back()), 1e-9) << man.what;
  const double duration_s = static_cast<double>(get_up.frames.size() - 1) / get_up.fps;
  EXPECT_GT(duration_s, 1.5) << man.what;
  EXPECT_LT(duration_s, 5.5) << man.what;
  EXPECT_FALSE(get_up.planted.empty()) << man.what;
  return found.off_balance_m;
}

/// Four of five are never off balance by more than 3 cm, none by more than `worst_m`.
void expect_balanced(std::vector<double> off_balance_m, double worst_m) {
  std::sort(off_balance_m.begin(), off_balance_m.end());
  EXPECT_LT(off_balance_m[off_balance_m.size() * 4 / 5], 0.030);
  EXPECT_LT(off_balance_m.back(), worst_m);
}

Result<GetUp> get_up_of(const Fallen& man, const GetUpSettings& settings) {
  return plan_get_up(man.body, man.range, man.before, man.lying, man.standing, man.skin, settings);
}

TEST(GetUp, AMannequinStandsUpFromHoweverHeFell) {
  const Character mannequin = load("mannequin");
  std::set<std::string> routes;
  std::vector<double> off_balance_m;
  int count = 0;
  for (const Segment hit : {Segment::chest, Segment::thigh_l, Segment::head})
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
      const Fallen man =
          fallen(mannequin, std::string(name(hit)) + " " + std::to_string(azimuth), limp_fall(hit, azimuth));
      if (lying_of(man.body, man.lying) == Lying::upright) continue;
      GetUpSettings settings;
      settings.seed = static_cast<std::uint64_t>(count++);
      settings.style = static_cast<GetUpStyle>(count % 4);
      const auto get_up = get_up_of(man, settings);
      ASSERT_TRUE(get_up) << man.what;
      routes.insert(get_up->route);
      off_balance_m.push_back(expect_sound(man, *get_up));
    }
  expect_balanced(off_balance_m, 0.200);
  EXPECT_GE(count, 30);
  EXPECT_GE(routes.size(), 3u);
}

TEST(GetUp, OtherBodiesStandUpToo) {
  const auto folder = extra_data();
  if (!folder) GTEST_SKIP() << kNoExtraData;
  std::vector<double> off_balance_m;
  int count = 0;
  for (const char* file : {"Worker.glb", "Soldier.glb", "arnaud.fbx", "Zombie.fbx", "Male_Casual.fbx"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "characters")) {
      if (entry.path().filename() != file) continue;
      const Character character = load(entry.path().string());
      for (const int azimuth : {0, 60, 120, 180, 240, 300}) {
        const Fallen man =
            fallen(character, file + std::string(" ") + std::to_string(azimuth), living_fall(azimuth));
        if (lying_of(man.body, man.lying) == Lying::upright) continue;
        const auto get_up = get_up_of(man, {});
        ASSERT_TRUE(get_up) << man.what;
        off_balance_m.push_back(expect_sound(man, *get_up));
        ++count;
      }
    }
  }
  expect_balanced(off_balance_m, 0.150);
  EXPECT_GE(count, 25);
}

/// Of the clip that is written, while he gets up.
void expect_sound_clip(const Character& character, const std::string& what, BakeSettings settings,
                       double off_balance_m) {
  settings.get_up_s = 0.5;
  Diagnostics diagnostics;
  const auto outcome = bake(character, settings, diagnostics);
  ASSERT_TRUE(outcome) << what;
  ASSERT_TRUE(outcome->get_up) << what;
  const Prepared& prepared = outcome->prepared;
  const Clip& clip = outcome->timeline.clip;
  const int first = static_cast<int>(std::lround(outcome->get_up->begins_s * clip.fps));
  const SkinOverFloor skin(character, prepared.humanoid, prepared.body, prepared.start.pose,
                           prepared.start.segments);
  const Actor actor = prepared.actor(character);
  const SegmentFrames segment_frames = frames_of(actor);
  std::vector<BodyPose> frames;
  for (std::size_t f = static_cast<std::size_t>(first); f < clip.frames.size(); ++f) {
    EXPECT_LT(skin.depth(clip.frames[f]).body_m, 0.010) << what << ", frame " << f;
    frames.push_back(segments_above_floor(actor, segment_frames, clip.frames[f]));
  }
  for (const PlantedPart& part : outcome->get_up->planted) {
    const auto place = [&](int f) { return Vec3(frames[f][index(part.segment)] * part.point); };
    for (int f = part.first; f <= part.last; ++f)
      EXPECT_LT((place(f) - place(part.first)).norm(), 0.010) << what << ", " << name(part.segment);
  }
  const auto weights = weight_offsets(prepared.body,
                                      outermost_skin(character, prepared.humanoid, prepared.start.pose,
                                                     prepared.start.segments, prepared.body),
                                      frames, clip.fps);
  for (std::size_t f = static_cast<std::size_t>(kAsHeLay_s * clip.fps); f < frames.size(); ++f)
    EXPECT_LT(weights[f].least_m(), off_balance_m) << what << ", frame " << f;
}

TEST(GetUp, TheClipKeepsContactsInPlaceSkinOnTheFloorAndWeightOverSupport) {
  const Character mannequin = load("mannequin");
  for (const int azimuth : {0, 180})
    expect_sound_clip(mannequin, std::to_string(azimuth), living_fall(azimuth), 0.030);
  // The hand on which he rolls bears before his side no longer does.
  expect_sound_clip(mannequin, "90", living_fall(90), 0.030);
}

TEST(GetUp, StylesDifferAndSeedsChooseTheSide) {
  const Fallen man = fallen(load("mannequin"), "mannequin", limp_fall(Segment::chest, 0));
  std::set<double> durations;
  std::set<Segment> front_feet;
  for (const GetUpStyle style : {GetUpStyle::quick, GetUpStyle::plain, GetUpStyle::heavy}) {
    GetUpSettings settings;
    settings.style = style;
    const auto get_up = get_up_of(man, settings);
    durations.insert(static_cast<double>(get_up->frames.size()));
  }
  EXPECT_EQ(durations.size(), 3u);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    GetUpSettings settings;
    settings.seed = seed;
    const auto get_up = get_up_of(man, settings);
    const auto first = [](const GetUp& of, Segment foot) {
      int frame = std::numeric_limits<int>::max();
      for (const PlantedPart& part : of.planted)
        if (part.segment == foot) frame = std::min(frame, part.first);
      return frame;
    };
    const bool left = first(*get_up, Segment::foot_l) < first(*get_up, Segment::foot_r);
    front_feet.insert(left ? Segment::foot_l : Segment::foot_r);
  }
  EXPECT_EQ(front_feet.size(), 2u);
}

TEST(GetUp, TheSameSeedGivesTheSameBitsAndAnotherSeedAnotherMotion) {
  const Fallen man = fallen(load("mannequin"), "mannequin", limp_fall(Segment::chest, 0));
  const auto motion = [&](std::uint64_t seed) {
    GetUpSettings settings;
    settings.seed = seed;
    return get_up_of(man, settings)->frames[60][index(Segment::head)].translation;
  };
  EXPECT_EQ(motion(1), motion(1));
  EXPECT_GT((motion(1) - motion(2)).norm(), 1e-3);
}

/// How far the chest leans while the hips rise to their height, degrees, at the mean.
double mean_lean_deg(const GetUp& get_up) {
  const double hips_m = get_up.frames.back()[0].translation.y();
  double sum = 0.0;
  int count = 0;
  for (const BodyPose& frame : get_up.frames) {
    if (frame[0].translation.y() < 0.6 * hips_m || frame[0].translation.y() > 0.98 * hips_m) continue;
    sum += std::acos(std::clamp((frame[index(Segment::chest)].rotation * Vec3::UnitY()).y(), -1.0, 1.0));
    ++count;
  }
  return degrees(sum / std::max(1, count));
}

TEST(GetUp, AQuickManIsFasterAndAHurtOneSlowerAndBent) {
  const Fallen man = fallen(load("mannequin"), "mannequin", living_fall(0));
  const auto in_style = [&](GetUpStyle style) {
    GetUpSettings settings;
    settings.seed = 3;
    settings.style = style;
    return *get_up_of(man, settings);
  };
  const GetUp plain = in_style(GetUpStyle::plain), hurt = in_style(GetUpStyle::hurt);
  const GetUp quick = in_style(GetUpStyle::quick);
  EXPECT_LT(quick.frames.size(), 0.92 * static_cast<double>(plain.frames.size()));
  EXPECT_GT(hurt.frames.size(), 1.08 * static_cast<double>(plain.frames.size()));
  EXPECT_EQ(hurt.route, plain.route);
  EXPECT_GT(mean_lean_deg(hurt), mean_lean_deg(plain) + 2.0);
}

TEST(GetUp, WhoStandsIsRefused) {
  Fallen man = fallen(load("mannequin"), "mannequin", limp_fall(Segment::chest, 0));
  man.lying = man.before = man.standing;
  const auto get_up = get_up_of(man, {});
  ASSERT_FALSE(get_up);
  EXPECT_NE(get_up.error().fix.find("--get-up"), std::string::npos);
}

}  // namespace
}  // namespace ukemi
