// What happens to the body: the blow.
#pragma once

#include <vector>

#include "base/math.h"
#include "base/segments.h"

namespace ukemi {

enum class SceneKind { ball, slope, fall, push, impulse, box, none, trip, slip, pull, explosion };

/// A force for a time: a push, a pull, a caught foot, feet that are drawn away.
inline bool is_push(SceneKind kind) {
  return kind == SceneKind::push || kind == SceneKind::trip || kind == SceneKind::slip ||
         kind == SceneKind::pull;
}
/// Momentum at once.
inline bool is_impulse(SceneKind kind) { return kind == SceneKind::impulse || kind == SceneKind::explosion; }

/// A part of the body that takes part of a push or an impulse: its share times its direction.
struct Load {
  Segment segment = Segment::chest;
  Vec3 way = Vec3(0, 0, 0);
};

/// The blow. Distances in metres, directions in the world.
struct Scene {
  SceneKind kind = SceneKind::ball;
  Segment target = Segment::chest;
  Vec3 direction = Vec3(0, 0, 0);  // unit: the way the blow travels
  /// ball: flies into the target, above the floor. slope: rolls down a ramp into the body. box: a cube of
  /// that half edge slides in.
  Vec3 aim_offset = Vec3(0, 0, 0);  // ball, box: from the target's centre to where it is aimed
  double ball_mass_kg = 5.0;
  double ball_speed_m_s = 6.0;  // at contact
  double ball_radius_m = 0.12;
  double slope_rad = radians(20.0);  // slope: of the ramp
  std::vector<Load> loads;           // push, impulse: shares of segments; none: all on the target
  double slippery_s = 0.0;           // slip: how long the soles find little hold
  double push_force_n = 300.0;       // push: force on the target
  double push_duration_s = 0.2;
  double impulse_n_s = 30.0;   // impulse: momentum given to the target at once
  double fall_height_m = 0.0;  // fall: start height above the floor
  double tip_speed_m_s = 0.8;  // fall: of the centre of mass, about the feet, along the direction
};

}  // namespace ukemi
