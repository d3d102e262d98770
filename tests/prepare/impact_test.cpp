#include "prepare/impact.h"

#include <gtest/gtest.h>

#include "base/parse_segment.h"
#include "prepare/settings.h"

namespace ukemi {
namespace {

constexpr double kTolerance = 1e-12;

Vec3 travel(const char* from, const Quat& world_from_pelvis = Quat::Identity()) {
  const auto direction = parse_direction(from);
  EXPECT_TRUE(direction) << from;
  return travel_direction(*direction, world_from_pelvis);
}

// The neutral pelvis: x anterior, y up, z to the right.
TEST(Direction, WordsTravelAwayFromWhereTheyComeFrom) {
  EXPECT_LT((travel("front") - Vec3(-1, 0, 0)).norm(), kTolerance);
  EXPECT_LT((travel("back") - Vec3(1, 0, 0)).norm(), kTolerance);
  EXPECT_LT((travel("left") - Vec3(0, 0, 1)).norm(), kTolerance) << "the left is at -z, the blow goes to +z";
  EXPECT_LT((travel("right") - Vec3(0, 0, -1)).norm(), kTolerance);
  EXPECT_LT((travel("above") - Vec3(0, -1, 0)).norm(), kTolerance);
}

TEST(Direction, DegreesMeanTheSameAsTheWords) {
  EXPECT_LT((travel("90") - travel("left")).norm(), kTolerance);
  EXPECT_LT((travel("-90") - travel("right")).norm(), kTolerance);
  EXPECT_LT((travel("270,0") - travel("right")).norm(), kTolerance);
  EXPECT_LT((travel("0,30") - Vec3(-std::cos(radians(30)), -0.5, 0)).norm(), kTolerance);
}

TEST(Direction, TurnsWithThePelvisButStaysLevel) {
  const Quat turned = exp_rotation(Vec3(0, radians(40), 0));
  const Quat leaning = turned * exp_rotation(Vec3(0, 0, radians(-25)));  // forward
  EXPECT_LT((travel("front", leaning) - turned * Vec3(-1, 0, 0)).norm(), kTolerance);
}

TEST(Direction, OfALyingBodyFollowsHeadOrFeet) {
  const Quat prone = exp_rotation(Vec3(0, 0, radians(-90)));  // anterior down, head forward (+x)
  EXPECT_LT((travel("front", prone) - Vec3(-1, 0, 0)).norm(), kTolerance);
  const Quat supine = exp_rotation(Vec3(0, 0, radians(90)));  // anterior up, head backward (-x)
  EXPECT_LT((travel("front", supine) - Vec3(-1, 0, 0)).norm(), kTolerance);
}

TEST(Direction, RefusesWhatIsNone) {
  for (const char* text : {"", "frnt", "1,2,3", "north", "361", "0,91", "nan", "1e999", "0,", ",0", "12 "}) {
    const auto direction = parse_direction(text);
    ASSERT_FALSE(direction) << text;
    EXPECT_EQ(direction.error().kind, ErrorKind::usage);
    EXPECT_FALSE(direction.error().fix.empty());
  }
  EXPECT_EQ(parse_direction("frnt").error().fix, "did you mean 'front'?");
  for (const auto& [word, degrees_] :
       {std::pair("front_left", 45.0), {"back-left", 135.0}, {"back_right", -135.0}, {"front-right", -45.0}})
    EXPECT_NEAR(degrees(parse_direction(word)->azimuth), degrees_, 1e-12) << word;
  EXPECT_EQ(parse_direction("front-left")->text, "front_left");
}

TEST(Presets, OfTheProgramLoadInTheirOrder) {
  const auto presets = load_presets();
  ASSERT_TRUE(presets) << presets.error().message();
  std::vector<std::string> names;
  for (const ImpactPreset& preset : *presets) {
    names.push_back(preset.name);
    EXPECT_GT(preset.mass_kg * preset.speed_m_s, 1.0) << preset.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"punch", "kick", "medicine-ball", "football", "tackle", "shot",
                                             "trip", "slip", "pull", "explosion"}));
}

struct BadPreset {
  const char* toml;
  int line;
  const char* what;
};

TEST(Presets, SayWhereTheFileIsWrong) {
  const BadPreset bad[] = {
      {"format = 1\n[preset.a\n", 2, ""},
      {"[preset.a]\nmass_kg = 1\n", 1, "format"},
      {"format = 1\n[preset.a]\nspeed_m_s = 1\nradius_m = 1\n", 2, "'mass_kg' is missing"},
      {"format = 1\n[preset.a]\nmass_kg = 1\nspeed_m_s = -1\nradius_m = 1\n", 4, "not a number above 0"},
      {"format = 1\n[preset.a]\nmass_kg = 1\nspeed_m_s = 1\nradius_m = 1\nmas = 2\n", 6, "unknown key 'mas'"},
      {"format = 1\n[preset.a]\nmass_kg = 1\nspeed_m_s = 1\nradius_m = 1\nscene = \"bal\"\n", 6,
       "unknown scene"},
      {"format = 1\n[other]\n", 2, "unknown key 'other'"},
  };
  for (const BadPreset& test : bad) {
    const auto presets = parse_presets(test.toml, "p.toml");
    ASSERT_FALSE(presets) << test.toml;
    EXPECT_EQ(presets.error().kind, ErrorKind::input);
    EXPECT_EQ(presets.error().file, "p.toml");
    EXPECT_EQ(presets.error().line, test.line) << test.toml;
    EXPECT_NE(presets.error().what.find(test.what), std::string::npos) << presets.error().what;
  }
}

TEST(Scene, TakesThePresetAndWhatReplacesIt) {
  BakeSettings settings;
  settings.hit = Segment::head;
  settings.ball_speed_m_s = 9.0;
  const auto scene = scene_of(settings, BodyPose{});
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->kind, SceneKind::ball);
  EXPECT_EQ(scene->target, Segment::head);
  EXPECT_DOUBLE_EQ(scene->ball_mass_kg, 5.0);
  EXPECT_DOUBLE_EQ(scene->ball_speed_m_s, 9.0);
  EXPECT_EQ(preset_in_use(settings), "medicine-ball");
  settings.ball_mass_kg = 1.0;
  settings.ball_radius_m = 0.1;
  EXPECT_FALSE(preset_in_use(settings)) << "nothing of the preset is left";
}

TEST(Scene, EveryWayOfHittingCarriesTheSameMomentum) {
  for (const SceneKind kind : {SceneKind::ball, SceneKind::push, SceneKind::impulse}) {
    BakeSettings settings;
    settings.preset = "punch";
    settings.scene = kind;
    const auto scene = scene_of(settings, BodyPose{});
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->kind, kind);
    EXPECT_NEAR(scene->ball_mass_kg * scene->ball_speed_m_s, 26.506, 1e-9);
    EXPECT_NEAR(scene->push_force_n * scene->push_duration_s, 26.506, 1e-9);
    EXPECT_NEAR(scene->impulse_n_s, 26.506, 1e-9);
  }
}

TEST(Scene, StrengthMultipliesEveryWayOfHitting) {
  for (const SceneKind kind : {SceneKind::ball, SceneKind::push, SceneKind::impulse, SceneKind::fall}) {
    BakeSettings settings;
    settings.scene = kind;
    const auto plain = scene_of(settings, BodyPose{});
    settings.strength = 2.5;
    const auto strong = scene_of(settings, BodyPose{});
    ASSERT_TRUE(plain && strong);
    EXPECT_NEAR(strong->ball_speed_m_s, 2.5 * plain->ball_speed_m_s, 1e-9);
    EXPECT_NEAR(strong->push_force_n, 2.5 * plain->push_force_n, 1e-9);
    EXPECT_NEAR(strong->impulse_n_s, 2.5 * plain->impulse_n_s, 1e-9);
    EXPECT_NEAR(strong->tip_speed_m_s, 2.5 * plain->tip_speed_m_s, 1e-9);
    EXPECT_EQ(strong->push_duration_s, plain->push_duration_s);
    EXPECT_EQ(strong->ball_mass_kg, plain->ball_mass_kg);
  }
}

/// Standing, feet apart, the left one lifted.
BodyPose standing() {
  BodyPose pose;
  for (int s = 0; s < kSegmentCount; ++s) pose[s].translation = Vec3(0.0, 1.0, 0.02 * s);
  pose[index(Segment::foot_l)].translation = Vec3(0.0, 0.2, -0.1);
  pose[index(Segment::foot_r)].translation = Vec3(0.0, 0.1, 0.1);
  return pose;
}

Scene scene(const std::string& preset, Segment hit) {
  BakeSettings settings;
  settings.preset = preset;
  settings.hit = hit;
  const auto scene = scene_of(settings, standing());
  EXPECT_TRUE(scene);
  return scene ? *scene : Scene{};
}

Vec3 sum_of(const Scene& scene) {
  Vec3 sum = Vec3::Zero();
  for (const Load& load : scene.loads) sum += load.way;
  return sum;
}

TEST(Scene, OfATackleLoadsTwoSegmentsTogether) {
  const Scene tackle = scene("tackle", Segment::pelvis);
  ASSERT_EQ(tackle.loads.size(), 2u);
  EXPECT_EQ(tackle.loads[0].segment, Segment::pelvis);
  EXPECT_EQ(tackle.loads[1].segment, Segment::abdomen);
  EXPECT_LT((sum_of(tackle) - tackle.direction).norm(), 1e-12);
  EXPECT_EQ(scene("tackle", Segment::thigh_l).loads[1].segment, Segment::thigh_r);
  EXPECT_TRUE(scene("tackle", Segment::head).loads.empty());
  EXPECT_TRUE(scene("kick", Segment::pelvis).loads.empty());
}

TEST(Scene, OfATripTakesTheFootThatIsInTheAir) {
  EXPECT_EQ(scene("trip", Segment::chest).target, Segment::foot_l);
  EXPECT_EQ(scene("trip", Segment::shank_r).target, Segment::shank_r);
}

TEST(Scene, IsSaidInWords) {
  BakeSettings settings;
  const auto words = [&](SceneKind kind) {
    Scene scene;
    scene.kind = kind, scene.target = Segment::hand_l;
    return blow_in_words(settings, scene);
  };
  EXPECT_EQ(words(SceneKind::none), "unhit");
  EXPECT_EQ(words(SceneKind::ball), "left hand hit from front");
  EXPECT_EQ(words(SceneKind::pull), "left hand pulled to front");
  EXPECT_EQ(words(SceneKind::slip), "the feet slip away to front");
  EXPECT_EQ(words(SceneKind::fall), "falls away from front");
}

TEST(Scene, OfASlipOrAPullGoesToWhereTheBlowComesFrom) {
  const Vec3 forward = Vec3::UnitX();  // the default is from the front
  EXPECT_LT((scene("kick", Segment::chest).direction + forward).norm(), 1e-12);
  EXPECT_LT((scene("pull", Segment::chest).direction - forward).norm(), 1e-12);
  const Scene slip = scene("slip", Segment::chest);
  ASSERT_EQ(slip.loads.size(), 2u);
  EXPECT_LT((sum_of(slip) - forward).norm(), 1e-12);
  EXPECT_GT(slip.slippery_s, 0.0);
}

TEST(Scene, OfAnExplosionBlowsEverySegmentAway) {
  const Scene blast = scene("explosion", Segment::chest);
  ASSERT_EQ(blast.loads.size(), static_cast<std::size_t>(kSegmentCount));
  const BodyPose pose = standing();
  const Vec3 point = pose[index(Segment::chest)].translation - 3.0 * blast.direction;
  double shares = 0.0;
  for (const Load& load : blast.loads) {
    const Vec3 away = (pose[index(load.segment)].translation - point).normalized();
    EXPECT_NEAR(load.way.normalized().dot(away), 1.0, 1e-9) << name(load.segment);
    shares += load.way.norm();
  }
  EXPECT_NEAR(shares, 1.0, 1e-12);
}

TEST(Scene, RefusesUnknownWordsWithTheNearest) {
  BakeSettings settings;
  settings.preset = "puhcn";
  EXPECT_EQ(scene_of(settings, BodyPose{}).error().fix, "did you mean 'punch'?");
  EXPECT_EQ(parse_segment("chset").error().what, "unknown segment 'chset'");
  EXPECT_EQ(parse_segment("chset").error().fix, "did you mean 'chest'?");
  EXPECT_EQ(parse_segment("upper leg").error().what, "'upper leg' does not say which side");
  EXPECT_EQ(parse_segment("upper leg").error().fix, "write 'thigh_l' or 'thigh_r'");
  EXPECT_EQ(parse_scene("slop").error().what, "unknown scene 'slop'");
}

}  // namespace
}  // namespace ukemi
