// The key poses of getting up, as tables of angles that are the same for every body.
#pragma once

#include <string_view>
#include <vector>

namespace ukemi {

/// Degrees, 0 in the neutral pose. Side "a" leads: its foot comes first.
struct KeyLeg {
  double hip, abduction, out_turn, knee, ankle;  // flexion and dorsiflexion above 0
};
struct KeyArm {
  double raise, abduction, in_turn, elbow, wrist;  // wrist: palmar flexion above 0, extension below
};

/// What bears at a key. A part that bears at two keys in a row stays in its place between them.
enum KeyTouch : unsigned {
  kHandA = 1u << 0,
  kHandB = 1u << 1,
  kKneeA = 1u << 2,
  kKneeB = 1u << 3,
  kFootA = 1u << 4,  // flat, where it will stand
  kFootB = 1u << 5,
  kToesA = 1u << 6,
  kToesB = 1u << 7,
  kSeat = 1u << 8,
  kBody = 1u << 9,  // trunk and limbs as they lie: whatever is on the floor
};

struct KeyPose {
  std::string_view phase;    // begins here; empty: none
  double seconds;            // since the key before
  double pitch;              // of the pelvis: 0 upright, 90 on the belly, -90 on the back
  double axial;              // of the pelvis about its own axis: above 0 it lies on side a
  double yaw;                // of the pelvis, towards side b
  double trunk, trunk_turn;  // flexion; turn towards side b
  double neck, look;         // flexion; turn towards side b
  KeyArm arm_a, arm_b;
  KeyLeg leg_a, leg_b;
  unsigned touches;
  bool keeps_body = false;  // trunk and legs stay as they are: arms and head move first
};

struct Route {
  std::string_view name;

  std::vector<KeyPose> keys;  // the standing pose follows the last
  double rise_s;              // from the last key to the standing pose
};

Route squat_route();       // sits, rocks onto the feet, squats
Route half_kneel_route();  // sits to one side, half kneels
Route prone_route();       // pushes up, all fours, half kneels
Route kneeling_route();    // kneels upright: one foot forward, stands
Route crouched_route();    // on his feet, knees bent: stands
Route side_route();        // lies on side b: turns over side b onto hands and knees
}  // namespace ukemi
