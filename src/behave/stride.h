// Striding: goes on with a gait through a blow.
//
// The body does what its clip does, and three things beside it: the legs on the ground push as the clip's
// weight and speed ask and as the balance needs, feet land where the capture point will be as the clip has it
// there, and the clip waits for a foot that is late and hurries after one that is early.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "behave/flinch.h"
#include "behave/gait.h"
#include "behave/physique.h"
#include "behave/stand.h"
#include "body/muscles.h"
#include "simulate/controller.h"

namespace ukemi {

class Striding : public OnFeet {
 public:
  Striding(const ArticulatedBody& body, const BodyPose& home, const MuscleStrength& strength, double gravity,
           const StandSettings& settings, std::shared_ptr<const Gait> gait);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(Goals& goals) const override;

  const std::vector<StepTaken>& steps() const override { return steps_; }
  std::optional<BodySide> swinging() const override;
  bool calm() const override { return stops_ && stops_->calm(); }
  std::optional<double> goes_on_from_s() const override;
  const Physique& physique() const override { return physique_; }

 private:
  struct Foot {
    bool stands = true;
    std::size_t stand = 0;  // of the gait: the present one, or the next
    double lifted_s = 0.0;  // of the gait
    Vec3 off = Vec3::Zero();  // of the ankle from the gait's, when it was lifted
    bool in_air = false;
    Vec2 to = Vec2::Zero();
    Vec3 planted = Vec3::Zero();  // ankle, since the foot stands
    double late_s = 0.0;          // in the air, when the gait has it on the ground
    double bears = 0.0;           // 0 to 1: it has been on the ground for a while
    double landed_s = -1e9;       // time of the run
  };
  struct View;

  View view_of(const Senses& senses) const;
  const Leg& leg(BodySide side) const { return legs_[ukemi::index(side)]; }
  const Foot& foot(BodySide side) const { return feet_[ukemi::index(side)]; }
  double m(double metres) const { return metres * physique_.size; }
  double s(double seconds) const { return seconds * physique_.tempo; }
  double m_s(double speed) const { return speed * physique_.tempo; }

  std::optional<Stand> stand_of(BodySide side) const;
  bool must_stop(const View& view) const;
  void stop(const Senses& senses);
  double pace(const Senses& senses) const;
  void change_feet(const Senses& senses);
  void lift(const Senses& senses, BodySide side);
  Vec2 landing_place(const Senses& senses, const View& view, BodySide side) const;
  void watch(const Senses& senses, const View& view, double h);
  double out_of_reach(const Senses& senses, const View& view) const;

  void ask(const Senses& senses);
  void ask_standing_leg(const Senses& senses, const View& view, BodySide side);
  void ask_swinging_leg(const Senses& senses, const View& view, BodySide side);
  void ask_upper_body(const Senses& senses, const View& view);
  LegPosture posture(const BodyPose& gait, BodySide side, const Vec3& hip, const Vec3& ankle) const;
  Vec3 swing_ankle(const BodyPose& gait, const View& view, BodySide side, double phase_s) const;
  void ask_joint(Joint joint, const Quat& goal, const Vec3& velocity, const Vec3& feed_forward, double share,
                 double damping_s);

  const ArticulatedBody* body_;
  BodyPose home_;
  StandSettings settings_;
  std::unique_ptr<Standing> stops_;  // since it has given the gait up
  std::size_t strides_ = 0;          // steps until then
  Physique physique_;
  PerSide<Leg> legs_;
  std::shared_ptr<const Gait> gait_;
  Flinch flinch_;
  PerSide<double> ankle_n_m_, knee_n_m_;  // that they can push with
  double home_height_ = 0.0;  // of the centre of mass that stands

  double sunk_m_ = 0.0;  // below the gait, so that the legs reach
  double time_s_ = 0.0, phase_s_ = 0.0, pace_ = 1.0, back_s_ = 0.0;
  PerSide<Foot> feet_;
  std::vector<StepTaken> steps_;
  Goals asked_;
};

}  // namespace ukemi
