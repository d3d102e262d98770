// A body that lives: stands as long as it can, and falls when balance is lost.
#pragma once

#include "behave/stand.h"
#include "behave/tone.h"

namespace ukemi {

class Alert : public Controller {
 public:
  Alert(const ArticulatedBody& body, const BodyPose& home, double gravity, const StandSettings& settings);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(double time_s, Goals& goals) const override;
  bool done() const override;
  ControllerReport report() const override;

 private:
  Standing standing_;
  ToneBehaviour tone_;
  bool falling_ = false;
  double time_s_ = 0.0, fall_s_ = 0.0;
};

}  // namespace ukemi
