#include "prepare/settings.h"

#include <algorithm>

namespace ukemi {

std::string reaction_name(const BakeSettings& settings) {
  if (!settings.reaction.empty()) return settings.reaction;
  std::string from = settings.from.text;
  std::replace(from.begin(), from.end(), ',', '_');
  return std::string(name(settings.hit)) + "_" + from;
}

double simulated_s(const BakeSettings& settings) {
  if (settings.simulation.duration_s) return *settings.simulation.duration_s;
  if (gets_up_after_s(settings)) return 12.0;
  return behaviour_settings(settings).kind == Behaviour::limp ? 3.0 : 4.0;
}

std::optional<double> gets_up_after_s(const BakeSettings& settings) {
  constexpr double kLies_s = 0.8;
  if (settings.get_up_s || settings.get_up_clip.empty()) return settings.get_up_s;
  return kLies_s;
}

BehaviourSettings behaviour_settings(const BakeSettings& settings) {
  BehaviourSettings behaviour;
  const bool fixed = settings.simulation.fixed_hz > 0.0;
  behaviour.kind = settings.behaviour.value_or(fixed ? Behaviour::limp : Behaviour::alert);
  behaviour.most_steps = static_cast<int>(settings.most_steps);
  behaviour.latency_s = settings.latency_s;
  if (behaviour.kind != Behaviour::limp) behaviour.knockout = settings.knockout;
  behaviour.breathes = settings.breathes;
  behaviour.muscle = settings.muscle;
  const HoldingArms arms = settings.arms;
  behaviour.arms_free = {arms != HoldingArms::left && arms != HoldingArms::both,
                         arms != HoldingArms::right && arms != HoldingArms::both};
  behaviour.seed = static_cast<std::uint64_t>(settings.seed);
  return behaviour;
}

}  // namespace ukemi
