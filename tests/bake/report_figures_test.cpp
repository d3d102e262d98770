// Every number of a report is the one that was measured: figures that are known beforehand go in, and no
// number comes out that was not looked at. One that stays 0 or is twice as large fails. What measures them is
// tested in simulate/meters_test.cpp and beside the functions named below.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "bake/bake.h"
#include "bake/report.h"
#include "bake/response.h"
#include "clip/smooth.h"
#include "judge/jerk.h"
#include "load/load.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

/// A walker's bake whose figures are replaced by ones that nothing else has.
class ReportFigures : public testing::Test {
 protected:
  void SetUp() override {
    character_ = *load_character(std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb", {}, said_);
    choose_settings();
    auto baked = bake(character_, settings_, said_);
    ASSERT_TRUE(baked) << baked.error().message();
    file_.emplace(BakedFile{std::move(*baked), {}, {}, {}, {}, {}});
    set_simulation();
    set_response();
    set_clip();
    set_scene();
  }

  void choose_settings() {
    settings_.clip = "walk";
    settings_.at_s = 0.25;
    settings_.from = *parse_direction("40,15");
    settings_.lead_s = 0.2;
    settings_.hold_s = 0.35;
    settings_.seed = 5;
    settings_.smooth_hz = 11.0;
    settings_.keys.tolerance_m = 0.0007;
    SimulationSettings& simulation = settings_.simulation;
    simulation.duration_s = 0.6;
    simulation.fps = 50.0;
    simulation.active_k = 16.0;
    simulation.active_delay_s = 0.01;
    simulation.damping = 9.0;
    simulation.tone = 0.2;
    simulation.tone_fade_s = 0.7;
  }

  BakedClip& outcome() { return file_->outcome; }

  void set_simulation() {
    SimulationFigures& f = outcome().figures;
    f.steps = 311;
    f.rejected_steps = 17;
    f.joint_separation_max_m = 0.0031;
    f.energy_gain_max_j = 1.7;
    f.floor_penetration_max_m = 0.0043;
    f.self_penetration_max_m = 0.0057;
    f.rest_time_s = 0.51;
    f.jitter_rad_s = 0.013;
    f.angular_momentum_mean_kg_m2_s = 2.3;
    f.airborne_mean_s = 0.019;
    f.turning_mean_rad_s = 1.1;
    f.floor_penetration_end_m = 0.0021;
    outcome().skin.max.body_m = 0.0067;
    outcome().skin.end_m = 0.0049;
    outcome().limits = {12345, 23, 0.41, 0.83, Joint::knee_l, 0.07, true};
    outcome().human = {777, 31, 2.9, Joint::knee_l};
    file_->written = {4321, 37, 0.59, Joint::knee_l};
    outcome().prepared.widened = {{Joint::elbow_l, radians(6.5)}};
  }

  void set_response() {
    SimulationFigures& f = outcome().figures;
    ControllerReport& b = outcome().behaviour;
    b.steps = {{Segment::foot_l, 0.11, 0.29, 0.61}};
    b.fall_begins_s = 0.33;
    b.knocked_out_s = 0.37;
    b.goes_on = GoesOn{0.43, 0.9};
    b.fall.knee = TouchDown{Segment::shank_l, 0.43, 1.9};
    f.touch_down = {};
    f.touch_down[index(Segment::chest)] = {Segment::chest, 0.39, 2.7};
    f.touch_down[index(Segment::hand_r)] = {Segment::hand_r, 0.41, 3.1};
    f.touch_down[index(Segment::shank_l)] = {Segment::shank_l, 0.43, 1.9};
    f.touch_down[index(Segment::forearm_l)] = {Segment::forearm_l, 0.44, 1.3};
    f.touch_down[index(Segment::pelvis)] = {Segment::pelvis, 0.45, 2.2};
    f.touch_down[index(Segment::head)] = {Segment::head, 0.47, 1.4};
    f.muscle_share_max = 0.71;
    f.muscle_work_j = 53.0;
    f.delivered_n_s = 21.0;
    f.help_n_s = 4.5;
    outcome().trials = 3;
    outcome().score = 0.875;
    const NearestClip clip{"up", 0.35, 0.08, 33.0, 0.45, true, 2.5, Joint::knee_l};
    outcome().get_up = GetUpTimes{"belly", 0.48, 0.56, {{"stands", 0.56}}, {}, clip};
    std::vector<BodyPose>& frames = outcome().timeline.trajectory.frames;
    const double begins_s = outcome().timeline.impact_s + 0.48;
    const auto& at =
        frames.at(static_cast<std::size_t>(std::lround(begins_s * outcome().timeline.trajectory.fps)));
    const Vec3 place = at[index(Segment::hand_l)].translation + Vec3(0.012, 0.0, 0.0);
    outcome().get_up->planted = {{Segment::hand_l, Vec3::Zero(), place, 0, 0}};
    BodyPose last = frames.at(10);  // of the impact
    const Quat turn(Eigen::AngleAxisd(radians(25.0), Vec3::UnitY()));
    last[0] = {turn * last[0].rotation, last[0].translation + Vec3(0.3, -0.2, 0.9)};
    frames.back() = last;
  }

  void set_clip() {
    Timeline& timeline = outcome().timeline;
    for (int i = 0; i < character_.skeleton.size(); ++i)  // every root, and with it every joint
      if (character_.skeleton.nodes[i].parent < 0)
        timeline.clip.frames.at(10)[i].translation += Vec3(0.0, 0.03, 0.04);
    timeline.clip.marks = {{"start", 0.07}, {"impact", 0.2},  {"first_ground_contact", 0.58},
                           {"rest", 0.71},  {"get_up", 0.68}, {"recover", 0.79}};
    outcome().resample_error = {0.0013, 0.017, 0.0011};
    outcome().ground_lift_max_m = 0.0091;
    file_->reduced.keys = 999;
    file_->reduced.error_m = 0.00043;
    file_->root_curve = {Vec3(0.5, 9.0, 0.7), Vec3(0.6, 9.0, 0.8)};
    outcome().timings_s = {0.11, 0.22, 0.33, 0.44, 0.55, 1.6};
  }

  void set_scene() {
    outcome().figures.momentum_n_s = 26.0;
    outcome().figures.first_ground_contact_s = 0.38;
    Scene& scene = outcome().prepared.scene;
    scene.kind = SceneKind::slope;
    scene.direction = Vec3(0.48, -0.6, 0.64);
    scene.ball_mass_kg = 4.1;
    scene.ball_speed_m_s = 6.3;
    scene.ball_radius_m = 0.12;
    scene.slope_rad = radians(22.0);
    scene.fall_height_m = 0.9;
    scene.tip_speed_m_s = 1.6;
    scene.push_force_n = 410.0;
    scene.push_duration_s = 0.23;
    outcome().prepared.start.floor_m = 0.015;
    outcome().prepared.humanoid.height_m = 1.81;
    outcome().prepared.body.mass_kg = 83.0;
    for (Vec3& velocity : outcome().prepared.start.state.linear_velocity) velocity.x() += 50.0;
  }

  /// Between the last two frames, which are far apart.
  double head_way_m() {
    const std::vector<BodyPose>& frames = outcome().timeline.trajectory.frames;
    const int head = index(Segment::head);
    const Vec3& centre = outcome().prepared.body.segments[head].centre_of_mass;
    return (frames.back()[head] * centre - frames[frames.size() - 2][head] * centre).norm();
  }
  Json report() {
    return Json::parse(report_json("folder/mannequin.glb", character_, settings_, *file_, said_)).flatten();
  }

  Character character_;
  BakeSettings settings_;
  Diagnostics said_;
  std::optional<BakedFile> file_;
};

/// What the report must say, by JSON pointer.
class Expected {
 public:
  void is(const std::string& key, double value, double tolerance = 1e-9) {
    EXPECT_NE(value, 0.0) << key << " cannot be told from a figure that stays 0";
    expected_[key] = {value, tolerance};
  }
  /// Looked at elsewhere, as said.
  void elsewhere(const std::string& prefix) { elsewhere_.insert(prefix); }

  void check(const Json& report) const {
    std::size_t seen = 0;
    for (const auto& [key, value] : report.items()) {
      if (!value.is_number()) continue;
      const auto found = expected_.find(key);
      if (found == expected_.end()) {
        EXPECT_TRUE(is_elsewhere(key)) << key << " is a number that nobody looked at: " << value;
        continue;
      }
      ++seen;
      EXPECT_NEAR(value.get<double>(), found->second.first, found->second.second) << key;
    }
    EXPECT_EQ(seen, expected_.size()) << "what is expected is there";
  }

 private:
  bool is_elsewhere(const std::string& key) const {
    for (const std::string& prefix : elsewhere_)
      if (key.starts_with(prefix)) return true;
    return false;
  }

  std::map<std::string, std::pair<double, double>> expected_;
  std::set<std::string> elsewhere_;
};

void expect_settings(Expected& e) {
  e.is("/settings/duration_s", 0.6), e.is("/settings/fps", 50.0), e.is("/settings/seed", 5.0);
  e.is("/settings/active_k_1_s", 16.0), e.is("/settings/active_delay_s", 0.01);
  e.is("/settings/damping_1_s", 9.0), e.is("/settings/tone", 0.2), e.is("/settings/tone_fade_s", 0.7);
  e.is("/settings/at_s", 0.25), e.is("/settings/hold_s", 0.35), e.is("/settings/lead_s", 0.2);
  e.is("/settings/smooth_hz", 11.0), e.is("/settings/key_error_mm", 0.7);
  e.is("/settings/get_up_s", 0.9), e.is("/settings/recover_s", 0.8);
}

void expect_impact(Expected& e) {
  e.is("/humanoid/height_m", 1.81), e.is("/humanoid/mass_kg", 83.0);
  e.is("/impact/time_s", 0.2), e.is("/impact/momentum_n_s", 26.0);
  e.is("/impact/first_ground_contact_s", 0.2 + 0.38);
  e.is("/impact/position_jump_m", 0.05), e.is("/impact/velocity_jump_m_s", 50.0, 1.0);
  e.is("/impact/direction/0", 0.48), e.is("/impact/direction/1", -0.6), e.is("/impact/direction/2", 0.64);
  e.is("/impact/ball_mass_kg", 4.1), e.is("/impact/ball_speed_m_s", 6.3);
  e.is("/impact/ball_radius_m", 0.12), e.is("/impact/slope_deg", 22.0);
  e.is("/impact/floor_height_m", 0.015);
}

void expect_response(Expected& e) {
  const std::string r = "/response/";
  e.is(r + "steps/0/lift_s", 0.31), e.is(r + "steps/0/contact_s", 0.49), e.is(r + "steps/0/length_m", 0.61);
  e.is(r + "fall_begins_s", 0.53), e.is(r + "knocked_out_s", 0.57);
  e.is(r + "first_contact/time_s", 0.59), e.is(r + "first_contact/speed_m_s", 2.7);
  e.is(r + "head_contact/time_s", 0.67), e.is(r + "head_contact/speed_m_s", 1.4);
  e.is(r + "pelvis_contact/time_s", 0.65), e.is(r + "pelvis_contact/speed_m_s", 2.2);
  e.is(r + "first_hand_contact/time_s", 0.61), e.is(r + "first_hand_contact/speed_m_s", 3.1);
  e.is(r + "first_knee_contact/time_s", 0.63), e.is(r + "first_knee_contact/speed_m_s", 1.9);
  e.is(r + "muscle_torque_max_share", 0.71), e.is(r + "muscle_work_j", 53.0);
  e.is(r + "get_up/begins_s", 0.68), e.is(r + "get_up/stands_s", 0.76);
  e.is(r + "get_up/phases/0/time_s", 0.76), e.is(r + "get_up/slide_max_m", 0.012);
  e.is(r + "get_up/clip/from_s", 0.35), e.is(r + "get_up/clip/apart_m", 0.08);
  e.is(r + "get_up/clip/turned_deg", 33.0), e.is(r + "get_up/clip/needed_s", 0.45);
  e.is(r + "get_up/clip/excess_deg", 2.5);
  e.is(r + "travel_m/0", 0.3), e.is(r + "travel_m/1", -0.2), e.is(r + "travel_m/2", 0.9);
  e.is(r + "turn_deg", 25.0), e.is(r + "delivered_n_s", 21.0), e.is(r + "trials", 3.0);
  e.is(r + "score", 0.875), e.is(r + "assist_n_s", 4.5);
  e.is(r + "goes_on_s", 0.63);
}

void expect_simulation(Expected& e) {
  const std::string l = "/limits/", s = "/simulation/";
  e.is(l + "samples", 12345), e.is(l + "over_1deg", 23), e.is(l + "excess_p999_deg", 0.41);
  e.is(l + "excess_max_deg", 0.83), e.is(l + "excess_projected_max_deg", 0.07);
  e.is(l + "widened_deg/elbow_l", 6.5), e.is(l + "human_over_1deg", 31),
      e.is(l + "human_excess_max_deg", 2.9);
  e.is(l + "clip_samples", 4321), e.is(l + "clip_over_1deg", 37), e.is(l + "clip_excess_max_deg", 0.59);
  e.is(s + "steps", 311), e.is(s + "rejected_steps", 17), e.is(s + "joint_separation_max_m", 0.0031);
  e.is(s + "energy_gain_max_j", 1.7), e.is(s + "floor_penetration_max_m", 0.0043);
  e.is(s + "self_penetration_max_m", 0.0057), e.is(s + "rest_time_s", 0.51), e.is(s + "jitter_rad_s", 0.013);
  e.is(s + "angular_momentum_mean_kg_m2_s", 2.3), e.is(s + "airborne_mean_s", 0.019);
  e.is(s + "turning_mean_rad_s", 1.1), e.is(s + "floor_penetration_end_m", 0.0021);
  e.is(s + "skin_penetration_max_m", 0.0067), e.is(s + "skin_penetration_end_m", 0.0049);
}

void expect_clip(Expected& e, std::size_t frames) {
  const std::string c = "/clip/", t = "/timings_s/";
  const double duration_s = static_cast<double>(frames - 1) / 50.0;
  e.is(c + "frames", static_cast<double>(frames)), e.is(c + "duration_s", duration_s);
  e.is(c + "resample_position_max_m", 0.0011), e.is(c + "resample_position_shared_bends_max_m", 0.0013);
  e.is(c + "resample_rotation_max_deg", 0.017), e.is(c + "ground_lift_max_m", 0.0091);
  e.is(c + "keys", 999), e.is(c + "keys_error_max_m", 0.00043);
  e.is(c + "marks_s/start", 0.07), e.is(c + "marks_s/impact", 0.2);
  e.is(c + "marks_s/first_ground_contact", 0.58), e.is(c + "marks_s/rest", 0.71);
  e.is(c + "marks_s/get_up", 0.68), e.is(c + "marks_s/recover", 0.79);
  e.is(c + "root_curve_m/0/0", 0.5), e.is(c + "root_curve_m/0/1", 0.7);
  e.is(c + "root_curve_m/1/0", 0.6), e.is(c + "root_curve_m/1/1", 0.8);
  e.is(c + "jerk_real_motion_p999_deg_s3", 2.11e6);
  e.is(t + "load", 0.11), e.is(t + "simulate", 0.22), e.is(t + "resample", 0.33), e.is(t + "export", 0.44);
  e.is(t + "render", 0.55), e.is(t + "total", 1.6), e.is(t + "realtime_factor", duration_s / 1.6);
}

void expect_library(Expected& e, std::size_t frames) {
  const std::string l = "/library/";
  e.is(l + "FromDeg", 40.0), e.is(l + "FromElevationDeg", 15.0), e.is(l + "MomentumNs", 26.0);
  e.is(l + "TurnDeg", 25.0), e.is(l + "TravelX", 0.3), e.is(l + "TravelY", -0.2), e.is(l + "TravelZ", 0.9);
  e.is(l + "Steps", 1.0), e.is(l + "FirstStepS", 0.31), e.is(l + "LastStepS", 0.49);
  e.is(l + "FallBeginsS", 0.53), e.is(l + "DurationS", static_cast<double>(frames - 1) / 50.0);
  e.is(l + "ImpactS", 0.2), e.is(l + "FirstGroundContactS", 0.58), e.is(l + "RestS", 0.71);
  e.is(l + "GetUpS", 0.68), e.is(l + "RecoveredS", 0.79), e.is(l + "Fps", 50.0);
  e.is(l + "HeadContactS", 0.67), e.is(l + "ChestContactS", 0.59), e.is(l + "PelvisContactS", 0.65);
  e.is(l + "HandContactS", 0.61), e.is(l + "ForearmContactS", 0.64), e.is(l + "KneeContactS", 0.63);
  e.is(l + "StartClipS", 0.25);
}

TEST_F(ReportFigures, AreThoseThatWereMeasured) {
  settings_.get_up_s = 0.9;
  settings_.recover_s = 0.8;
  Expected e;
  const std::size_t frames = outcome().timeline.clip.frames.size();
  expect_settings(e);
  expect_impact(e);
  expect_response(e);
  expect_simulation(e);
  expect_clip(e, frames);
  expect_library(e, frames);
  const JerkPeak jerk = largest_jerk(outcome().timeline.clip);  // judge: Jerk.OfACubicTurn...
  e.is("/clip/jerk_max_deg_s3", jerk.deg_s3, 1e-3), e.is("/clip/jerk_max_time_s", jerk.time_s);
  Clip filtered = outcome().timeline.clip;
  smooth(filtered, 12.0);
  e.is("/clip/jerk_below_12hz_max_deg_s3", largest_jerk(filtered).deg_s3, 1e-3);
  e.is("/response/foot_slide_max_m", response_of(outcome()).foot_slide_max_m);  // bake: FootSlide.*
  // The head flies from where the last frame has it, by 1/50 s at 50 frames a second.
  e.is("/library/PeakHeadSpeed", head_way_m() * 50.0, 1e-6);
  e.elsewhere("/format");
  e.elsewhere("/humanoid/frames/");  // bake: Bake.ReportAndClipAloneGiveEverySegmentsOrientation
  e.check(report());
}

TEST_F(ReportFigures, OfBlowsOfOtherKindsAreThoseOfTheScene) {
  const auto number = [&](const char* key) { return report().at(std::string("/impact/") + key); };
  outcome().prepared.scene.kind = SceneKind::fall;
  EXPECT_EQ(number("fall_height_m"), 0.9);
  EXPECT_EQ(number("tip_speed_m_s"), 1.6);
  EXPECT_TRUE(number("ball_mass_kg").is_null());
  outcome().prepared.scene.kind = SceneKind::push;
  EXPECT_EQ(number("push_force_n"), 410.0);
  EXPECT_EQ(number("push_duration_s"), 0.23);
  EXPECT_TRUE(number("slope_deg").is_null());
}

}  // namespace
}  // namespace ukemi
