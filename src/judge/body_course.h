// Where the parts of a body are over time, in the metres of a man of 1.75 m.
#pragma once

#include <array>
#include <vector>

#include "judge/judged_motion.h"
#include "judge/signal.h"

namespace ukemi {

inline constexpr double kJudgedHeight = 1.75;  // m, that lengths are scaled to

/// Arm: shoulder, elbow, wrist, knuckle. Leg: hip, knee, ankle, ball of the foot.
struct LimbCourse {
  Course root, middle, end, tip;
};

/// Contract:
/// 1. y = 0 is the floor: the height that the lowest of ankles and balls of the feet is below in 3 % of the
///    frames. Heights are those of joint centres over it.
/// 2. Sides: left, right.
/// 3. com: centre of mass from joint positions (masses and centres: de Leva 1996).
struct BodyCourse {
  double fps = 60.0;
  int frames = 0;
  Course pelvis, chest, head, crown, com;
  Course shoulders, hips;  // midway between left and right
  Course up, front;        // unit: from hips to shoulders; forward out of the chest
  std::array<LimbCourse, 2> arms, legs;
  std::vector<double> lean_deg;  // of `up` from the vertical
};

BodyCourse body_course_of(const JudgedMotion& motion);

/// 0 for a, b, c in a line, 180 for a and c in the same direction from b.
double flexion_deg(const Vec3& a, const Vec3& b, const Vec3& c);
/// Of knee or elbow in a frame.
double flexion_deg(const LimbCourse& limb, int frame);
/// Of wrist or knuckle, whichever is lower.
double hand_height(const LimbCourse& arm, int frame);

}  // namespace ukemi
