// A man of 1.75 m made of points, to be moved by hand.
#pragma once

#include <algorithm>
#include <functional>

#include "judge/judged_motion.h"

namespace ukemi {

/// Upright, facing +x, right at +z, ankles at 8 cm, balls of the feet on the floor (y = 0), arms hanging; no
/// rotation anywhere, so that the ends are offsets in the world.
inline BodyPose stick_man() {
  BodyPose pose;
  const auto at = [&](Segment s, double x, double y, double z) {
    pose[index(s)].translation = Vec3(x, y, z);
  };
  at(Segment::pelvis, 0.0, 0.92, 0.0);
  at(Segment::abdomen, 0.0, 1.02, 0.0);
  at(Segment::chest, 0.0, 1.15, 0.0);
  at(Segment::head, 0.0, 1.52, 0.0);
  for (const bool left : {true, false}) {
    const auto side = [&](Segment s) { return left ? s : mirror_of(s); };
    const double out = left ? -1.0 : 1.0;
    at(side(Segment::clavicle_l), 0.0, 1.42, 0.03 * out);
    at(side(Segment::upperarm_l), 0.0, 1.42, 0.18 * out);
    at(side(Segment::forearm_l), 0.0, 1.13, 0.18 * out);
    at(side(Segment::hand_l), 0.0, 0.88, 0.18 * out);
    at(side(Segment::thigh_l), 0.0, 0.92, 0.09 * out);
    at(side(Segment::shank_l), 0.0, 0.50, 0.09 * out);
    at(side(Segment::foot_l), 0.0, 0.08, 0.09 * out);
  }
  return pose;
}

inline void shift(BodyPose& pose, Segment segment, const Vec3& by) { pose[index(segment)].translation += by; }

/// Chest, head and arms.
inline void shift_upper_body(BodyPose& pose, const Vec3& by) {
  for (int s = index(Segment::chest); s <= index(Segment::hand_r); ++s) pose[s].translation += by;
}

/// Everything but shanks and feet.
inline void shift_above_knees(BodyPose& pose, const Vec3& by) {
  for (int s = 0; s <= index(Segment::hand_r); ++s) pose[s].translation += by;
  for (const Segment thigh : {Segment::thigh_l, Segment::thigh_r}) shift(pose, thigh, by);
}

using Move = std::function<void(double time_s, BodyPose& pose)>;

inline JudgedMotion stick_motion(double duration_s, const Move& move, double fps = 60.0) {
  JudgedMotion motion;
  motion.fps = fps;
  motion.mass_kg = 78.0;
  motion.ends.crown = Vec3(0.0, 0.23, 0.0);
  motion.ends.knuckle.fill(Vec3(0.0, -0.09, 0.0));
  motion.ends.ball_of_foot.fill(Vec3(0.14, -0.08, 0.0));
  for (int f = 0; f <= static_cast<int>(duration_s * fps + 0.5); ++f) {
    motion.frames.push_back(stick_man());
    move(f / fps, motion.frames.back());
  }
  return motion;
}

/// From 0 to 1 between two times, without speed at either.
inline double eased(double time_s, double from_s, double to_s) {
  const double t = std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
  return t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
}

}  // namespace ukemi
