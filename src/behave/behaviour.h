// What a body does after the blow: lives, is dazed, or is limp.
#pragma once

#include <memory>
#include <vector>

#include "behave/knocked_out.h"
#include "body/muscles.h"
#include "feet/stand.h"
#include "simulate/simulate.h"

namespace ukemi {

enum class Behaviour {
  alert,  // balances, steps, protects itself
  dazed,  // the same, but late and weak, with one step to keep its balance
  limp    // tone alone, which fades
};

/// What a person might as well have done. The default is what the mean person does.
struct Choice {
  std::optional<BodySide> first_foot;
  double swing = 1.0;                // times the time that a step takes
  double width = 1.0;                // times how wide a step aside may be while going forward
  double tension = 1.0;              // times the drives of the muscles, below their caps
  double ride = 1.0;                 // times how far head and trunk go with the blow
  std::optional<double> gives_in_s;  // gives in and falls from then on
  Help help;                         // from outside
};

struct BehaviourSettings {
  Behaviour kind = Behaviour::alert;
  int most_steps = 6;               // of a recovery; 0: the feet stay where they are
  std::optional<double> latency_s;  // unless given: 0.10, dazed 0.20
  double muscle = 1.0;              // strength, of a healthy adult's
  std::uint64_t seed = 0;           // varies latency, arms and steps; 0: none
  PerSide<bool> arms_free{true, true};
  std::optional<UnderWay> under_way;  // a start from motion
  /// It goes on with the motion that it started from: its poses above a floor at y = 0 from the blow on,
  /// `gait_step_s` apart; null: it comes to stand.
  std::shared_ptr<const std::vector<BodyPose>> goes_on;
  double gait_step_s = 1.0 / 120.0;
  Choice choice;
  std::optional<Knockout> knockout;  // lives until then; not of a limp body
  bool breathes = true;              // once it lies
  bool must_stand = false;           // the run ends when balance is lost
};

/// The behaviour of a body that stands in `home` when the blow of `scene` comes. `home`, `body`, `range` and
/// `strength` must outlive the runs.
MakeController behaviour_of(const ArticulatedBody& body, const RangeOfMotion& range,
                            const MuscleStrength& strength, const BodyPose& home, const Scene& scene,
                            const BehaviourSettings& behaviour, const SimulationSettings& settings);

}  // namespace ukemi
