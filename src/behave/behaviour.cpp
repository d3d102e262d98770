#include "behave/behaviour.h"

#include <algorithm>

#include "base/random.h"
#include "behave/alert.h"
#include "behave/tone.h"
#include "feet/stride.h"

namespace ukemi {
namespace {

constexpr double kFullFlinch_m_s = 0.13;  // change of the body's speed that startles wholly
constexpr double kLatency_s = 0.10, kDazedLatency_s = 0.20;
constexpr double kDazedStrength = 0.55;
constexpr int kDazedSteps = 1;

/// N s that the blow brings.
double momentum_of(const Scene& scene) {
  switch (scene.kind) {
    case SceneKind::ball:
    case SceneKind::slope:
    case SceneKind::box:
      return scene.ball_mass_kg * scene.ball_speed_m_s;
    case SceneKind::push:
    case SceneKind::trip:
    case SceneKind::slip:
    case SceneKind::pull:
      return scene.push_force_n * scene.push_duration_s;
    case SceneKind::impulse:
    case SceneKind::explosion:
      return scene.impulse_n_s;
    case SceneKind::fall:
    case SceneKind::none:
      break;
  }
  return 0.0;
}

/// Human spread: latency, arms, the width and the timing of steps.
void vary(StandSettings& stand, std::uint64_t seed) {
  Random random(seed);
  const auto times = [&random](double& value, double spread) {
    value *= random.uniform(1.0 - spread, 1.0 + spread);
  };
  times(stand.latency_s, 0.15);
  times(stand.lift_s, 0.25);
  times(stand.swing_s, 0.08);
  times(stand.step_scale, 0.09);
  for (double& arm : stand.arm_size) times(arm, 0.3);
  times(stand.flinch.left_arm, 0.3);
  times(stand.flinch.right_arm, 0.3);
  times(stand.flinch.begins_s, 0.2);
  times(stand.flinch.holds_until_s, 0.2);
  stand.foot_bias_m = random.uniform(-0.06, 0.06);
}

void choose(StandSettings& stand, const Choice& choice) {
  stand.first_foot = choice.first_foot;
  stand.swing_s *= choice.swing;
  stand.narrow_m *= choice.width;
  stand.strength *= choice.tension;
  stand.flinch.size *= choice.ride;
  stand.gives_in_s = choice.gives_in_s;
  stand.help = choice.help;
}

StandSettings stand_settings(const ArticulatedBody& body, const Scene& scene,
                             const BehaviourSettings& asked) {
  const bool dazed = asked.kind == Behaviour::dazed;
  StandSettings stand;
  stand.most_steps = dazed ? std::min(asked.most_steps, kDazedSteps) : asked.most_steps;
  stand.latency_s = asked.latency_s.value_or(dazed ? kDazedLatency_s : kLatency_s);
  stand.strength = dazed ? kDazedStrength : 1.0;
  stand.arms_free = asked.arms_free;
  stand.under_way = asked.under_way;
  const bool blow = scene.kind != SceneKind::none && scene.kind != SceneKind::fall;
  if (blow) stand.flinch.way = scene.direction;
  if (asked.seed != 0) vary(stand, asked.seed);
  stand.flinch.size = std::min(1.0, momentum_of(scene) / body.mass_kg / kFullFlinch_m_s);
  choose(stand, asked.choice);
  return stand;
}

/// The start clip that the body goes on with; null: it comes to stand.
std::shared_ptr<const Gait> gait_of(const ArticulatedBody& body, const BodyPose& home,
                                    const BehaviourSettings& behaviour, double gravity) {
  if (!behaviour.goes_on) return nullptr;
  const PerSide<Leg> legs{Leg(body, home, BodySide::left), Leg(body, home, BodySide::right)};
  auto gait = std::make_shared<Gait>(body, legs, *behaviour.goes_on, behaviour.gait_step_s, gravity);
  const bool walks = !gait->stands(BodySide::left).empty() && !gait->stands(BodySide::right).empty();
  return walks ? gait : nullptr;
}

}  // namespace

MakeController behaviour_of(const ArticulatedBody& body, const RangeOfMotion& range,
                            const MuscleStrength& strength, const BodyPose& home, const Scene& scene,
                            const BehaviourSettings& behaviour, const SimulationSettings& settings) {
  if (behaviour.kind == Behaviour::limp) return limp_behaviour(body, settings);
  const StandSettings stand = stand_settings(body, scene, behaviour);
  FallSettings fall = behaviour.kind == Behaviour::dazed ? FallSettings::dazed() : FallSettings::alert();
  fall.arms_free = behaviour.arms_free;
  fall.seed = behaviour.seed;
  fall.breathes = behaviour.breathes;
  const std::shared_ptr<const Gait> gait = gait_of(body, home, behaviour, settings.gravity);
  return [&body, &range, &strength, &home, stand, fall, gravity = settings.gravity,
          tone = ToneSettings{tone_of(settings), settings.tone_fade_s}, knockout = behaviour.knockout,
          must_stand = behaviour.must_stand, gait]() -> std::unique_ptr<Controller> {
    std::unique_ptr<OnFeet> on_feet = std::make_unique<Standing>(body, home, gravity, stand);
    if (gait) on_feet = std::make_unique<Striding>(body, home, gravity, stand, gait);
    auto alive = std::make_unique<Alert>(std::move(on_feet), body, range, strength, fall, must_stand);
    if (!knockout) return alive;
    return std::make_unique<KnockedOut>(std::move(alive), body, *knockout, tone);
  };
}

}  // namespace ukemi
