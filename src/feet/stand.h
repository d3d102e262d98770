// Standing: balances on the feet, sways back, steps, and knows when balance is lost.
//
// One page of equations (an extrapolated centre of mass, a wanted ground wrench, springs towards postures of
// the legs) and a small state machine. Lengths hold for legs of 0.857 m and are scaled by Physique::size,
// times and speeds by its root.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feet/drives.h"
#include "feet/flinch.h"
#include "feet/legs.h"
#include "feet/on_feet.h"
#include "feet/physique.h"
#include "simulate/controller.h"

namespace ukemi {

/// A body that is under way when the blow comes: what it does already is taken over.
struct UnderWay {
  /// When a foot that is in the air would land, s from the blow.
  PerSide<std::optional<double>> lands_in_s;
};

/// A force from outside on the pelvis that helps towards an outcome.
struct Help {
  double most_n = 0.0;  // 0: none
  bool down = false;    // pushes the body over, the way of the blow; else holds it up
};

struct StandSettings {
  std::optional<UnderWay> under_way;  // nothing: the body stands in its home pose
  int most_steps = 6;                 // of a recovery; 0: the feet stay where they are
  double latency_s = 0.10;            // after the blow nothing but passive body and tone acts
  double lift_s = 0.18;               // earliest moment that a foot leaves the ground
  double foot_bias_m = 0.0;           // cost of stepping with the left foot
  double step_scale = 1.0;            // of the way to the capture point
  double swing_s = 0.307;             // of an unhurried step
  double narrow_m = 0.40;             // a step aside while going forward is at most so wide
  double strength = 1.0;              // of the drives; a dazed body has less
  std::optional<BodySide> first_foot;
  std::optional<double> gives_in_s;  // from then on the body does not try to stand
  Help help;
  PerSide<bool> arms_free{true, true};
  PerSide<double> arm_size{1.1, 0.9};  // of catching arms
  FlinchSettings flinch;
};

class Standing : public OnFeet {
 public:
  /// `home`: the pose that is stood in: feet, height, joint angles.
  Standing(const ArticulatedBody& body, const BodyPose& home, double gravity, const StandSettings& settings);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;

  bool calm() const override { return calm_s_ > 0.0; }
  const std::vector<StepTaken>& steps() const override { return steps_; }
  std::optional<BodySide> swinging() const override;
  const Physique& physique() const override { return physique_; }

 private:
  enum class Phase { stand, shift, swing };
  struct Swing {
    BodySide side = BodySide::left;
    double lift_s = 0.0, span_s = 0.3;  // lift_s: later for a foot that lags behind its way
    bool closing = false;
    bool in_air = false;       // the foot has left the ground
    Vec3 from = Vec3::Zero();  // ankle at the lift
    Vec3 from_velocity = Vec3::Zero();
    Quat from_foot = Quat::Identity();
    Vec2 from_sole = Vec2::Zero();
    Vec2 to = Vec2::Zero();  // sole
    double to_yaw = 0.0;     // of the foot from home
  };
  struct View;
  struct Wrench;

  View view_of(const Senses& senses) const;
  const Leg& leg(BodySide side) const { return legs_[ukemi::index(side)]; }
  double m(double metres) const { return metres * physique_.size; }
  double s(double seconds) const { return seconds * physique_.tempo; }
  double m_s(double speed) const { return speed * physique_.tempo; }

  // The state machine.
  void choose(const Senses& senses, const View& view, double h);
  void stand_on(const Senses& senses, const View& view, double h);
  void shift_on(const Senses& senses, const View& view, double h);
  void swing_on(const Senses& senses, const View& view, double h);
  double lag(const Senses& senses) const;
  bool must_step(const View& view, double time_s) const;
  BodySide stepping_foot(const View& view) const;
  double cost_of(const View& view, BodySide swing) const;
  double swing_span(const View& view, BodySide swing) const;
  void lift(const Senses& senses, const View& view, BodySide side, bool closing);
  void land(const Senses& senses, const View& view);
  Vec2 landing_place(const View& view, BodySide swing, double time_left) const;
  Vec2 closing_place(const View& view, BodySide swing) const;
  bool stance_is_fine(const View& view) const;
  std::optional<BodySide> hanging_foot(const Senses& senses) const;
  void watch(const Senses& senses, const View& view, double h);
  double earliest_lift_s() const;

  // What is asked of the muscles.
  void ask(const Senses& senses, const View& view);
  Wrench wrench_of(const Senses& senses, const View& view) const;
  Quat attitude_of(const View& view) const;
  Vec2 wanted_pressure(const View& view) const;
  double pelvis_height(const Senses& senses, const View& view) const;
  LegPosture standing_posture(const Senses& senses, const View& view, BodySide side, const Vec2& shift) const;
  LegPosture swinging_posture(const Vec3& hip_at, double time_s) const;
  Vec3 swing_target() const;
  Vec3 swing_ankle(double time_s) const;
  Quat swing_foot(double phase, const Quat& level) const;
  void ask_standing_leg(const Senses& senses, const View& view, const Wrench& wrench, BodySide side);
  void ask_swinging_leg(const Senses& senses);
  void ask_upper_body(const Senses& senses);
  Vec3 help_of(const View& view) const;
  void ask_joint(Joint joint, const Drive& drive);
  double active(double time_s) const;
  void take_over(const Senses& senses);
  void go_on(const Senses& senses, BodySide side, double lands_in_s);
  Vec3 ankle_velocity(const Senses& senses, const Leg& leg) const;
  bool in_air(const Senses& senses, const Leg& leg) const;
  Quat taken_over(const Senses& senses, Joint joint, const Quat& goal, double from_s, double until_s) const;
  void update_slow_state(const Senses& senses, const View& view, double h);
  Vec3 standing_ankle(const Senses& senses, BodySide side) const;

  StandSettings settings_;
  Physique physique_;
  PerSide<Leg> legs_;
  BodyPose home_;
  std::optional<BodyPose> under_way_;  // pose at the start of a body under way
  Flinch flinch_;
  PerSide<Vec2> home_sole_;
  Vec2 home_com_ = Vec2::Zero();  // from the middle of the soles
  double home_height_ = 0.0;      // of the centre of mass
  Vec2 start_com_ = Vec2::Zero();

  Phase phase_ = Phase::stand;
  Swing swing_;
  BodySide shift_to_ = BodySide::left;
  double shift_since_s_ = 0.0, ready_s_ = 0.0, calm_s_ = 0.0, hanging_s_ = 0.0;
  PerSide<double> landed_s_{-1e9, -1e9};
  PerSide<double> points_{0.0, 0.0};    // yaw of a foot of the gait, as long as it stands, from home
  PerSide<Vec3> planted_;               // ankles where their feet came to stand
  PerSide<double> bearing_{1.0, 1.0};   // 1: the foot is on the ground, 0: it has been off it for a while
  Vec2 landing_offset_ = Vec2::Zero();  // of the reference, fading after a landing
  int steps_in_a_row_ = 0, closings_ = 0;
  double straightness_ = 1.0;  // wanted of the legs
  double heel_ = 1.0;          // 1: the less loaded heel may rise, 0: not
  double pelvis_y_ = 0.0;      // wanted
  double arms_up_ = 0.0;       // 0 to 1
  std::vector<StepTaken> steps_;
};

}  // namespace ukemi
