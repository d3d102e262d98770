// Which way a body falls, and which of its sides will meet the ground.
#pragma once

#include <optional>

#include "behave/fall_body.h"

namespace ukemi {

/// Contract: forward + backward + sideways = 1 once the way is known; at most one of forward and backward is
/// above 0.
struct FallWay {
  Vec3 along = Vec3::Zero();      // horizontal unit vector, world; zero while nothing is known
  double beyond_m = 0.0;          // farthest that the centre of mass has been outside the soles
  Vec2 side_down = Vec2::Zero();  // towards the ground, in the chest: to the front, to the right; unit
  double forward = 0.0, backward = 0.0, sideways = 0.0;
  double side = 1.0;  // side of the fall: -1 left, 1 right
};

/// Kept up to date while another behaviour stands, and during the fall.
class FallDirection {
 public:
  void update(const FallBody& body, const Senses& senses, double h);
  const FallWay& way() const { return way_; }

 private:
  void follow_fall(const FallBody& body, const Senses& senses);
  void follow_side(const Senses& senses, double h);

  FallWay way_;
  bool down_ = false;  // something but a foot has touched the floor
};

}  // namespace ukemi
