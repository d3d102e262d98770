// Runs of the same random hits in every way that the bench compares.
#pragma once

#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "prepare/impact.h"
#include "prepare/prepared.h"
#include "sample.h"
#include "study/compare.h"

namespace ukemi {

class Measure {
 public:
  /// `character` must outlive it. Errors: those of a bake's stages before the simulation.
  static Result<Measure> make(const Character& character, int hits, double duration_s);

  /// Of every hit, in this order: the reference, limp bodies, living ones hit ever harder, a fall with the
  /// way up, and Bullet where there is one.
  static std::vector<std::string> runs();

  /// Samples without a fall to get up from are failed. Contract: `run` is one of runs(), `hit` below hits().
  Sample sample(int hit, const std::string& run) const;
  int hits() const { return static_cast<int>(hits_.size()); }

 private:
  Scene scene(int hit, double times) const;
  Sample simulated(int hit, const std::string& run, double times, const SimulationSettings& settings,
                   Behaviour kind) const;

  Prepared prepared_;
  PerSegment<std::vector<Vec3>> skin_;  // outermost
  std::vector<RandomHit> hits_;
  double duration_s_ = 3.0;
};

}  // namespace ukemi
