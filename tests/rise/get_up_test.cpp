// Getting up: bodies that lie as a fall left them stand up, and every frame on the way is looked at.
#include "rise/get_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bake/bake.h"
#include "base/character_path.h"
#include "body/ground.h"
#include "load/load.h"
#include "prepare/direction.h"
#include "rise/whole_body.h"
#include "support/extra_data.h"

namespace ukemi {
namespace {

struct Fallen {
  std::string what;
  ArticulatedBody body;
  RangeOfMotion range;
  OuterSkin skin;
  BodyPose before, lying, standing;
};

Fallen fallen(const Character& character, const std::string& what, const BakeSettings& settings) {
  Diagnostics diagnostics;
  auto outcome = bake(character, settings, diagnostics);
  EXPECT_TRUE(outcome) << what;
  if (!outcome) return {};
  const Prepared& prepared = outcome->prepared;
  const std::vector<BodyPose>& frames = outcome->timeline.trajectory.frames;
  return {what,
          prepared.body,
          prepared.range,
          outermost_skin(character, prepared.humanoid, prepared.start.pose, prepared.start.segments,
                         prepared.body),
          frames[frames.size() - 2],
          frames.back(),
          prepared.start.state.segments};
}

Character load(const std::string& file) {
  Diagnostics diagnostics;
  auto path = character_path(file);
  EXPECT_TRUE(path);
  auto character = load_character(*path, LoadOptions{}, diagnostics);
  EXPECT_TRUE(character) << file;
  return character ? std::move(*character) : Character{};
}

BakeSettings limp_fall(Segment hit, int azimuth) {
  BakeSettings settings;
  settings.behaviour = Behaviour::limp;
  settings.hit = hit;
  settings.from = *parse_direction(std::to_string(azimuth));
  settings.simulation.duration_s = 4.0;
  return settings;
}

BakeSettings living_fall(int azimuth) {
  BakeSettings settings;
  settings.preset = "kick";
  settings.strength = 2.0;
  settings.from = *parse_direction(std::to_string(azimuth));
  settings.most_steps = 0;
  settings.simulation.duration_s = 6.0;
  return settings;
}

/// What a frame-by-frame look at a get-up found, at worst.
struct Found {
  double excess_deg = 0.0, slide_m = 0.0, sunk_m = 0.0, off_balance_m = 0.0, step_m = 0.0;
};

/// How far the centre of mass, or where its motion takes it (Hof 2008: c + v sqrt(h / g)), is outside the
/// hull of the planted parts.
double off_balance(const Fallen& man, const GetUp& get_up, const WholeBody& whole, int frame) {
  std::vector<Vec2> corners;
  for (const PlantedPart& part : get_up.planted) {
    if (frame < part.first || frame > part.last) continue;
    const Rigid& at = get_up.frames[frame][index(part.segment)];
    for (const Vec3& p : man.skin[index(part.segment)])
      if (const Vec3 place = at * p; place.y() < 0.03) corners.push_back({place.x(), place.z()});
    corners.push_back({part.place.x(), part.place.z()});
  }
  if (corners.size() < 3) return 0.0;
  const Vec3 com = whole.centre_of_mass(get_up.frames[frame]);
  const Vec3 next = whole.centre_of_mass(get_up.frames[frame + 1]);
  const Vec3 velocity = get_up.fps * (next - com);
  const double w = std::sqrt(com.y() / 9.81);
  const std::vector<Vec2> hull = hull_of(corners);
  const auto outside = [&](const Vec3& p) { return way_into(hull, {p.x(), p.z()}).norm(); };
  return std::min(outside(com), outside(com + w * velocity));
}

Found look_at(const Fallen& man, const GetUp& get_up) {
  const WholeBody whole(man.body, man.range, man.skin);
  Found worst;
  for (std::size_t f = 1; f < get_up.frames.size(); ++f) {
    const BodyPose& frame = get_up.frames[f];
    PerSegment<Quat> rotations;
    for (int s = 0; s < kSegmentCount; ++s) rotations[s] = frame[s].rotation;
    const PerJoint<SwingTwist> charts = charts_of(man.range, rotations);
    for (int j = 0; j < kJointCount; ++j)
      if (!man.body.joints[j].fused)
        worst.excess_deg = std::max(worst.excess_deg, degrees(excess(man.range.joints[j], charts[j])));
    worst.sunk_m = std::max(worst.sunk_m, -whole.lowest(frame));
    for (int s = 0; s < kSegmentCount; ++s)
      worst.step_m =
          std::max(worst.step_m, (frame[s].translation - get_up.frames[f - 1][s].translation).norm());
    const int n = static_cast<int>(f);
    for (const PlantedPart& part : get_up.planted)
      if (n >= part.first && n <= part.last)
        worst.slide_m =
            std::max(worst.slide_m, (frame[index(part.segment)] * part.point - part.place).norm());
    if (f + 1 < get_up.frames.size())
      worst.off_balance_m = std::max(worst.off_balance_m, off_balance(man, get_up, whole, n));
  }
  return worst;
}

/// The last frame is the standing pose, moved over the ground.
double from_standing(const BodyPose& standing, const BodyPose& last) {
  double worst = 0.0;
  const Rigid move = last[0] * standing[0].inverse();
  for (int s = 0; s < kSegmentCount; ++s)
    worst = std::max(worst, ((move * standing[s]).translation - last[s].translation).norm());
  const Vec3 up = move.rotation * Vec3::UnitY();
  return std::max({worst, (up - Vec3::UnitY()).norm(), std::abs(move.translation.y())});
}

void expect_sound(const Fallen& man, const GetUp& get_up) {
  const Found found = look_at(man, get_up);
  EXPECT_LT(found.excess_deg, 1.0) << man.what;
  EXPECT_LT(found.slide_m, 0.010) << man.what;
  EXPECT_LT(found.sunk_m, 0.040) << man.what;
  EXPECT_LT(found.step_m, 6.5 / get_up.fps) << man.what;
  EXPECT_LT(from_standing(man.standing, get_up.frames.back()), 1e-9) << man.what;
  const double duration_s = static_cast<double>(get_up.frames.size() - 1) / get_up.fps;
  EXPECT_GT(duration_s, 1.5) << man.what;
  EXPECT_LT(duration_s, 5.0) << man.what;
  EXPECT_FALSE(get_up.planted.empty()) << man.what;
}

Result<GetUp> get_up_of(const Fallen& man, const GetUpSettings& settings) {
  return plan_get_up(man.body, man.range, man.before, man.lying, man.standing, man.skin, settings);
}

TEST(GetUp, AMannequinStandsUpFromHoweverHeFell) {
  const Character mannequin = load("mannequin");
  std::set<std::string> routes;
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
      expect_sound(man, *get_up);
    }
  EXPECT_GE(count, 30);
  EXPECT_GE(routes.size(), 3u);
}

TEST(GetUp, OtherBodiesStandUpToo) {
  const auto folder = extra_data();
  if (!folder) GTEST_SKIP() << kNoExtraData;
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
        expect_sound(man, *get_up);
        ++count;
      }
    }
  }
  EXPECT_GE(count, 25);
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

/// How far the chest leans on the way up, degrees, at the mean.
double mean_lean_deg(const GetUp& get_up) {
  double sum = 0.0;
  for (const BodyPose& frame : get_up.frames)
    sum += std::acos(std::clamp((frame[index(Segment::chest)].rotation * Vec3::UnitY()).y(), -1.0, 1.0));
  return degrees(sum / static_cast<double>(get_up.frames.size()));
}

TEST(GetUp, AQuickManIsFasterAndAHurtOneSlowerAndBent) {
  const Fallen man = fallen(load("mannequin"), "mannequin", limp_fall(Segment::chest, 0));
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
