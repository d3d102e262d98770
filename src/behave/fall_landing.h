// What a landing has come to: which parts have touched, whether the arms have braked, whether the body lies.
#pragma once

#include <optional>

#include "behave/fall_way.h"

namespace ukemi {

/// An arm that may carry: touched, then braked when its shoulder sinks no more.
struct ArmLanding {
  std::optional<double> touched_s, braked_s;
  Vec3 wrist = Vec3::Zero();  // world, where it was when the hand touched
  double sink_m_s = 0.0;      // of the shoulder then
  double brake = 1.0;         // 0 to 1: how hard it brakes: it yields where the shoulder sinks slowly
};

/// Advanced once per accepted step.
class Landing {
 public:
  void observe(const FallBody& body, const Senses& senses, const FallWay& way, double h);

  const ArmLanding& arm(BodySide side) const { return arms_[index(side)]; }
  /// Since when a knee has been on the floor in a forward fall.
  const std::optional<double>& kneels_s() const { return kneels_s_; }
  /// Since when the body is down: its trunk, an upper arm, a thigh that is not a forward fall's knee, or both
  /// arms braked.
  const std::optional<double>& landed_s() const { return landed_s_; }
  /// Since when pelvis, abdomen or chest has been on the floor.
  const std::optional<double>& trunk_down_s() const { return trunk_down_s_; }
  /// Since when the chest has been on the floor.
  const std::optional<double>& chest_down_s() const { return chest_down_s_; }

 private:
  void observe_arm(const FallBody& body, const Senses& senses, BodySide side, double h);
  bool is_down(const FallBody& body, const Senses& senses, const FallWay& way) const;

  PerSide<ArmLanding> arms_;
  std::optional<double> kneels_s_, landed_s_, trunk_down_s_, chest_down_s_;
};

}  // namespace ukemi
