// The experiment of Era et al., section 5: the same random hits with every method of joint restriction.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "prepare/impact.h"
#include "prepare/prepared.h"
#include "simulate/simulate.h"

namespace ukemi {

struct CompareSettings {
  int hits = 100;
  std::uint64_t seed = 1;
  std::string region = "human";  // that every method restricts to; all are judged against "human"
  HumanoidOptions humanoid;
  double duration_s = 3.0;  // of each hit
  int threads = 2;
};

/// A ball of 5 to 10 kg and 0.15 m radius at 5 to 15 m/s, towards any segment, from any side, at most 15
/// degrees from above or below.
struct RandomHit {
  Segment segment = Segment::chest;
  Direction from;
  double mass_kg = 0.0;
  double speed_m_s = 0.0;
};
inline constexpr double kHitBallRadius_m = 0.15;

/// The first hits of a seed: more hits of the same seed begin with the same ones, on every platform.
std::vector<RandomHit> random_hits(std::uint64_t seed, int count);
Scene scene_of(const RandomHit& hit, const Quat& world_from_pelvis);
/// "forearm_l from 211 degrees: 7.1 kg at 9.9 m/s"
std::string describe(const RandomHit& hit);

/// a: stops for each axis on its own, of the polygon's bounding box (the baseline of the paper). b: the
/// chords of Figure 4 with exact rows; b-euler: the same as stops of Euler angles. c: b and explicit
/// active restriction with k = 20 1/s; c-k1: with the paper's k = 1 1/s. These run on a limp body in fixed
/// steps of 1/480 s without rest stop. ours: a bake's defaults on a limp body; ours-limp: without muscle tone
/// and damping; living: a bake's defaults on a body that lives.
struct Method {
  std::string name;
  SimulationSettings simulation;
  Behaviour behaviour = Behaviour::limp;
};
std::vector<Method> methods_to_compare(double duration_s);

/// Over all hits of a method.
struct MethodFigures {
  Method method;
  long samples = 0;  // joints x accepted steps
  long over_1deg = 0;
  double excess_p999_deg = 0.0;
  double excess_max_deg = 0.0;
  std::optional<Joint> worst_joint;
  double joint_separation_max_m = 0.0;
  double energy_gain_max_j = 0.0;
  int exploded = 0;  // hits, see exploded()
  // Means over the hits that did not explode.
  double angular_momentum_mean_kg_m2_s = 0.0;  // about the body's centre of mass, in the second after the hit
  double airborne_mean_s = 0.0;                // without ground contact
  double turning_mean_rad_s = 0.0;             // RMS of the segments' angular velocities in that second
  double us_per_step = 0.0;                    // thread's CPU time
  double cpu_s_per_s = 0.0;                    // and per simulated second
  std::vector<double> excess_max_by_hit_deg;
  std::vector<double> angular_momentum_by_hit_kg_m2_s, airborne_by_hit_s, turning_by_hit_rad_s;
  std::vector<bool> exploded_hits;
};

/// A figure of one method against that of another over the same hits, those left out that exploded in either.
struct PairedChange {
  double fraction = 0.0;         // mean difference over the other's mean: -0.2 is a fifth less
  double low = 0.0, high = 0.0;  // 95 % interval of it: 1.96 standard errors of the mean difference
  int less = 0, more = 0;        // hits
};
PairedChange paired_change(const MethodFigures& method, const MethodFigures& other,
                           std::vector<double> MethodFigures::*by_hit);

/// Whether a run stopped being plausible: it diverged, gained more than 1000 J (a standing body has about
/// 720 J to lose), or a joint came apart by more than 0.2 m.
bool exploded(const Trial& trial);

struct Comparison {
  std::string character;  // as given
  CompareSettings settings;
  Prepared prepared;                              // the body, and the range in force
  RangeOfMotion judged;                           // "human", widened for the start pose as a bake does
  std::vector<std::pair<Joint, double>> widened;  // of `judged`, radians
  std::vector<RandomHit> hits;
  std::vector<MethodFigures> methods;
};

/// Called after each run, from any thread, one at a time.
using Progress = std::function<void(int done, int total)>;

/// Runs every hit with every method. `character` names what was loaded. A method's failure is a result.
/// Errors: those of a bake's stages before the simulation.
Result<Comparison> compare(const std::string& character, const Character& loaded,
                           const CompareSettings& settings, Diagnostics& diagnostics,
                           const Progress& progress);

/// One scene with one method, on the comparison's body.
Result<Trial> run_scene(const Comparison& comparison, const Method& method, const Scene& scene);

/// `compare --json`, format 1. Figures are the same for the same seed, but for the CPU times.
std::string comparison_json(const Comparison& comparison);
/// A table for a terminal.
std::string comparison_text(const Comparison& comparison);

}  // namespace ukemi
