// Getting up as a clip shows it: which clip, and every frame on the way.
#include "rise/rise_by_clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "body/on_ground.h"
#include "rise/fallen.h"
#include "rise/getting_up.h"
#include "rise/rising_clip.h"

namespace ukemi {
namespace {

/// A whole fall with its planned get-up, as somebody may have recorded it.
struct Recorded {
  ArticulatedBody body;
  std::vector<BodyPose> frames;
  double fps = 60.0, get_up_begins_s = 0.0;
};

Recorded recorded(const Character& character, BakeSettings settings) {
  settings.get_up_s = 0.8;
  settings.seed = 5;
  settings.simulation.duration_s = 8.0;
  Diagnostics diagnostics;
  const auto outcome = bake(character, settings, diagnostics);
  EXPECT_TRUE(outcome && outcome->get_up);
  if (!outcome || !outcome->get_up) return {};
  return {outcome->prepared.body, outcome->timeline.trajectory.frames, outcome->timeline.trajectory.fps,
          outcome->get_up->begins_s};
}

std::vector<RisingClip> get_ups_of(const Recorded& recorded, const std::string& name) {
  return rising_clips_of(recorded.body, name, recorded.fps, recorded.frames);
}

class RiseByClip : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    mannequin = new Character(load("mannequin"));
    back = new Recorded(recorded(*mannequin, living_fall(0)));
    front = new Recorded(recorded(*mannequin, living_fall(180)));
  }
  static void TearDownTestSuite() {
    delete mannequin;
    delete back;
    delete front;
  }
  static std::vector<RisingClip> library() {
    std::vector<RisingClip> clips = get_ups_of(*back, "from the back");
    for (RisingClip& clip : get_ups_of(*front, "from the front")) clips.push_back(std::move(clip));
    return clips;
  }
  static Character* mannequin;
  static Recorded *back, *front;
};
Character* RiseByClip::mannequin = nullptr;
Recorded* RiseByClip::back = nullptr;
Recorded* RiseByClip::front = nullptr;

TEST_F(RiseByClip, AMotionIsCutToItsGetUp) {
  const auto clips = get_ups_of(*back, "all of it");
  ASSERT_EQ(clips.size(), 1u);
  const RisingClip& clip = clips.front();
  EXPECT_EQ(clip.name, "all of it");
  EXPECT_NEAR(clip.from_s, back->get_up_begins_s, 0.9);  // after the fall, from where he lies still
  EXPECT_NE(lying_of(back->body, clip.frames.front()), Lying::upright);
  EXPECT_EQ(lying_of(back->body, clip.frames.back()), Lying::upright);
  EXPECT_GT(clip.floor_frames, 30);
  for (int f = 0; f < clip.floor_frames; ++f)
    EXPECT_NE(lying_of(back->body, clip.frames[f]), Lying::upright) << f;
}

TEST_F(RiseByClip, WhoStaysUpOrStaysDownGivesNoClip) {
  std::vector<BodyPose> stands(90, back->frames.front()), falls = back->frames;
  falls.resize(static_cast<std::size_t>(back->get_up_begins_s * back->fps));
  EXPECT_TRUE(rising_clips_of(back->body, "stands", 60.0, stands).empty());
  EXPECT_TRUE(rising_clips_of(back->body, "falls", 60.0, falls).empty());
  EXPECT_TRUE(rising_clips_of(back->body, "nothing", 60.0, {}).empty());
}

TEST_F(RiseByClip, TheSamePoseElsewhereAndFacingElsewhereIsNearest) {
  const std::vector<RisingClip> clips = library();
  ASSERT_EQ(clips.size(), 2u);
  const Rigid elsewhere{exp_rotation(2.2 * Vec3::UnitY()), Vec3(3.0, 0.0, -7.0)};
  for (std::size_t c = 0; c < clips.size(); ++c) {
    BodyPose lying = clips[c].frames.front();
    for (Rigid& segment : lying) segment = elsewhere * segment;
    const auto entry = nearest_entry(back->body, clips, lying, lying, 60.0);
    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->clip, c);
    EXPECT_EQ(entry->frame, 0);
    EXPECT_LT(entry->apart_m, 1e-9);
    EXPECT_LT(entry->turned_deg, 1e-6);
    EXPECT_LT(entry->needed_s, 1e-6);
    EXPECT_LT(angle_between(entry->world_from_clip.rotation, elsewhere.rotation), 1e-9);
    EXPECT_LT((entry->world_from_clip.translation - elsewhere.translation).norm(), 1e-9);
  }
  EXPECT_FALSE(nearest_entry(back->body, {}, clips[0].frames[0], clips[0].frames[0], 60.0));
}

/// Largest change of a segment's velocity from one frame to the next, m/s.
double velocity_jump(const std::vector<BodyPose>& frames, double fps) {
  double most = 0.0;
  for (std::size_t f = 2; f < frames.size(); ++f)
    for (int s = 0; s < kSegmentCount; ++s)
      most = std::max(most, fps * (frames[f][s].translation - 2.0 * frames[f - 1][s].translation +
                                   frames[f - 2][s].translation)
                                      .norm());
  return most;
}

double planted_slide(const GetUp& get_up) {
  double most = 0.0;
  for (const PlantedPart& part : get_up.planted)
    for (int f = part.first; f <= part.last; ++f)
      most = std::max(
          most,
          on_ground(get_up.frames[static_cast<std::size_t>(f)][index(part.segment)] * part.point - part.place)
              .norm());
  return most;
}

/// Largest difference of a segment's tilt and height from the clip's, at the end.
double from_end_of(const RisingClip& clip, const GetUp& get_up) {
  const BodyPose &is = get_up.frames.back(), &wanted = clip.frames.back();
  double most = 0.0;
  for (int s = 0; s < kSegmentCount; ++s)
    most = std::max(most, std::abs(is[s].translation.y() - wanted[s].translation.y()));
  return most;
}

TEST_F(RiseByClip, FromHoweverHeLiesTheClipIsTakenUpWithoutAJump) {
  const std::vector<RisingClip> clips = library();
  int led = 0;
  for (const Segment hit : {Segment::chest, Segment::thigh_l})
    for (const int azimuth : {0, 20, 160, 180, 200, 340}) {
      const Fallen man = fallen(*mannequin, std::string(name(hit)) + " " + std::to_string(azimuth),
                                hit == Segment::chest ? living_fall(azimuth) : limp_fall(hit, azimuth));
      if (lying_of(man.body, man.lying) == Lying::upright) continue;
      const auto entry = nearest_entry(man.body, clips, man.before, man.lying, 60.0);
      ASSERT_TRUE(entry);
      if (!entry->in_reach()) continue;
      ++led;
      const WholeBody whole(man.body, man.range, man.skin);
      const RisingClip& clip = clips[entry->clip];
      const GetUp get_up = rise_by_clip(whole, man.range, man.before, man.lying, clip, *entry, 60.0).get_up;
      const Found found = look_at(man, get_up);
      EXPECT_LT(found.excess_deg, 1.0) << man.what;
      EXPECT_LT(found.sunk_m, 0.030) << man.what;
      EXPECT_LT(planted_slide(get_up), 0.010) << man.what;
      EXPECT_FALSE(get_up.planted.empty()) << man.what;
      std::vector<BodyPose> frames = get_up.frames;
      EXPECT_EQ(frames.front()[0].translation, man.lying[0].translation) << man.what;
      frames.insert(frames.begin(), man.before);
      EXPECT_LT(velocity_jump(frames, 60.0), 1.5) << man.what;
      EXPECT_LT(from_end_of(clip, get_up), 0.03) << man.what;
      const double duration_s = static_cast<double>(get_up.frames.size() - 1) / get_up.fps;
      EXPECT_LT(duration_s, clip.duration_s() + ClipEntry::kLongest_s) << man.what;
      EXPECT_EQ(get_up.phases.front().name, "shifts");
      EXPECT_EQ(get_up.phases.back().name, "stands");
    }
  EXPECT_GE(led, 6);
}

TEST_F(RiseByClip, OutOfReachTheGetUpIsPlanned) {
  const Fallen man = fallen(*mannequin, "prone", living_fall(180));
  std::vector<RisingClip> supine = get_ups_of(*back, "from the back");
  supine.front().floor_frames = 1;  // not where he has turned and sat up
  for (const bool with_library : {true, false}) {
    Trajectory trajectory;
    trajectory.frames = {man.before, man.lying};
    const auto times = add_get_up(
        {man.body, man.range, man.standing, man.skin, with_library ? &supine : nullptr}, {}, trajectory);
    ASSERT_TRUE(times);
    EXPECT_NE(times->route, "clip");
    ASSERT_EQ(times->clip.has_value(), with_library);
    if (with_library) {
      EXPECT_FALSE(times->clip->leads);
      EXPECT_EQ(times->clip->name, "from the back");
      EXPECT_GT(times->clip->needed_s, ClipEntry::kLongest_s);
    }
  }
}

}  // namespace
}  // namespace ukemi
