// A body that falls with care: hands to the ground where it will come down, legs that give, chin tucked or
// face kept up; it lands like a brake, settles into a pose that a person would lie in, and breathes.
#pragma once

#include <optional>

#include "behave/fall_arms.h"
#include "behave/fall_landing.h"
#include "behave/fall_posture.h"
#include "behave/lying.h"
#include "simulate/controller.h"

namespace ukemi {

struct FallSettings {
  double rise_s = 0.28;                 // until the posture is fully wanted, of a man of 1.78 m
  double strength = 1.0;                // share of the effort that a healthy adult makes
  double propping = 1.0;                // share of the effort kept after landing
  PerSide<bool> arms_free{true, true};  // that protect; the others hold something
  bool breathes = true;
  std::uint64_t seed = 0;

  static FallSettings alert() { return {}; }
  /// Late and weak: struck hard, but not out.
  static FallSettings dazed();
};

class Falling : public Controller {
 public:
  Falling(const FallSettings& settings, const ArticulatedBody& body, const RangeOfMotion& range,
          const MuscleStrength& strength);

  /// Keeps the direction of the fall up to date while the body still stands.
  void watch(const Senses& senses, double h);
  /// The fall begins. From `fade_from_s` of a joint on (infinite: not yet), its goals fade in over 0.1 s;
  /// their springs start from the rotation that the joint has then.
  void begin(const Senses& senses, const PerJoint<double>& fade_from_s);
  /// Fades in a joint whose time was not known in begin().
  void fade_in(Joint joint, double from_s);
  /// Share of a joint's goals that is in force, 0 to 1; what drove the joint before keeps the rest.
  double faded(Joint joint, double time_s) const;
  bool begun() const { return report_.begins_s.has_value(); }
  bool landed() const { return report_.landed_s.has_value(); }

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(double time_s, Goals& goals) const override;
  bool done() const override;

  ControllerReport report() const override;
  const FallWay& way() const { return direction_.way(); }

 private:
  /// How a joint is driven: share of full effort, damping over stiffness in s.
  struct Effort {
    double share = 0.0, damping_s = 0.12;
  };
  /// A change of what a joint is asked for, eased over a time.
  struct Turn {
    Quat from = Quat::Identity();
    double from_share = 0.0;
    double begins_s = 0.0, takes_s = 0.28;
    double way(double time_s) const;
  };
  enum class Part { trunk, neck, arm_l, arm_r, legs };

  static Part part_of(Joint joint);
  bool protects(BodySide side) const;
  void feel(const Senses& senses);
  void capture(const Senses& senses);
  void choose_pose(const Senses& senses, double h);
  void settle_parts(const Senses& senses);
  bool is_flat(double time_s) const;
  bool is_settling(Part part) const { return settling_[static_cast<std::size_t>(part)]; }
  void settle(Part part, double time_s, double takes_s);
  void watch_calm(const Senses& senses, double h);
  PerJoint<Quat> goals_of(const Senses& senses) const;
  void aim_arms(const Senses& senses, PerJoint<Quat>& goals) const;
  Effort effort_of(Joint joint, double time_s) const;
  Effort falling_effort(Joint joint, double time_s) const;
  Effort arm_effort(Joint joint, double time_s) const;
  double lying_share(Joint joint) const;
  void ask(const Senses& senses);
  void breathe(Joint joint, double time_s, JointGoal& goal) const;

  FallSettings settings_;
  FallBody body_;
  FallVariation variation_;
  FallDirection direction_;
  Landing landing_;
  FallReport report_;
  Senses before_;

  PerJoint<double> fade_from_s_{};
  PerJoint<std::optional<Quat>> captured_;
  PerJoint<Turn> turns_;
  PerJoint<Quat> held_;  // what is asked for now
  PerJoint<double> share_{};
  PerJoint<double> damping_s_{};
  PerJoint<Vec3> velocity_;
  std::array<bool, 5> settling_{};  // parts
  EndPose pose_ = EndPose::standing;
  EndPose seen_ = EndPose::standing;  // and for how long
  double seen_s_ = 0.0;
  bool flat_ = false;  // on the belly: the legs lie down
  double calm_s_ = 0.0, slow_s_ = 0.0, still_s_ = 0.0;
  std::optional<double> rest_s_;
};

}  // namespace ukemi
