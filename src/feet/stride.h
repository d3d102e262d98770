// Striding: goes on with a gait through a blow.
//
// The body does what its clip does, and three things beside it: the legs on the ground push as the weight and
// the speed of the clip ask and as the balance needs; feet land where the capture point will be from them as
// in the clip; and the clip waits for a foot that is late and goes on faster with a body that is ahead of it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "feet/flinch.h"
#include "feet/gait.h"
#include "feet/on_feet.h"
#include "feet/physique.h"
#include "feet/stand.h"

namespace ukemi {

class Striding : public OnFeet {
 public:
  /// `home`: the pose that the body stands in.
  Striding(const ArticulatedBody& body, const BodyPose& home, double gravity, const StandSettings& settings,
           std::shared_ptr<const Gait> gait);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;

  const std::vector<StepTaken>& steps() const override { return steps_; }
  std::optional<BodySide> swinging() const override;
  bool calm() const override { return false; }
  std::optional<GoesOn> goes_on() const override;
  const Physique& physique() const override { return physique_; }

 private:
  struct Foot {
    bool stands = true;
    std::size_t stand = 0;        // of the gait: the present one, or the next
    double lifted_s = 0.0;        // moment of the gait
    Vec3 off = Vec3::Zero();      // of the ankle from the gait's, when it was lifted
    Vec2 to = Vec2::Zero();       // where it is to land
    bool in_air = false;          // it has left the ground
    double late_s = 0.0;          // in the air, when the gait has it on the ground
    Vec3 planted = Vec3::Zero();  // ankle, since the foot stands
    double bears = 0.0;           // 0 to 1: it has been on the ground for a while
    double landed_s = -1e9;
  };
  struct View;

  const Leg& leg(BodySide side) const { return legs_[ukemi::index(side)]; }
  const Foot& foot(BodySide side) const { return feet_[ukemi::index(side)]; }
  Foot& foot(BodySide side) { return feet_[ukemi::index(side)]; }
  double m(double metres) const { return metres * physique_.size; }
  double s(double seconds) const { return seconds * physique_.tempo; }
  double m_s(double speed) const { return speed * physique_.tempo; }

  View view_of(const Senses& senses) const;
  void see_balance(View& view) const;
  void see_force(const Senses& senses, View& view) const;
  Vec2 heading() const;

  // The gait and its feet.
  std::optional<Stand> stand_of(BodySide side) const;
  double pace(const View& view) const;
  bool may_lift(BodySide side) const;
  bool lands(const Senses& senses, BodySide side) const;
  void lift(const Senses& senses, BodySide side);
  void land(const Senses& senses, BodySide side);
  void change_feet(const Senses& senses);
  void feel_feet(const Senses& senses, double h);
  Vec2 error_at_landing(const View& view, BodySide side, double left_s) const;
  Vec2 landing_place(const View& view, BodySide side) const;
  double out_of_reach(const Senses& senses, const View& view) const;
  void watch(const Senses& senses, const View& view, double h);

  // What is asked of the muscles.
  void ask(const Senses& senses);
  void ask_standing_leg(const Senses& senses, const View& view, BodySide side);
  void ask_swinging_leg(const Senses& senses, const View& view, BodySide side);
  void ask_upper_body(const Senses& senses, const View& view);
  LegPosture posture(const BodyPose& gait, BodySide side, const Vec3& hip, const Vec3& ankle) const;
  Vec3 swing_ankle(const BodyPose& gait, const View& view, BodySide side, double phase_s) const;

  StandSettings settings_;
  Physique physique_;
  PerSide<Leg> legs_;
  std::shared_ptr<const Gait> gait_;
  Flinch flinch_;
  double home_height_ = 0.0;  // of the centre of mass that stands

  double time_s_ = 0.0;
  double phase_s_ = 0.0;  // moment of the gait, s from the blow
  double pace_ = 1.0;     // its speed
  double sunk_m_ = 0.0;   // below the gait, so that the legs reach
  double well_s_ = 0.0;   // time for which it has gone as the gait does
  PerSide<Foot> feet_;
  std::vector<StepTaken> steps_;
};

}  // namespace ukemi
