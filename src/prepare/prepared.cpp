#include "prepare/prepared.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "body/on_ground.h"
#include "humanoid/rotations.h"
#include "prepare/get_up_clips.h"
#include "prepare/impact.h"
#include "prepare/needs.h"
#include "prepare/start.h"

namespace ukemi {
namespace {

const double kStartMargin = radians(3.0);  // how far inside its range every joint of the start pose lies

/// Makes every joint of the start pose lie inside its range, by widening the range where it does not.
void widen_for_start(Prepared& prepared, Diagnostics& diagnostics) {
  const PerJoint<SwingTwist> charts = charts_of(prepared.range, rotations_of(prepared.start.segments));
  for (int i = 0; i < kJointCount; ++i) {
    if (prepared.body.joints[i].fused) continue;
    const double outside = excess(prepared.range.joints[i], charts[i]);
    const double widened = widen_to_hold(prepared.range.joints[i], charts[i], kStartMargin);
    if (widened <= 0.0) continue;
    prepared.widened.emplace_back(joint_at(i), widened);
    const std::string start =
        outside > 0.0 ? fmt::format("{:.1f} degrees outside its range of motion", degrees(outside))
                      : std::string("near the edge of its range of motion");
    diagnostics.warn(std::string(name(joint_at(i))),
                     fmt::format("starts {}; the range is widened by {:.1f} degrees for this bake", start,
                                 degrees(widened)));
  }
}

constexpr double kUnderWay_m_s = 0.3;  // speed of the pelvis from which a body is under way
constexpr double kOffFloor_m = 0.025;

double pelvis_speed(const StartState& state) { return state.linear_velocity[index(Segment::pelvis)].norm(); }

/// Height of the lower end of a foot above where it would stand, m.
double foot_height(const BodyPose& home, const BodyPose& pose, Segment foot) {
  return pose[index(foot)].translation.y() - home[index(foot)].translation.y();
}

/// Time, s from the start, at which each foot that is in the air at the start comes down: when it is low and
/// no longer gains on the pelvis (a foot that swings past the other is as low).
UnderWay under_way_of(const Character& character, const Prepared& prepared) {
  constexpr double kStep_s = 1.0 / 120.0;
  constexpr double kLookAhead_s = 0.6;
  const Vec2 way = on_ground(prepared.start.state.linear_velocity[index(Segment::pelvis)]);
  UnderWay under_way;
  BodyPose before = prepared.start.state.segments;
  for (int i = 1; i * kStep_s <= kLookAhead_s; ++i) {
    const Pose pose = unhit_pose(character.skeleton, prepared.humanoid, prepared.start, i * kStep_s);
    BodyPose segments = canonical_segments_of(character.skeleton, prepared.humanoid, pose);
    for (Rigid& segment : segments) segment.translation.y() -= prepared.start.floor_m;
    for (const BodySide side : kSides) {
      const Segment foot = side == BodySide::left ? Segment::foot_l : Segment::foot_r;
      const auto ahead = [&](const BodyPose& body) {
        return on_ground(body[index(foot)].translation - body[0].translation).dot(way);
      };
      auto& lands = under_way.lands_in_s[static_cast<int>(side)];
      const bool low = foot_height(prepared.home, segments, foot) < kOffFloor_m;
      if (!lands && low && ahead(segments) <= ahead(before)) lands = i * kStep_s;
    }
    before = segments;
  }
  return under_way;
}

/// Poses of the start's motion from the blow on.
void go_on(const Character& character, const BakeSettings& settings, Prepared& prepared) {
  constexpr double kBeyond_s = 1.0;  // what follows the run still tells where feet land
  const double step_s = prepared.behaviour.gait_step_s;
  auto frames = std::make_shared<std::vector<BodyPose>>();
  for (int i = 0; i * step_s < simulated_s(settings) + kBeyond_s; ++i) {
    const Pose pose = unhit_pose(character.skeleton, prepared.humanoid, prepared.start, i * step_s);
    BodyPose segments = canonical_segments_of(character.skeleton, prepared.humanoid, pose);
    for (Rigid& segment : segments) segment.translation.y() -= prepared.start.floor_m;
    frames->push_back(segments);
  }
  prepared.behaviour.goes_on = std::move(frames);
}

/// A still start is its own home. A body under way comes to stand as the stand pose does, facing as it does
/// then.
void find_home(const Character& character, const BakeSettings& settings, Prepared& prepared) {
  const BodyPose& start = prepared.start.state.segments;
  prepared.home = start;
  if (!prepared.start.from_clip || prepared.behaviour.kind == Behaviour::limp) return;
  const Pose pose = start_pose(character, prepared.humanoid, StartPose::stand,
                               {true, Vec2::Zero(), static_cast<std::uint64_t>(settings.seed)});
  BodyPose stand = canonical_segments_of(character.skeleton, prepared.humanoid, pose);
  const bool still = pelvis_speed(prepared.start.state) < kUnderWay_m_s &&
                     foot_height(stand, start, Segment::foot_l) < kOffFloor_m &&
                     foot_height(stand, start, Segment::foot_r) < kOffFloor_m;
  if (still) return;
  const double turn = yaw_of(start[0].rotation * Vec3::UnitX()) - yaw_of(stand[0].rotation * Vec3::UnitX());
  const Quat turned(Eigen::AngleAxisd(turn, Vec3::UnitY()));
  const Vec3 from = at_height(on_ground(stand[0].translation), 0.0);
  const Vec3 to = at_height(on_ground(start[0].translation), 0.0);
  for (Rigid& segment : stand)
    segment = {turned * segment.rotation, to + turned * (segment.translation - from)};
  prepared.home = stand;
  prepared.behaviour.under_way = under_way_of(character, prepared);
  const bool steps = prepared.behaviour.kind == Behaviour::alert && prepared.behaviour.most_steps > 0;
  if (settings.recover_to == RecoverTo::clip && steps && settings.outcome != Wanted::fall)
    go_on(character, settings, prepared);
}

}  // namespace

Result<Prepared> prepare_bake(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics) {
  Prepared prepared;
  prepared.reaction = reaction_name(settings);
  auto range = settings.range ? Result(*settings.range) : load_range_of_motion(settings.region);
  if (!range) return range.error();
  prepared.range = std::move(*range);
  auto humanoid = map_humanoid(character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  prepared.humanoid = std::move(*humanoid);
  auto start = start_of(character, prepared.humanoid, settings, diagnostics);
  if (!start) return start.error();
  prepared.start = std::move(*start);
  if (settings.recover_s && settings.recover_to == RecoverTo::stance)
    return usage_error("--return-to stance and --return exclude each other",
                       "leave out --return to end as the body stands, or take --return-to rest");
  if (settings.recover_s && settings.recover_to == RecoverTo::clip && !prepared.start.motion)
    return usage_error("--return-to clip needs a start clip to go back to",
                       "add --clip NAME, or take --return-to rest");
  auto body = build_body(character, prepared.humanoid, prepared.start.pose, prepared.start.segments,
                         BodyOptions{settings.mass_kg.value_or(0.0), settings.sex}, diagnostics);
  if (!body) return body.error();
  prepared.body = std::move(*body);
  widen_for_start(prepared, diagnostics);
  if (!settings.get_up_clip.empty()) {
    auto library =
        get_up_clips(character, prepared.humanoid, prepared.body, settings.get_up_clip, diagnostics);
    if (!library) return library.error();
    prepared.get_ups = std::make_shared<const std::vector<RisingClip>>(std::move(*library));
  }
  auto thresholds = load_active_thresholds(settings.active_file);
  if (!thresholds) return thresholds.error();
  prepared.thresholds = *thresholds;
  auto strength = muscle_strength(prepared.body, settings.sex, settings.muscle);
  if (!strength) return strength.error();
  prepared.strength = *strength;
  prepared.behaviour = behaviour_settings(settings);
  find_home(character, settings, prepared);
  auto scene = scene_of(settings, prepared.start.segments);
  if (!scene) return scene.error();
  prepared.scene = *scene;
  for (const std::string& idle : idle_settings(settings, prepared.scene.kind)) diagnostics.warn("", idle);
  for (const std::string& idle : idle_settings(settings, character)) diagnostics.warn("", idle);
  if (settings.latency_s && prepared.behaviour.under_way)
    diagnostics.warn(
        "", "--reaction-time has no effect on a body that walks or runs: it controls its steps already");
  return prepared;
}

SimulationInput simulation_input(const Prepared& prepared, const Scene& scene,
                                 const SimulationSettings& settings) {
  return simulation_input(prepared, scene, settings, prepared.behaviour);
}

SimulationInput simulation_input(const Prepared& prepared, const Scene& scene,
                                 const SimulationSettings& settings, const BehaviourSettings& behaviour) {
  return {prepared.body,
          prepared.range,
          prepared.thresholds,
          prepared.strength,
          prepared.start.state,
          scene,
          settings,
          behaviour_of(prepared.body, prepared.range, prepared.strength, prepared.home, scene, behaviour,
                       settings)};
}

}  // namespace ukemi
