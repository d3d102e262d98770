#include "bake/settings.h"

#include <algorithm>

namespace ukemi {

std::string reaction_name(const BakeSettings& settings) {
  if (!settings.reaction.empty()) return settings.reaction;
  std::string from = settings.from.text;
  std::replace(from.begin(), from.end(), ',', '_');
  return std::string(name(settings.hit)) + "_" + from;
}

BehaviourSettings behaviour_settings(const BakeSettings& settings) {
  BehaviourSettings behaviour;
  const bool fixed = settings.simulation.fixed_hz > 0.0;
  behaviour.kind = settings.behaviour.value_or(fixed ? Behaviour::limp : Behaviour::alert);
  behaviour.most_steps = static_cast<int>(settings.most_steps);
  behaviour.latency_s = settings.latency_s;
  behaviour.muscle = settings.muscle;
  behaviour.seed = static_cast<std::uint64_t>(settings.seed);
  return behaviour;
}

}  // namespace ukemi
