#include "behave/tone.h"

#include <algorithm>

namespace ukemi {
namespace {

constexpr double kSlowSpeed = 0.2;    // m/s, and
constexpr double kSlowTurning = 1.0;  // rad/s: for kSlowSpan_s the body settles into the pose it has
constexpr double kSlowSpan_s = 0.15;
constexpr double kSettleRamp_s = 0.5;
constexpr double kSettleShare = 0.5;  // of the tone

/// What a man's joint can give, N m: isometric maxima of adult men, the weaker direction (dynamometry; neck,
/// trunk, shoulder and elbow are rough). Coarser than assets/muscles.toml, and kept: the limp body's figures
/// rest on it.
double joint_torque(Joint joint) {
  switch (joint) {
    case Joint::spine:
      return 200.0;
    case Joint::chest:
      return 150.0;
    case Joint::neck:
      return 30.0;
    case Joint::clavicle_l:
    case Joint::clavicle_r:
    case Joint::shoulder_l:
    case Joint::shoulder_r:
      return 60.0;
    case Joint::elbow_l:
    case Joint::elbow_r:
      return 45.0;
    case Joint::wrist_l:
    case Joint::wrist_r:
      return 10.0;
    case Joint::hip_l:
    case Joint::hip_r:
      return 150.0;
    case Joint::knee_l:
    case Joint::knee_r:
      return 150.0;
    case Joint::ankle_l:
    case Joint::ankle_r:
      break;
  }
  return 60.0;
}

}  // namespace

ToneBehaviour::ToneBehaviour(const ArticulatedBody& body, const ToneSettings& settings)
    : settings_(settings) {
  // Torques grow with weight and height.
  const double strength = settings.share * body.mass_kg * body.height_m / (73.0 * 1.741);
  for (int j = 0; j < kJointCount; ++j) {
    fused_[j] = body.joints[j].fused;
    torque_n_m_[j] = strength * joint_torque(joint_at(j));
  }
}

void ToneBehaviour::capture(const Senses& senses) {
  for (int j = 0; j < kJointCount; ++j)
    held_[j] = senses.pose[index(parent_of(joint_at(j)))].rotation.conjugate() *
               senses.pose[index(child_of(joint_at(j)))].rotation;
}

void ToneBehaviour::start(const Senses& senses) { capture(senses); }

void ToneBehaviour::observe(const Senses& senses, double h) {
  const bool slow = senses.fastest_m_s < kSlowSpeed && senses.fastest_turning_rad_s < kSlowTurning;
  slow_s_ = slow ? slow_s_ + h : 0.0;
  if (slow_s_ <= kSlowSpan_s || settling_since_s_ || senses.time_s <= settings_.fade_s) return;
  settling_since_s_ = senses.time_s;
  capture(senses);
}

/// Full at the blow, gone after the fade, back in part once the body lies still.
double ToneBehaviour::share(double time_s) const {
  if (settling_since_s_) return kSettleShare * std::min(1.0, (time_s - *settling_since_s_) / kSettleRamp_s);
  if (settings_.fade_s <= 0.0) return 0.0;
  const double left = std::clamp(1.0 - time_s / settings_.fade_s, 0.0, 1.0);
  return left * left * (3.0 - 2.0 * left);
}

void ToneBehaviour::drive(double time_s, Goals& goals) const {
  const double share_now = share(time_s);
  for (int j = 0; j < kJointCount; ++j)
    if (!fused_[j] && torque_n_m_[j] > 0.0) goals.tone[j] = SoftGoal{held_[j], share_now * torque_n_m_[j]};
}

MakeController limp_behaviour(const ArticulatedBody& body, const SimulationSettings& settings) {
  const ToneSettings tone{tone_of(settings), settings.tone_fade_s};
  if (tone.share <= 0.0) return nullptr;
  return [&body, tone] { return std::make_unique<ToneBehaviour>(body, tone); };
}

}  // namespace ukemi
