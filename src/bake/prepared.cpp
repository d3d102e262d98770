#include "bake/prepared.h"

#include <fmt/format.h>

#include "bake/impact.h"
#include "bake/start.h"
#include "base/errors.h"
#include "humanoid/rotations.h"

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
    if (outside > radians(1.0))
      diagnostics.warn(
          std::string(name(joint_at(i))),
          fmt::format("starts {:.1f} degrees outside its range of motion; the range is widened by {:.1f} "
                      "degrees for this bake",
                      degrees(outside), degrees(widened)));
  }
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
  if (settings.recover_s && settings.recover_to == RecoverTo::clip && !prepared.start.motion)
    return usage_error("--to clip needs a start clip to go back to", "add --clip NAME, or take --to rest");
  auto body = build_body(character, prepared.humanoid, prepared.start.pose, prepared.start.segments,
                         BodyOptions{settings.mass_kg.value_or(0.0), settings.sex}, diagnostics);
  if (!body) return body.error();
  prepared.body = std::move(*body);
  widen_for_start(prepared, diagnostics);
  auto thresholds = load_active_thresholds(settings.active_file);
  if (!thresholds) return thresholds.error();
  prepared.thresholds = *thresholds;
  auto strength = muscle_strength(prepared.body, settings.sex, settings.muscle);
  if (!strength) return strength.error();
  prepared.strength = *strength;
  prepared.behaviour = behaviour_settings(settings);
  auto scene = scene_of(settings, prepared.start.segments[index(Segment::pelvis)].rotation);
  if (!scene) return scene.error();
  prepared.scene = *scene;
  return prepared;
}

SimulationInput simulation_input(const Prepared& prepared, const Scene& scene,
                                 const SimulationSettings& settings) {
  return {prepared.body,
          prepared.range,
          prepared.thresholds,
          prepared.strength,
          prepared.start.state,
          scene,
          settings,
          behaviour_of(prepared.body, prepared.start.state.segments, scene, prepared.behaviour, settings)};
}

}  // namespace ukemi
