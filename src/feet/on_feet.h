// What keeps a body on its feet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feet/physique.h"
#include "feet/sides.h"
#include "simulate/controller.h"

namespace ukemi {

class OnFeet {
 public:
  OnFeet() = default;
  OnFeet(const OnFeet&) = delete;
  OnFeet& operator=(const OnFeet&) = delete;
  virtual ~OnFeet() = default;

  virtual void start(const Senses& senses) = 0;
  /// After an accepted step of length `h`.
  virtual void observe(const Senses& senses, double h) = 0;
  void drive(Goals& goals) const;

  /// When and why balance was lost: what follows is a fall.
  const std::optional<double>& lost_s() const { return lost_s_; }
  const std::string& lost_why() const { return lost_why_; }
  virtual const std::vector<StepTaken>& steps() const = 0;
  /// The leg that is in the air.
  virtual std::optional<BodySide> swinging() const = 0;
  /// It stands at ease.
  virtual bool calm() const = 0;
  virtual std::optional<GoesOn> goes_on() const { return std::nullopt; }
  virtual const Physique& physique() const = 0;

 protected:
  Goals asked_;  // since the last accepted step

  void lose(double time_s, const char* why) {
    lost_s_ = time_s;
    lost_why_ = why;
  }

 private:
  std::optional<double> lost_s_;
  std::string lost_why_;
};

}  // namespace ukemi
