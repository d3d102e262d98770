#include "bake/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bake/library.h"
#include "bake/response.h"
#include "base/or_null.h"
#include "base/version.h"
#include "clip/frames.h"
#include "clip/smooth.h"
#include "clip/start.h"
#include "judge/jerk.h"
#include "prepare/impact.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

// 99.9th percentile of the elbow, the joint where it is largest, over 30 clips of walking, running, fighting
// and dancing at 30 to 120 Hz, low-passed at 12 Hz. No clip of them holds a blow.
constexpr double kRealJerk_deg_s3 = 2.11e6;
constexpr double kRealCutOff_hz = 12.0;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json numbers(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

Json settings_json(const BakeSettings& settings, const BakedClip& outcome) {
  const SimulationSettings& simulation = settings.simulation;
  Json json;
  json["limits"] = name(simulation.limits);
  json["region"] = outcome.prepared.range.name;
  json["active"] = name(simulation.active);
  json["rate"] = rate_name(simulation.fixed_hz);
  json["duration_s"] = simulated_s(settings);
  json["fps"] = simulation.fps;
  json["seed"] = static_cast<std::uint64_t>(settings.seed);
  const bool active = simulation.active != Active::off;
  json["active_k_1_s"] = active ? Json(simulation.active_k) : Json(nullptr);
  json["active_delay_s"] = active ? Json(simulation.active_delay_s) : Json(nullptr);
  json["damping_1_s"] = damping_of(simulation);
  json["tone"] = tone_of(simulation);
  json["tone_fade_s"] = simulation.tone_fade_s;
  json["pose"] = outcome.prepared.start.from_clip ? Json(nullptr) : Json(outcome.prepared.start.name);
  json["clip"] = outcome.prepared.start.from_clip ? Json(outcome.prepared.start.name) : Json(nullptr);
  json["at_s"] = outcome.prepared.start.from_clip ? Json(outcome.prepared.start.at_s) : Json(nullptr);
  json["until_rest"] = settings.until_rest;
  json["hold_s"] = settings.until_rest ? Json(settings.hold_s) : Json(nullptr);
  json["lead_s"] = outcome.timeline.impact_s;
  json["get_up_s"] = or_null<Json>(gets_up_after_s(settings));
  json["get_up_clip"] = settings.get_up_clip.empty() ? Json(nullptr) : Json(settings.get_up_clip);
  json["recover_s"] = or_null<Json>(settings.recover_s);
  json["recover_to"] =
      settings.recover_s ? Json(settings.recover_to == RecoverTo::clip ? "clip" : "rest") : Json(nullptr);
  json["align"] = settings.ground.align;
  json["extra_bones"] = settings.extra_bones_play ? "clip" : "hold";
  json["smooth_hz"] = or_null<Json>(settings.smooth_hz);
  json["keys"] = settings.keys.enabled ? "reduced" : "all";
  json["key_error_mm"] = settings.keys.enabled ? Json(settings.keys.tolerance_m * 1000.0) : Json(nullptr);
  return json;
}

Json frames_json(const Character& character, const BakedClip& outcome) {
  const SegmentFrames frames = frames_of(outcome.prepared.actor(character));
  Json json = Json::object();
  for (int i = 0; i < kSegmentCount; ++i) {
    Json& segment = json[std::string(name(segment_at(i)))];
    if (frames.node[i] < 0) continue;
    segment = {{"node", character.skeleton.label(frames.node[i])},
               {"segment_from_node", numbers(frames.segment_from_node[i])}};
  }
  return json;
}

Json humanoid_json(const Character& character, const BakedClip& outcome) {
  Json json;
  json["height_m"] = outcome.prepared.humanoid.height_m;
  json["mass_kg"] = outcome.prepared.body.mass_kg;
  Json map = Json::object();
  for (int i = 0; i < kSegmentCount; ++i) {
    const int node = outcome.prepared.humanoid.segments[i].node();
    map[std::string(name(segment_at(i)))] = node < 0 ? Json(nullptr) : Json(character.skeleton.label(node));
  }
  json["map"] = std::move(map);
  json["frames"] = frames_json(character, outcome);
  return json;
}

/// How far the joints of the clip's impact frame are from the start pose.
double position_jump(const Character& character, const BakedClip& outcome) {
  const auto impact =
      static_cast<std::size_t>(std::lround(outcome.timeline.impact_s * outcome.timeline.clip.fps));
  const BodyPose first =
      segments_of(character.skeleton, outcome.prepared.humanoid, outcome.timeline.clip.frames[impact]);
  double largest = 0.0;
  for (int i = 0; i < kSegmentCount; ++i)
    largest =
        std::max(largest, (first[i].translation - outcome.prepared.start.segments[i].translation).norm());
  return largest;
}

Json impact_json(const Character& character, const BakeSettings& settings, const BakedClip& outcome) {
  const Scene& scene = outcome.prepared.scene;
  Json json;
  json["segment"] = name(scene.target);
  json["preset"] = or_null<Json>(preset_in_use(settings));
  json["time_s"] = outcome.timeline.impact_s;
  json["momentum_n_s"] = outcome.figures.momentum_n_s;
  const std::optional<double>& contact_s = outcome.figures.first_ground_contact_s;
  json["first_ground_contact_s"] = contact_s ? Json(outcome.timeline.impact_s + *contact_s) : Json(nullptr);
  const bool from_clip = outcome.prepared.start.from_clip;
  json["position_jump_m"] = from_clip ? Json(position_jump(character, outcome)) : Json(nullptr);
  json["velocity_jump_m_s"] =
      from_clip ? Json(velocity_jump(character.skeleton, outcome.prepared.humanoid, outcome.prepared.start))
                : Json(nullptr);
  json["scene"] = name(scene.kind);
  json["from"] = settings.from.text;
  json["direction"] = numbers(scene.direction);
  const bool fall = scene.kind == SceneKind::fall;
  const bool ball =
      scene.kind == SceneKind::ball || scene.kind == SceneKind::slope || scene.kind == SceneKind::box;
  const bool push = is_push(scene.kind);
  json["ball_mass_kg"] = ball ? Json(scene.ball_mass_kg) : Json(nullptr);
  json["ball_speed_m_s"] = ball ? Json(scene.ball_speed_m_s) : Json(nullptr);
  json["ball_radius_m"] = ball ? Json(scene.ball_radius_m) : Json(nullptr);
  json["slope_deg"] = scene.kind == SceneKind::slope ? Json(degrees(scene.slope_rad)) : Json(nullptr);
  json["fall_height_m"] = fall ? Json(scene.fall_height_m) : Json(nullptr);
  json["tip_speed_m_s"] = fall ? Json(scene.tip_speed_m_s) : Json(nullptr);
  json["push_force_n"] = push ? Json(scene.push_force_n) : Json(nullptr);
  json["push_duration_s"] = push ? Json(scene.push_duration_s) : Json(nullptr);
  json["floor_height_m"] = outcome.prepared.start.floor_m;
  return json;
}

Json touch_json(const std::optional<TouchDown>& touch) {
  if (!touch) return nullptr;
  return {{"time_s", touch->time_s}, {"speed_m_s", touch->speed_m_s}};
}

Json first_contact_json(const std::optional<TouchDown>& touch) {
  Json json = touch_json(touch);
  if (touch) json["segment"] = name(touch->segment);
  return json;
}

Json nearest_clip_json(const std::optional<NearestClip>& clip) {
  if (!clip) return nullptr;
  return {{"name", clip->name},
          {"from_s", clip->from_s},
          {"leads", clip->leads},
          {"apart_m", clip->apart_m},
          {"turned_deg", clip->turned_deg},
          {"needed_s", clip->needed_s},
          {"excess_deg", clip->excess_deg}};
}

Json get_up_json(const BakedClip& outcome) {
  if (!outcome.get_up) return nullptr;
  const double impact_s = outcome.timeline.impact_s;
  Json phases = Json::array();
  for (const GetUpPhase& phase : outcome.get_up->phases)
    phases.push_back({{"name", phase.name}, {"time_s", phase.time_s + impact_s}});
  return {{"begins_s", outcome.get_up->begins_s + impact_s},
          {"stands_s", outcome.get_up->stands_s + impact_s},
          {"route", outcome.get_up->route},
          {"clip", nearest_clip_json(outcome.get_up->clip)},
          {"slide_max_m", get_up_slide(outcome)},
          {"phases", std::move(phases)}};
}

Json steps_json(const std::vector<StepTaken>& steps) {
  Json json = Json::array();
  for (const StepTaken& step : steps)
    json.push_back({{"foot", step.foot == Segment::foot_l ? "l" : "r"},
                    {"lift_s", step.lift_s},
                    {"contact_s", or_null<Json>(step.contact_s)},
                    {"length_m", step.length_m}});
  return json;
}

Json response_json(const BakedClip& outcome) {
  const Response response = response_of(outcome);
  const SimulationFigures& figures = outcome.figures;
  const bool muscles = response.behaviour != Behaviour::limp;
  Json json;
  json["behaviour"] = name(response.behaviour);
  json["outcome"] = name(response.outcome);
  json["end_pose"] = name(response.end_pose);
  json["steps"] = steps_json(response.steps);
  json["fall_begins_s"] = or_null<Json>(response.fall_begins_s);
  json["knocked_out_s"] = or_null<Json>(response.knocked_out_s);
  json["first_contact"] = first_contact_json(response.contacts.first);
  json["head_contact"] = touch_json(response.contacts.head);
  json["pelvis_contact"] = touch_json(response.contacts.pelvis);
  json["first_hand_contact"] = touch_json(response.contacts.hand);
  json["first_knee_contact"] = touch_json(response.contacts.knee);
  json["foot_slide_max_m"] = response.foot_slide_max_m;
  json["muscle_torque_max_share"] = muscles ? Json(figures.muscle_share_max) : Json(nullptr);
  json["muscle_work_j"] = muscles ? Json(figures.muscle_work_j) : Json(nullptr);
  json["get_up"] = get_up_json(outcome);
  json["travel_m"] = numbers(response.travel_m);
  json["turn_deg"] = response.turn_deg;
  json["delivered_n_s"] = figures.delivered_n_s;
  json["trials"] = outcome.trials;
  json["score"] = outcome.score;
  json["assist_n_s"] = figures.help_n_s;
  const auto& goes_on = outcome.behaviour.goes_on;
  json["goes_on_s"] = goes_on ? Json(outcome.timeline.impact_s + goes_on->time_s) : Json(nullptr);
  return json;
}

Json limits_json(const BakedClip& outcome, const ClipLimits& written) {
  const LimitFigures& figures = outcome.limits;
  Json json;
  json["samples"] = figures.samples;
  json["over_1deg"] = figures.over_1deg;
  json["excess_p999_deg"] = figures.excess_p999_deg;
  json["excess_max_deg"] = figures.excess_max_deg;
  json["worst_joint"] = figures.worst_joint ? Json(name(*figures.worst_joint)) : Json(nullptr);
  json["excess_projected_max_deg"] =
      figures.projected ? Json(figures.excess_projected_max_deg) : Json(nullptr);
  json["projected"] = figures.projected;
  json["widened_deg"] = Json::object();
  for (const auto& [joint, angle] : outcome.prepared.widened)
    json["widened_deg"][std::string(name(joint))] = degrees(angle);
  json["human_over_1deg"] = outcome.human.over_1deg;
  json["human_excess_max_deg"] = outcome.human.excess_max_deg;
  json["clip_samples"] = written.samples;
  json["clip_over_1deg"] = written.over_1deg;
  json["clip_excess_max_deg"] = written.excess_max_deg;
  return json;
}

Json simulation_json(const SimulationFigures& figures, const SkinOnFloor& skin) {
  Json json;
  json["steps"] = figures.steps;
  json["rejected_steps"] = figures.rejected_steps;
  json["joint_separation_max_m"] = figures.joint_separation_max_m;
  json["energy_gain_max_j"] = figures.energy_gain_max_j;
  json["floor_penetration_max_m"] = figures.floor_penetration_max_m;
  json["self_penetration_max_m"] = figures.self_penetration_max_m;
  json["rest_time_s"] = or_null<Json>(figures.rest_time_s);
  json["jitter_rad_s"] = figures.jitter_rad_s;
  json["hash"] = figures.hash;
  json["angular_momentum_mean_kg_m2_s"] = figures.angular_momentum_mean_kg_m2_s;
  json["airborne_mean_s"] = figures.airborne_mean_s;
  json["turning_mean_rad_s"] = figures.turning_mean_rad_s;
  json["floor_penetration_end_m"] = figures.floor_penetration_end_m;
  json["skin_penetration_max_m"] = skin.max.body_m;
  json["skin_penetration_end_m"] = skin.end_m;
  return json;
}

Json root_curve_json(const std::vector<Vec3>& curve) {
  Json json = Json::array();
  for (const Vec3& place : curve) json.push_back({place.x(), place.z()});
  return json;
}

Json marks_json(const Clip& clip) {
  Json json = Json::object();
  for (const Mark& mark : clip.marks) json[mark.name] = mark.time_s;
  return json;
}

/// As the captured motion was filtered that kRealJerk_deg_s3 comes from.
Json filtered_jerk_json(const Clip& clip) {
  if (!(clip.fps > 2.0 * kRealCutOff_hz)) return nullptr;
  Clip filtered = clip;
  smooth(filtered, kRealCutOff_hz);
  return largest_jerk(filtered).deg_s3;
}

Json clip_json(const Skeleton& skeleton, const BakeSettings& settings, const BakedClip& outcome,
               const ReducedClip& reduced) {
  Json json;
  json["frames"] = outcome.timeline.clip.frames.size();
  json["resample_position_max_m"] = outcome.resample_error.position_single_bones_max_m;
  json["ground_lift_max_m"] = outcome.ground_lift_max_m;
  json["resample_position_shared_bends_max_m"] = outcome.resample_error.position_max_m;
  json["resample_rotation_max_deg"] = outcome.resample_error.rotation_max_deg;
  json["keys"] = reduced.keys;
  json["keys_error_max_m"] = reduced.error_m;
  const JerkPeak jerk = largest_jerk(outcome.timeline.clip);
  json["jerk_max_deg_s3"] = jerk.deg_s3;
  json["outputs"] = Json::array();
  for (const auto& output : settings.outputs) json["outputs"].push_back(output.string());
  json["name"] = outcome.timeline.clip.name;
  json["duration_s"] = outcome.timeline.clip.duration_s();
  json["marks_s"] = marks_json(outcome.timeline.clip);
  json["root_motion"] = name(settings.ground.root_motion);
  json["additive"] = settings.additive != Additive::off;
  json["additive_form"] = settings.additive == Additive::off ? Json(nullptr) : Json(name(settings.additive));
  json["root_curve_m"] = nullptr;
  json["jerk_real_motion_p999_deg_s3"] = kRealJerk_deg_s3;
  json["jerk_max_node"] = jerk.node < 0 ? Json(nullptr) : Json(skeleton.label(jerk.node));
  json["jerk_max_time_s"] = jerk.node < 0 ? Json(nullptr) : Json(jerk.time_s);
  json["jerk_below_12hz_max_deg_s3"] = filtered_jerk_json(outcome.timeline.clip);
  return json;
}

Json timings_json(const BakeTimings& timings, double clip_duration_s) {
  Json json;
  json["load"] = timings.load;
  json["simulate"] = timings.simulate;
  json["resample"] = timings.resample;
  json["export"] = timings.export_;
  json["render"] = timings.render;
  json["total"] = timings.total;
  json["realtime_factor"] = timings.total > 0.0 ? Json(clip_duration_s / timings.total) : Json(nullptr);
  return json;
}

}  // namespace

std::string report_json(const std::string& character, const Character& loaded, const BakeSettings& settings,
                        const BakedFile& baked, const Diagnostics& diagnostics) {
  const BakedClip& outcome = baked.outcome;
  const std::vector<Vec3>& root_curve = baked.root_curve;
  Json json;
  json["format"] = 1;
  json["generator"] = generator();
  json["character"] = character;
  json["reaction"] = outcome.prepared.reaction;
  json["settings"] = settings_json(settings, outcome);
  json["humanoid"] = humanoid_json(loaded, outcome);
  json["impact"] = impact_json(loaded, settings, outcome);
  json["response"] = response_json(outcome);
  json["limits"] = limits_json(outcome, baked.written);
  json["simulation"] = simulation_json(outcome.figures, outcome.skin);
  json["clip"] = clip_json(loaded.skeleton, settings, outcome, baked.reduced);
  if (!root_curve.empty()) json["clip"]["root_curve_m"] = root_curve_json(root_curve);
  json["library"] =
      Json::parse(library_row(std::filesystem::path(character).stem().string(), settings, baked));
  json["timings_s"] = timings_json(outcome.timings_s, outcome.timeline.clip.duration_s());
  json["warnings"] = Json::array();
  for (const Warning& warning : diagnostics.warnings())
    json["warnings"].push_back(warning.subject.empty() ? warning.what
                                                       : warning.subject + ": " + warning.what);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string_view name(Limits limits) {
  switch (limits) {
    case Limits::edges:
      return "edges";
    case Limits::segments:
      return "segments";
    case Limits::segments_euler:
      return "segments-euler";
    case Limits::axis:
      return "axis";
    case Limits::none:
      break;
  }
  return "none";
}

std::string_view name(Active active) {
  switch (active) {
    case Active::implicit:
      return "implicit";
    case Active::explicit_torque:
      return "explicit";
    case Active::off:
      break;
  }
  return "off";
}

std::string rate_name(double fixed_hz) {
  return fixed_hz > 0.0 ? fmt::format("fixed:{}", fixed_hz) : "adaptive";
}

}  // namespace ukemi
