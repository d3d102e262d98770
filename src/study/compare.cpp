#include "study/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "base/parallel.h"
#include "base/quantile.h"
#include "base/random.h"

namespace ukemi {
namespace {

constexpr const char* kJudgedRegion = "human";
constexpr double kReferenceHz = 480.0;
constexpr double kActiveK = 20.0;      // 1/s
constexpr double kPaperActiveK = 1.0;  // 1/s
constexpr double kExplodedGain_j = 1000.0;
constexpr double kExplodedSeparation_m = 0.2;
constexpr double kMaxElevation = radians(15.0);

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One hit with one method, and what it took.
struct Run {
  LimitFigures limits;
  SimulationFigures figures;
  std::vector<double> excesses;  // rad
  bool exploded = false;
  double simulated_s = 0.0;
  double cpu_s = 0.0;
};

Result<Run> timed_run(const Comparison& comparison, const Method& method, const RandomHit& hit) {
  const Quat& pelvis = comparison.prepared.start.segments[index(Segment::pelvis)].rotation;
  Run run;
  const double before = thread_seconds();
  auto trial = run_scene(comparison, method, scene_of(hit, pelvis));
  run.cpu_s = thread_seconds() - before;
  if (!trial) return trial.error();
  run.limits = trial->result.limits;
  run.figures = trial->result.figures;
  run.excesses = std::move(trial->excesses);
  run.exploded = exploded(*trial);
  run.simulated_s = trial->simulated_s;
  return run;
}

/// All hits with one method, in the order of the hits.
Result<std::vector<Run>> run_hits(const Comparison& comparison, const Method& method,
                                  const std::function<void()>& after_each) {
  std::vector<Run> runs(comparison.hits.size());
  const auto work = [&](std::size_t i) -> Status {
    auto run = timed_run(comparison, method, comparison.hits[i]);
    if (!run) return run.error();
    runs[i] = std::move(*run);
    return Done{};
  };
  const Status status =
      for_each_parallel(runs.size(), comparison.settings.threads, work, [&](int) { after_each(); });
  if (!status) return status.error();
  return runs;
}

MethodFigures figures_of(const Method& method, const std::vector<Run>& runs) {
  MethodFigures sum;
  sum.method = method;
  std::vector<double> excesses;
  double steps = 0.0, simulated_s = 0.0, cpu_s = 0.0;
  int whole = 0;
  for (const Run& run : runs) {
    sum.samples += run.limits.samples;
    sum.over_1deg += run.limits.over_1deg;
    sum.excess_max_by_hit_deg.push_back(run.limits.excess_max_deg);
    sum.exploded_hits.push_back(run.exploded);
    sum.angular_momentum_by_hit_kg_m2_s.push_back(run.figures.angular_momentum_mean_kg_m2_s);
    sum.airborne_by_hit_s.push_back(run.figures.airborne_mean_s);
    sum.turning_by_hit_rad_s.push_back(run.figures.turning_mean_rad_s);
    excesses.insert(excesses.end(), run.excesses.begin(), run.excesses.end());
    if (run.limits.excess_max_deg > sum.excess_max_deg) {
      sum.excess_max_deg = run.limits.excess_max_deg;
      sum.worst_joint = run.limits.worst_joint;
    }
    sum.joint_separation_max_m = std::max(sum.joint_separation_max_m, run.figures.joint_separation_max_m);
    sum.energy_gain_max_j = std::max(sum.energy_gain_max_j, run.figures.energy_gain_max_j);
    steps += static_cast<double>(run.figures.steps);
    simulated_s += run.simulated_s;
    cpu_s += run.cpu_s;
    if (run.exploded) {
      ++sum.exploded;
      continue;
    }
    ++whole;
    sum.angular_momentum_mean_kg_m2_s += run.figures.angular_momentum_mean_kg_m2_s;
    sum.airborne_mean_s += run.figures.airborne_mean_s;
    sum.turning_mean_rad_s += run.figures.turning_mean_rad_s;
  }
  sum.excess_p999_deg = degrees(exceeded_by(std::move(excesses), sum.samples, 0.001));
  sum.angular_momentum_mean_kg_m2_s /= std::max(whole, 1);
  sum.airborne_mean_s /= std::max(whole, 1);
  sum.turning_mean_rad_s /= std::max(whole, 1);
  if (steps > 0.0) sum.us_per_step = 1e6 * cpu_s / steps;
  if (simulated_s > 0.0) sum.cpu_s_per_s = cpu_s / simulated_s;
  return sum;
}

SimulationSettings of_the_paper(Limits limits, Active active, double k, double duration_s) {
  SimulationSettings settings;
  settings.limits = limits;
  settings.active = active;
  settings.active_k = k;
  settings.tone = 0.0;
  settings.damping = 0.0;
  settings.fixed_hz = kReferenceHz;
  settings.stop_at_rest = false;
  settings.duration_s = duration_s;
  return settings;
}

}  // namespace

std::vector<RandomHit> random_hits(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<RandomHit> hits;
  for (int i = 0; i < count; ++i) {
    RandomHit hit;
    hit.segment = segment_at(static_cast<int>(random.uniform(0.0, kSegmentCount)));
    hit.from.azimuth = random.uniform(0.0, 2.0 * kPi);
    hit.from.elevation = random.uniform(-kMaxElevation, kMaxElevation);
    hit.mass_kg = random.uniform(5.0, 10.0);
    hit.speed_m_s = random.uniform(5.0, 15.0);
    hits.push_back(hit);
  }
  return hits;
}

Scene scene_of(const RandomHit& hit, const Quat& world_from_pelvis) {
  Scene scene;
  scene.kind = SceneKind::ball;
  scene.target = hit.segment;
  scene.direction = travel_direction(hit.from, world_from_pelvis);
  scene.ball_mass_kg = hit.mass_kg;
  scene.ball_speed_m_s = hit.speed_m_s;
  scene.ball_radius_m = kHitBallRadius_m;
  return scene;
}

std::string describe(const RandomHit& hit) {
  return fmt::format("{} from {:.0f} degrees: {:.1f} kg at {:.1f} m/s", name(hit.segment),
                     degrees(hit.from.azimuth), hit.mass_kg, hit.speed_m_s);
}

std::vector<Method> methods_to_compare(double duration_s) {
  const auto paper = [&](Limits limits, Active active = Active::off, double k = kActiveK) {
    return of_the_paper(limits, active, k, duration_s);
  };
  SimulationSettings ours;
  ours.duration_s = duration_s;
  SimulationSettings limp = ours;
  limp.tone = 0.0;
  limp.damping = 0.0;
  return {{"a", paper(Limits::axis)},
          {"b", paper(Limits::segments)},
          {"b-euler", paper(Limits::segments_euler)},
          {"c", paper(Limits::segments, Active::explicit_torque)},
          {"c-k1", paper(Limits::segments, Active::explicit_torque, kPaperActiveK)},
          {"ours", ours},
          {"ours-limp", limp},
          {"living", ours, Behaviour::alert}};
}

bool exploded(const Trial& trial) {
  return trial.failure || !(trial.result.figures.energy_gain_max_j <= kExplodedGain_j) ||
         !(trial.result.figures.joint_separation_max_m <= kExplodedSeparation_m);
}

Result<Trial> run_scene(const Comparison& comparison, const Method& method, const Scene& scene) {
  const Prepared& prepared = comparison.prepared;
  const bool own = comparison.settings.region == kJudgedRegion;
  Diagnostics unsaid;
  BehaviourSettings behaviour = prepared.behaviour;
  behaviour.kind = method.behaviour;
  return simulate_trial(simulation_input(prepared, scene, method.simulation, behaviour),
                        own ? prepared.range : comparison.judged, unsaid);
}

Result<Comparison> compare(const std::string& character, const Character& loaded,
                           const CompareSettings& settings, Diagnostics& diagnostics,
                           const Progress& progress) {
  BakeSettings bake;
  bake.humanoid = settings.humanoid;
  bake.pose = "stand";
  bake.behaviour = Behaviour::limp;
  bake.region = kJudgedRegion;
  auto human = prepare_bake(loaded, bake, diagnostics);
  if (!human) return human.error();
  bake.region = settings.region;
  Diagnostics said;
  auto prepared = prepare_bake(loaded, bake, said);
  if (!prepared) return prepared.error();
  Comparison comparison{character,
                        settings,
                        std::move(*prepared),
                        std::move(human->range),
                        std::move(human->widened),
                        random_hits(settings.seed, settings.hits),
                        {}};

  const std::vector<Method> methods = methods_to_compare(settings.duration_s);
  const int total = settings.hits * static_cast<int>(methods.size());
  int done = 0;
  for (const Method& method : methods) {
    const auto runs = run_hits(comparison, method, [&] {
      ++done;
      if (progress) progress(done, total);
    });
    if (!runs) return runs.error();
    comparison.methods.push_back(figures_of(method, *runs));
  }
  return comparison;
}

PairedChange paired_change(const MethodFigures& method, const MethodFigures& other,
                           std::vector<double> MethodFigures::*by_hit) {
  constexpr double kStandardErrors = 1.96;
  PairedChange change;
  double count = 0.0, sum = 0.0, squares = 0.0, others = 0.0;
  for (std::size_t i = 0; i < (method.*by_hit).size(); ++i) {
    if (method.exploded_hits[i] || other.exploded_hits[i]) continue;
    const double difference = (method.*by_hit)[i] - (other.*by_hit)[i];
    if (difference < 0.0) ++change.less;
    if (difference > 0.0) ++change.more;
    count += 1.0;
    sum += difference;
    squares += difference * difference;
    others += (other.*by_hit)[i];
  }
  if (count < 2.0 || !(others > 0.0)) return change;
  const double variance = std::max(squares - sum * sum / count, 0.0) / (count - 1.0);
  const double half = kStandardErrors * std::sqrt(variance * count) / others;
  change.fraction = sum / others;
  change.low = change.fraction - half;
  change.high = change.fraction + half;
  return change;
}

}  // namespace ukemi
