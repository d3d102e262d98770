// What is measured at every accepted step, and what the report says of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/fnv.h"
#include "physics/collision.h"
#include "physics/model.h"
#include "physics/senses.h"
#include "simulate/simulate.h"

namespace ukemi {

Vec3 angular_momentum_about_centre(const std::vector<ModelBody>& bodies);

class Recorder {
 public:
  Recorder(const Model& model, double gravity);

  void excess_of_step(const std::vector<double>& excess_by_joint, double projected_max);
  /// After an accepted step of length h that ended at `time_s`. `extra_energy`: of the props, J; `work`: done
  /// on the body by the scene and its muscles in this step, J.
  void step(double time_s, double h, const Contacts& contacts, double extra_energy, double work,
            double separation);
  void rejected() { ++figures_.rejected_steps; }
  void rest(double time_s) { figures_.rest_time_s = time_s; }
  void momentum(double momentum_n_s) { figures_.momentum_n_s = momentum_n_s; }
  /// `share` of a joint's strength in the step, work of all muscles so far.
  void muscles(double share, double work_j) {
    figures_.muscle_share_max = std::max(figures_.muscle_share_max, share);
    figures_.muscle_work_j = work_j;
  }

  void help(double n_s) { figures_.help_n_s = n_s; }

  /// Senses at the start and after an accepted step.
  void touches(const Senses& senses);
  /// What the blow has given so far, N s.
  void delivered(double time_s, double n_s);

  double energy_gain_j() const { return figures_.energy_gain_max_j; }
  LimitFigures limits(bool projected) const;
  SimulationFigures figures() const;
  /// Of the samples outside, rad, in the order of time.
  const std::vector<double>& excesses() const { return outside_; }

 private:
  struct Turning {
    double time_s, h, mean_square;
  };
  void hash_state();
  /// Of the segments' angular velocities between two times, rad/s.
  double root_mean_square_turning(double from_s, double to_s) const;

  const Model& model_;
  double gravity_;
  SimulationFigures figures_;
  std::vector<double> outside_;  // excess of samples above 0, rad
  long samples_ = 0, over_1deg_ = 0;
  double excess_max_ = 0.0, projected_max_ = 0.0;
  std::optional<Joint> worst_;
  double lowest_energy_, work_ = 0.0;
  double momentum_time_ = 0.0, momentum_integral_ = 0.0, airborne_ = 0.0;
  std::vector<Turning> turning_;
  PerSegment<bool> stood_{};  // on the floor at the start
  std::optional<Senses> before_;
  Fnv hash_;
};

}  // namespace ukemi
