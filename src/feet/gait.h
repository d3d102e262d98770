// A gait: what a body that walks or runs would do without the blow, moment by moment.
#pragma once

#include <vector>

#include "feet/legs.h"

namespace ukemi {

/// A time in which a foot is on the ground, s from the blow.
struct Stand {
  double from_s = 0.0, until_s = 0.0;
  Vec2 sole = Vec2::Zero();      // where, world
  Vec2 catch_at = Vec2::Zero();  // the capture point when the foot comes down, from `sole`
};

class Gait {
 public:
  Gait() = default;
  /// `frames`: poses above a floor at y = 0 from the blow on, `step_s` apart, at least two.
  /// `legs`: of the same body as it stands.
  Gait(const ArticulatedBody& body, const PerSide<Leg>& legs, const std::vector<BodyPose>& frames,
       double step_s, double gravity);

  bool empty() const { return frames_.empty(); }
  double end_s() const { return step_s_ * static_cast<double>(frames_.size() - 1); }
  BodyPose pose(double time_s) const;
  Vec3 com(double time_s) const { return at(com_, time_s); }
  Vec3 velocity(double time_s) const { return at(velocity_, time_s); }
  Vec3 acceleration(double time_s) const { return at(acceleration_, time_s); }
  /// In the order of time.
  const std::vector<Stand>& stands(BodySide side) const { return stands_[index(side)]; }
  /// Mean over the whole gait, m/s.
  double speed() const { return speed_; }

 private:
  void stand_on_floor(const PerSide<Leg>& legs);
  Vec3 at(const std::vector<Vec3>& values, double time_s) const;
  std::vector<Stand> stands_of(const Leg& leg, double gravity) const;

  std::vector<BodyPose> frames_;
  double step_s_ = 1.0 / 120.0;
  std::vector<Vec3> com_, velocity_, acceleration_;
  PerSide<std::vector<Stand>> stands_;
  double speed_ = 0.0;
};

}  // namespace ukemi
