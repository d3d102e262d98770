// The flinch: what head, trunk and arms do after a blow, with or without balance.
#pragma once

#include "base/math.h"
#include "base/segments.h"

namespace ukemi {

struct FlinchSettings {
  Vec3 way = Vec3::Zero();  // unit, world: the way the blow travels; zero: no blow
  double size = 1.0;        // 1: of a blow that changes the body's speed by 0.13 m/s or more
  double begins_s = 0.06, rise_s = 0.14, holds_until_s = 0.32, falls_s = 0.48;
  double left_arm = 1.2, right_arm = 0.8;  // arms react unequally
};

class Flinch {
 public:
  Flinch() = default;
  /// `yaw`: heading of the body at the blow.
  Flinch(const FlinchSettings& settings, double yaw);

  /// Turn to add to a joint's goal, in the axes of the parent segment.
  Vec3 turn(Joint joint, double time_s) const;

 private:
  double course(double time_s) const;
  FlinchSettings settings_;
  double sideways_ = 0.0;  // share of the blow that goes to the body's right
  double forward_ = 0.0;
};

}  // namespace ukemi
