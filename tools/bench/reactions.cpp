// Outcomes of many blows on a character: who stands, steps, falls; how calm, how planted.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "bake/bake.h"
#include "blows.h"
#include "body/centre_of_mass.h"
#include "stopwatch.h"

namespace ukemi {
namespace {

struct ReactionRow {
  char digit = '?';
  bool fell = false;
  long steps = 0, over = 0, rejected = 0;
  double excess = 0.0, gain = 0.0, share = 0.0, rest_s = 0.0, still_s = 0.0, separation = 0.0;
  double cpu_s = 0.0;
};

/// When the centre of mass comes under 0.05 m/s and stays there, s.
double still_since(const ArticulatedBody& body, const Trajectory& trajectory) {
  constexpr double kStill_m_s = 0.05;
  for (std::size_t i = trajectory.frames.size(); i-- > 1;) {
    const Vec3 moved =
        centre_of_mass(body, trajectory.frames[i]) - centre_of_mass(body, trajectory.frames[i - 1]);
    if (moved.norm() * trajectory.fps > kStill_m_s) return static_cast<double>(i) / trajectory.fps;
  }
  return 0.0;
}

ReactionRow run(const Character& character, BakeSettings settings, const std::string& segment, double azimuth,
                double n_s) {
  ReactionRow row;
  settings.hit = *segment_named(segment);
  settings.from = *parse_direction(fmt::format("{:g}", azimuth));
  Diagnostics diagnostics;
  auto prepared = prepare_bake(character, settings, diagnostics);
  if (!prepared) {
    fmt::print("{}\n", prepared.error().message());
    return row;
  }
  Scene scene = prepared->scene;
  scene.kind = SceneKind::impulse;
  scene.impulse_n_s = momentum_for(prepared->body, n_s);
  const double before = thread_seconds();
  auto result = simulate(simulation_input(*prepared, scene, settings.simulation), diagnostics);
  for (const Choice& choice : choices_for(settings)) {
    if (!settings.outcome) break;
    BehaviourSettings behaviour = prepared->behaviour;
    behaviour.choice = choice;
    result = simulate(simulation_input(*prepared, scene, settings.simulation, behaviour), diagnostics);
    if (!result || result->behaviour.fall_begins_s.has_value() == (settings.outcome == Wanted::fall)) {
      if (std::getenv("TRACE") != nullptr)
        fmt::print("choice: first {} swing {:.2f} width {:.2f} tension {:.2f} ride {:.2f}\n",
                   choice.first_foot ? static_cast<int>(*choice.first_foot) : -1, choice.swing, choice.width,
                   choice.tension, choice.ride);
      break;
    }
  }
  row.cpu_s = thread_seconds() - before;
  if (!result) {
    fmt::print("{}\n", result.error().message());
    return row;
  }
  row.fell = result->behaviour.fall_begins_s.has_value();
  row.steps = static_cast<long>(result->behaviour.steps.size());
  if (std::getenv("TRACE") != nullptr) {
    fmt::print("{} {} {}:", segment, azimuth, n_s);
    for (const StepTaken& step : result->behaviour.steps)
      fmt::print(" {}[{:.2f} {:.2f} {:.2f}m]", name(step.foot), step.lift_s, step.contact_s.value_or(-1.0),
                 step.length_m);
    if (result->behaviour.fall_begins_s)
      fmt::print(" lost {:.2f} {}", *result->behaviour.fall_begins_s,
                 result->behaviour.events.empty() ? "" : result->behaviour.events.front().name);
    fmt::print(" rest {:.2f} still {:.2f}\n", result->figures.rest_time_s.value_or(-1.0),
               still_since(prepared->body, result->trajectory));
  }
  row.digit = row.fell ? 'F' : static_cast<char>('0' + std::min(9L, row.steps));
  row.over = result->limits.over_1deg;
  row.excess = result->limits.excess_max_deg;
  row.gain = result->figures.energy_gain_max_j;
  row.share = result->figures.muscle_share_max;
  row.separation = result->figures.joint_separation_max_m;
  row.rejected = result->figures.rejected_steps;
  row.still_s = still_since(prepared->body, result->trajectory);
  row.rest_s = result->figures.rest_time_s.value_or(duration_of(settings.simulation));
  return row;
}

}  // namespace
}  // namespace ukemi

int main(int argc, char** argv) {
  using namespace ukemi;
  const std::string name = argc > 1 ? argv[1] : "mannequin";
  const auto segments = split(argc > 2 ? argv[2] : "chest,pelvis,head");
  const auto momenta = split(argc > 3 ? argv[3] : "5,10,20,30,40,50,60,80");
  const auto directions = split(argc > 4 ? argv[4] : "0,45,90,135,180,225,270,315");
  BakeSettings settings;
  settings.simulation.duration_s = 4.0;
  settings.behaviour = Behaviour::alert;
  if (const Status status = set_all(settings, argc, argv, 5); !status)
    return fmt::print("{}\n", status.error().message()), 2;
  Diagnostics diagnostics;
  const auto character = load_named(name, diagnostics);
  if (!character) return fmt::print("{}\n", character.error().message()), 2;
  struct Job {
    std::string segment;
    double azimuth, n_s;
    ReactionRow row;
  };
  std::vector<Job> jobs;
  for (const auto& s : segments)
    for (const auto& d : directions)
      for (const auto& m : momenta) jobs.push_back({s, std::atof(d.c_str()), std::atof(m.c_str()), {}});
  const auto work = [&](std::size_t first) {
    for (std::size_t i = first; i < jobs.size(); i += 2)
      jobs[i].row = run(*character, settings, jobs[i].segment, jobs[i].azimuth, jobs[i].n_s);
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  std::size_t i = 0;
  long over = 0;
  double excess = 0.0, gain = 0.0, share = 0.0, cpu_s = 0.0, separation = 0.0;
  std::vector<int> up(momenta.size()), none(momenta.size()), late(momenta.size()), moving(momenta.size());
  std::vector<double> steps(momenta.size());
  for (const auto& s : segments) {
    fmt::print("{:<10}", s);
    for (const auto& d : directions) {
      std::string digits;
      for (std::size_t m = 0; m < momenta.size(); ++m) {
        const ReactionRow& row = jobs[i++].row;
        digits += row.digit;
        up[m] += row.fell ? 0 : 1;
        none[m] += !row.fell && row.steps == 0 ? 1 : 0;
        late[m] += !row.fell && row.rest_s > 2.5 ? 1 : 0;
        moving[m] += !row.fell && row.still_s > 2.5 ? 1 : 0;
        steps[m] += row.fell ? 0.0 : static_cast<double>(row.steps);
        over += row.over;
        excess = std::max(excess, row.excess);
        gain = std::max(gain, row.gain);
        share = std::max(share, row.share);
        separation = std::max(separation, row.separation);
        cpu_s += row.cpu_s;
      }
      fmt::print(" {}:{}", d, digits);
    }
    fmt::print("\n");
  }
  const double n = static_cast<double>(segments.size() * directions.size());
  for (std::size_t m = 0; m < momenta.size(); ++m)
    fmt::print(
        "{:>4} N s: up {:3.0f} %, no step {:3.0f} %, steps {:.2f}, by 2.5 s {} not at rest, {} centres of "
        "mass "
        "not under 0.05 m/s\n",
        momenta[m], 100 * up[m] / n, 100 * none[m] / n, steps[m] / std::max(up[m], 1), late[m], moving[m]);
  fmt::print(
      "over 1 deg {}, worst {:.2f}, gain {:.2f} J, share {:.2f}, separation {:.1f} mm, {:.0f} ms a run\n",
      over, excess, gain, share, 1000 * separation, 1000 * cpu_s / static_cast<double>(jobs.size()));
}
