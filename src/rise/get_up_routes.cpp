#include "rise/get_up_routes.h"

namespace ukemi {
namespace {

// clang-format off
//   phase, s,         pitch axial yaw, trunk turn, neck look,
//   arm a, arm b:     raise, abduction, in turn, elbow, wrist
//   leg a, leg b:     hip, abduction, out turn, knee, ankle

/// On his back: one foot comes under the knee, elbows and head up.
KeyPose draws_up() {
  return {"draws_up", 0.45,   -84, 0, 0,   8, 0,   22, 0,
          {-22, 24, 10, 78, 0}, {-26, 26, 10, 84, 0},
          {56, 6, 0, 92, -10}, {34, 14, 12, 60, -10},
          kSeat | kBody | kFootA};
}

// From all fours on.
KeyPose front_foot_planted() {
  return {"half_kneels", 0.48,   50, 0, 0,   26, 0,   -16, 0,
          {62, 8, 0, 12, -60}, {60, 10, 0, 16, -55},
          {112, 8, 6, 108, 16}, {52, 6, 4, 96, -10},
          kFootA | kKneeB | kToesB | kHandA | kHandB};
}
KeyPose half_kneel() {
  return {"", 0.5,   20, 0, 0,   20, 0,   -2, 0,
          {42, 10, 10, 58, -10}, {22, 12, 0, 32, 0},
          {96, 8, 6, 98, 14}, {16, 4, 4, 94, 8},
          kFootA | kKneeB | kToesB};
}
KeyPose lunge() {
  return {"rises", 0.5,   30, 0, 0,   18, 0,   -4, 0,
          {34, 8, 10, 40, 0}, {16, 10, 0, 28, 0},
          {78, 6, 6, 70, 22}, {14, 4, 4, 56, 24},
          kFootA | kToesB};
}
KeyPose feet_together() {
  return {"", 0.6,   16, 0, 0,   14, 0,   0, 0,
          {16, 8, 6, 26, 0}, {10, 9, 0, 24, 0},
          {32, 5, 4, 34, 14}, {34, 5, 4, 38, 14},
          kFootA | kFootB};
}

}  // namespace

Route squat_route() {
  return {"squat",
          {draws_up(),
           {"sits", 0.5,   -62, 0, 0,   30, 0,   30, 0,
            {-20, 18, 0, 55, 0}, {-25, 15, 0, 60, 0},
            {78, 8, 0, 108, -12}, {74, 8, 0, 104, -14},
            kSeat | kHandA | kHandB | kFootA},
           {"", 0.5,   -26, 0, 0,   32, 0,   10, 0,
            {-38, 16, 0, 14, -60}, {-38, 18, 0, 18, -60},
            {116, 8, 0, 118, -14}, {112, 8, 0, 114, -16},
            kSeat | kHandA | kHandB | kFootA | kFootB},
           {"squats", 0.45,   10, 0, 0,   42, 0,   -8, 0,
            {-14, 18, 0, 20, -60}, {-20, 20, 0, 22, -60},
            {124, 8, 4, 138, 18}, {122, 8, 4, 134, 18},
            kHandA | kHandB | kFootA | kFootB},
           {"", 0.4,   34, 0, 0,   34, 0,   -14, 0,
            {44, 12, 0, 36, 0}, {36, 12, 0, 30, 0},
            {118, 8, 4, 126, 28}, {116, 8, 4, 124, 28},
            kFootA | kFootB},
           {"rises", 0.45,   34, 0, 0,   18, 0,   -6, 0,
            {24, 8, 0, 28, 0}, {20, 8, 0, 24, 0},
            {70, 6, 4, 64, 18}, {68, 6, 4, 62, 18},
            kFootA | kFootB}},
          0.6};
}

Route half_kneel_route() {
  return {"half_kneel",
          {draws_up(),
           {"sits", 0.55,   -50, 0, 8,   30, 10,   24, 10,
            {10, 14, 10, 50, 0}, {-36, 22, 0, 40, -50},
            {84, 8, 0, 96, -12}, {60, 22, 20, 96, -14},
            kSeat | kFootA | kHandB},
           {"", 0.5,   -14, 0, 8,   34, 6,   4, 8,
            {-24, 28, 0, 14, -60}, {-30, 24, 0, 14, -60},
            {112, 6, 0, 114, -10}, {76, 34, 24, 126, -20},
            kSeat | kFootA | kKneeB | kToesB | kHandA | kHandB},
           {"half_kneels", 0.5,   26, 0, 6,   36, 0,   -6, 0,
            {2, 26, 0, 14, -60}, {24, 16, 0, 30, -20},
            {112, 8, 4, 116, 12}, {64, 14, 8, 116, -10},
            kHandA | kFootA | kKneeB | kToesB},
           half_kneel(), lunge(), feet_together()},
          0.42};
}

Route prone_route() {
  return {"prone",
          {{"reaches", 0.65,   90, 0, 0,   0, 0,   -15, 0,
            {-20, 36, 0, 112, -70}, {-18, 38, 0, 110, -70},
            {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0},
            kBody | kHandA | kHandB | kKneeA | kKneeB, true},
           {"pushes", 0.4,   80, 0, 0,   -10, 0,   -28, 0,
            {24, 30, 0, 70, -70}, {22, 30, 0, 72, -70},
            {26, 8, 0, 46, -20}, {22, 8, 0, 42, -20},
            kHandA | kHandB | kKneeA | kKneeB},
           {"on_all_fours", 0.4,   68, 0, 0,   6, 0,   -22, 0,
            {80, 10, 0, 12, -72}, {76, 10, 0, 12, -72},
            {76, 8, 0, 94, -25}, {72, 8, 0, 92, -25},
            kHandA | kHandB | kKneeA | kKneeB | kToesB},
           front_foot_planted(), half_kneel(), lunge(), feet_together()},
          0.42};
}

Route kneeling_route() {
  KeyPose steps = half_kneel();
  steps.phase = "half_kneels";
  steps.seconds = 0.6;
  return {"kneeling", {steps, lunge(), feet_together()}, 0.45};
}

Route crouched_route() {
  KeyPose steps = lunge();
  steps.seconds = 0.6;
  return {"crouched", {steps, feet_together()}, 0.45};
}

Route side_route() {
  Route route = prone_route();
  route.name = "side";
  route.keys.front() = {"turns", 0.6,   80, -38, 0,   8, -8,   -10, 0,
                        {60, 20, 0, 70, -60}, {40, 20, 0, 110, -30},
                        {70, 10, 0, 90, -20}, {25, 6, 0, 50, -20},
                        kBody | kHandA | kKneeB};
  return route;
}
// clang-format on

}  // namespace ukemi
