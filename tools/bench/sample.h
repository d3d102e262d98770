// One run of one hit, and its form in JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace ukemi {

/// The ways in which every hit is run. `reference`: fixed steps of 1/480 s, what all others are told as a
/// ratio of.
inline constexpr const char* kReference = "fixed:480";
inline constexpr const char* kBulletRun = "Bullet 1000";

struct Sample {
  int hit = 0;
  std::string run;  // what was asked for: "strong"
  std::string row;  // what became of it: "fall"
  bool failed = false;
  double cpu_s = 0.0, engine_s = 0.0;
  long calls = 0, rows = 0, contacts = 0;  // of the engine's steps, see EngineCost
  long steps = 0, rejected = 0;
  long samples = 0, over_1deg = 0;  // joints x steps, and those outside the range by more
  long over_own_1deg = 0;           // outside the engine's own limit by more, where that is another one
  double excess_max_deg = 0.0, separation_max_m = 0.0, energy_gain_max_j = 0.0;
  bool rested = false;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Sample, hit, run, row, failed, cpu_s, engine_s, calls, rows,
                                                contacts, steps, rejected, samples, over_1deg, over_own_1deg,
                                                excess_max_deg, separation_max_m, energy_gain_max_j, rested)

}  // namespace ukemi
