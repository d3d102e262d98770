// A body that is knocked out: alive until then, limp from then on.
#pragma once

#include <optional>

#include "behave/alert.h"
#include "behave/tone.h"

namespace ukemi {

struct Knockout {
  enum class At {
    time,    // `time_s` after the blow
    blow,    // at once
    step,    // when the first step's foot is down, or balance is lost
    landing  // when the falling body is down
  };
  At at = At::blow;
  double time_s = 0.0;
};

class KnockedOut : public Controller {
 public:
  KnockedOut(std::unique_ptr<Alert> alive, const ArticulatedBody& body, const Knockout& knockout,
             const ToneSettings& tone);

  void start(const Senses& senses) override;
  void observe(const Senses& senses, double h) override;
  void drive(double time_s, Goals& goals) const override;
  bool done() const override { return out_s_ || alive_->done(); }
  bool hopeless() const override { return alive_->hopeless(); }
  ControllerReport report() const override;

 private:
  bool goes_out(double time_s) const;

  std::unique_ptr<Alert> alive_;  // goes on feeling what touches
  Knockout knockout_;
  ToneBehaviour limp_;
  std::optional<double> out_s_;
};

}  // namespace ukemi
