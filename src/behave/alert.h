// A body that lives: stands as long as it can, and falls with care when balance is lost.
#pragma once

#include <memory>

#include "behave/fall.h"
#include "feet/on_feet.h"

namespace ukemi {

/// What a share of a goal asks for.
JointGoal weakened(JointGoal goal, double share);

class Alert : public Controller {
 public:
  Alert(std::unique_ptr<OnFeet> on_feet, const ArticulatedBody& body, const RangeOfMotion& range,
        const MuscleStrength& strength, const FallSettings& falling, bool must_stand = false);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(double time_s, Goals& goals) const override;
  bool done() const override;
  bool hopeless() const override { return must_stand_ && on_feet_->lost_s(); }
  bool over() const override { return !falling_.begun() && on_feet_->goes_on(); }
  ControllerReport report() const override;

  /// A foot has been set down in a step.
  bool has_stepped() const;
  /// Balance is lost.
  bool falls() const { return on_feet_->lost_s().has_value(); }
  /// The falling body is down.
  bool has_landed() const { return falling_.landed(); }

 private:
  void begin_fall(const Senses& senses);
  void release_swinging_leg(const Senses& senses);
  bool standing_over(double time_s) const;

  std::unique_ptr<OnFeet> on_feet_;
  Falling falling_;
  double tempo_;
  bool must_stand_;
  double time_s_ = 0.0;
  std::optional<BodySide> swinging_;  // at the loss: this leg goes on until its foot is down
  bool over_ = false;                 // nothing of standing is left
};

}  // namespace ukemi
