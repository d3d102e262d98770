// Tone: a limp or dazed body that is hit stiffens first, then gives way.
#pragma once

#include <optional>

#include "body/body.h"
#include "simulate/simulate.h"

namespace ukemi {

struct ToneSettings {
  double share = 0.3;   // of a man's joint torques that hold the start pose at first, 0 to 1
  double fade_s = 0.6;  // until it has gone
};

/// Holds the start pose while it fades, and the pose that the body comes to lie in.
class ToneBehaviour : public Controller {
 public:
  ToneBehaviour(const ArticulatedBody& body, const ToneSettings& settings);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(double time_s, Goals& goals) const override;

 private:
  double share(double time_s) const;
  void capture(const Senses& senses);

  ToneSettings settings_;
  PerJoint<bool> fused_{};
  PerJoint<double> torque_n_m_{};
  PerJoint<Quat> held_;  // parent_from_child
  double slow_s_ = 0.0;
  std::optional<double> settling_since_s_;
};

/// What drives a limp body with these settings: its tone, or nothing.
MakeController limp_behaviour(const ArticulatedBody& body, const SimulationSettings& settings);

}  // namespace ukemi
