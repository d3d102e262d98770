// Random reactions, and which of them break a promise: nobody leaves his range of motion by more than a
// degree, every number is finite, no joint gives more than it can, energy has a cause, the same bake gives
// the same motion.
//
//   ukemi_stress [COUNT [CHARACTER,... [SEED [THREADS]]]]
//
// Blows are up to 200 N s to a man, or twice a preset; one that is given at once makes no segment faster than
// 15 m/s. Characters may be files. Each reaction is drawn from the seed and its number alone. What breaks a
// promise is printed with the command that bakes it again. Exit status: 0 nothing did, 1 something did, 2
// wrong command line.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bake/bake.h"
#include "bake/response.h"
#include "base/numbers.h"
#include "base/random.h"
#include "blows.h"
#include "prepare/impact.h"
#include "stopwatch.h"

namespace ukemi {
namespace {

constexpr double kMostGain_j = 6.0;
constexpr double kMostSpeed_m_s = 15.0;  // that a blow without a ball gives the segment it hits
constexpr double kMostTimes = 2.0;       // the momentum of the real thing
constexpr double kRounding = 1e-6;       // of a share
constexpr int kAgain = 20;               // one in so many is baked twice

struct Hero {
  std::string name;
  Character character;
  ArticulatedBody body;
};

/// A reaction as its settings say it: words, so that a command line can say the same.
struct StressCase {
  const Hero* hero = nullptr;
  std::vector<std::pair<std::string, std::string>> words;

  std::string command() const {
    std::string text = "ukemi bake '" + hero->name + "'";
    for (const auto& [name, value] : words) text += fmt::format(" --{} '{}'", name, value);
    return text + " -o broken.glb";
  }
};

struct StressRow {
  std::vector<std::string> broken;  // promises
  bool refused = false, again = false;
  std::string outcome;
  double excess_deg = 0.0, gain_j = 0.0, share = 0.0, separation_m = 0.0, cpu_s = 0.0, clip_s = 0.0;
  long rejected = 0;
};

std::size_t below(Random& random, std::size_t count) { return random.next() % count; }

/// From `least` to `most`, every doubling as likely as any other.
double spread(Random& random, double least, double most) {
  return least * std::pow(most / least, random.uniform(0.0, 1.0));
}

using Words = std::vector<std::pair<std::string, std::string>>;

void draw_blow(Random& random, const Hero& hero, const std::vector<ImpactPreset>& presets, Words& words) {
  const Segment hit = segment_at(static_cast<int>(below(random, kSegmentCount)));
  words.emplace_back("hit", name(hit));
  words.emplace_back(
      "from", fmt::format("{:.1f},{:.1f}", random.uniform(-180.0, 180.0), random.uniform(-20.0, 50.0)));
  const double most_n_s = kMostSpeed_m_s * hero.body.segments[index(hit)].mass_kg;
  if (below(random, 2) == 0) {
    const ImpactPreset& preset = presets[below(random, presets.size())];
    double strength = spread(random, 0.2, kMostTimes);
    if (preset.scene == SceneKind::impulse)
      strength = std::min(strength, most_n_s / (preset.mass_kg * preset.speed_m_s));
    words.emplace_back("preset", preset.name);
    words.emplace_back("strength", fmt::format("{:.3f}", std::max(strength, 0.01)));
    return;
  }
  const double n_s = std::min(momentum_for(hero.body, spread(random, 2.0, 200.0)), most_n_s);
  words.emplace_back("scene", "impulse");
  words.emplace_back("ball-mass", "1");
  words.emplace_back("ball-speed", fmt::format("{:.3f}", std::max(n_s, 0.01)));
}

void draw_start(Random& random, const Hero& hero, Words& words) {
  const auto& clips = hero.character.animations;
  if (!clips.empty() && below(random, 3) == 0) {
    const std::size_t clip = below(random, clips.size());
    words.emplace_back("clip", fmt::format("#{}", clip));
    words.emplace_back("at", fmt::format("{:.3f}", random.uniform(0.0, clips[clip].duration_s())));
  } else if (below(random, 3) == 0) {
    words.emplace_back("pose", below(random, 2) == 0 ? "guard" : "rest");
  }
}

void draw_behaviour(Random& random, Words& words) {
  const char* kinds[] = {"alert", "alert", "alert", "dazed", "limp"};
  const std::string kind = kinds[below(random, std::size(kinds))];
  words.emplace_back("behaviour", kind);
  words.emplace_back("seed", fmt::format("{}", below(random, 1u << 31)));
  if (kind == "limp") return;
  const char* knockouts[] = {"blow", "step", "landing", "0.4"};
  if (below(random, 6) == 0)
    words.emplace_back("knockout-at", knockouts[below(random, std::size(knockouts))]);
  if (below(random, 10) == 0) words.emplace_back("get-up", "0.5");
}

StressCase drawn(std::uint64_t seed, std::uint64_t number, const std::vector<Hero>& heroes,
                 const std::vector<ImpactPreset>& presets) {
  Random random(Random(seed ^ (number << 20)).next());
  StressCase stress{&heroes[below(random, heroes.size())], {}};
  draw_blow(random, *stress.hero, presets, stress.words);
  draw_start(random, *stress.hero, stress.words);
  draw_behaviour(random, stress.words);
  return stress;
}

bool all_finite(const BakedClip& baked) {
  for (const BodyPose& frame : baked.timeline.trajectory.frames)
    for (const Rigid& segment : frame)
      if (!segment.translation.allFinite() || !segment.rotation.coeffs().allFinite()) return false;
  for (const Pose& frame : baked.timeline.clip.frames)
    for (const LocalTransform& joint : frame)
      if (!joint.translation.allFinite() || !joint.rotation.coeffs().allFinite()) return false;
  const SimulationFigures& f = baked.figures;
  for (const double figure : {baked.limits.excess_max_deg, f.energy_gain_max_j, f.joint_separation_max_m,
                              f.floor_penetration_max_m, f.self_penetration_max_m, f.muscle_work_j,
                              f.muscle_share_max, baked.skin.max.body_m, response_of(baked).foot_slide_max_m})
    if (!std::isfinite(figure)) return false;
  return true;
}

void judge_row(const BakedClip& baked, StressRow& row) {
  row.outcome = name(response_of(baked).outcome);
  row.excess_deg = baked.limits.excess_max_deg;
  row.gain_j = baked.figures.energy_gain_max_j;
  row.share = baked.figures.muscle_share_max;
  row.separation_m = baked.figures.joint_separation_max_m;
  row.rejected = baked.figures.rejected_steps;
  row.clip_s = baked.timeline.clip.duration_s();
  if (!all_finite(baked)) row.broken.emplace_back("not finite");
  if (baked.limits.over_1deg > 0)
    row.broken.push_back(
        fmt::format("over 1 degree: {} samples, {:.2f}", baked.limits.over_1deg, row.excess_deg));
  if (row.gain_j > kMostGain_j) row.broken.push_back(fmt::format("energy: {:.2f} J", row.gain_j));
  if (row.share > 1.0 + kRounding) row.broken.push_back(fmt::format("muscle torque: {:.4f}", row.share));
}

StressRow run(const StressCase& stress, bool twice) {
  StressRow row;
  BakeSettings settings;
  for (const auto& [name, value] : stress.words)
    if (const Status status = set(settings, name, value); !status) {
      row.broken.push_back(status.error().message());
      return row;
    }
  Diagnostics diagnostics;
  const double before = thread_seconds();
  const auto baked = bake(stress.hero->character, settings, diagnostics);
  row.cpu_s = thread_seconds() - before;
  for (const Warning& warning : diagnostics.warnings())
    row.again = row.again || warning.what.find("run again") != std::string::npos;
  if (!baked) {
    row.refused = baked.error().kind == ErrorKind::usage || baked.error().kind == ErrorKind::input;
    if (!row.refused) row.broken.push_back("fails: " + baked.error().message());
    return row;
  }
  judge_row(*baked, row);
  if (!twice) return row;
  const auto again = bake(stress.hero->character, settings, diagnostics);
  if (!again || again->figures.hash != baked->figures.hash)
    row.broken.emplace_back("another motion the second time");
  return row;
}

Result<std::vector<Hero>> load_heroes(const std::vector<std::string>& names) {
  std::vector<Hero> heroes;
  for (const std::string& name : names) {
    Diagnostics diagnostics;
    auto character = load_named(name, diagnostics);
    if (!character) return character.error();
    const auto prepared = prepare_bake(*character, BakeSettings{}, diagnostics);
    if (!prepared) return prepared.error();
    heroes.push_back({name, std::move(*character), prepared->body});
  }
  return heroes;
}

/// The kinds of broken promises and how often, then the figures of all.
int print_sum(const std::vector<StressRow>& rows) {
  std::map<std::string, int> broken, outcomes;
  StressRow most;
  int refused = 0, again = 0, bad = 0;
  for (const StressRow& row : rows) {
    refused += row.refused ? 1 : 0;
    again += row.again ? 1 : 0;
    bad += row.broken.empty() ? 0 : 1;
    for (const std::string& what : row.broken) ++broken[what.substr(0, what.find(':'))];
    if (!row.outcome.empty()) ++outcomes[row.outcome];
    most.excess_deg = std::max(most.excess_deg, row.excess_deg);
    most.gain_j = std::max(most.gain_j, row.gain_j);
    most.share = std::max(most.share, row.share);
    most.separation_m = std::max(most.separation_m, row.separation_m);
    most.rejected += row.rejected;
    most.cpu_s += row.cpu_s;
    most.clip_s += row.clip_s;
  }
  fmt::print("{} reactions:", rows.size());
  for (const auto& [outcome, count] : outcomes) fmt::print(" {} {},", outcome, count);
  fmt::print(" refused {}, run again {}\n", refused, again);
  fmt::print(
      "largest: excess {:.3f} deg, energy gain {:.2f} J, muscle share {:.4f}, joint separation {:.1f} mm\n",
      most.excess_deg, most.gain_j, most.share, 1e3 * most.separation_m);
  const double count = static_cast<double>(rows.size());
  fmt::print("a reaction: {:.0f} ms of CPU, {:.2f} s of clip, {:.1f} steps taken back\n",
             1e3 * most.cpu_s / count, most.clip_s / count, static_cast<double>(most.rejected) / count);
  for (const auto& [what, times] : broken) fmt::print("broken: {} {}\n", what, times);
  if (bad == 0) fmt::print("no promise is broken\n");
  return bad == 0 ? 0 : 1;
}

Result<int> stress(std::size_t count, const std::vector<std::string>& names, std::uint64_t seed,
                   int threads) {
  const auto heroes = load_heroes(names);
  if (!heroes) return heroes.error();
  const auto presets = load_presets();
  if (!presets) return presets.error();
  std::vector<StressRow> rows(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      const StressCase stress = drawn(seed, i, *heroes, *presets);
      rows[i] = run(stress, i % kAgain == 0);
      std::string said;
      for (const std::string& what : rows[i].broken)
        said += fmt::format("{}: {}\n  {}\n", i, what, stress.command());
      if (!said.empty()) fmt::print("{}", said), std::fflush(stdout);
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  return print_sum(rows);
}

}  // namespace
}  // namespace ukemi

int main(int argc, char** argv) {
  using namespace ukemi;
  const auto number = [&](int i, const char* otherwise, double most) {
    return parse_number(argc > i ? argv[i] : otherwise, Range{1.0, most});
  };
  const auto count = number(1, "200", 1e7), seed = number(3, "1", 1e15), threads = number(4, "1", 256.0);
  for (const auto* argument : {&count, &seed, &threads})
    if (!*argument) return fmt::print(stderr, "ukemi_stress: {}\n", argument->error().message()), 2;
  const auto status = stress(static_cast<std::size_t>(*count), split(argc > 2 ? argv[2] : "mannequin"),
                             static_cast<std::uint64_t>(*seed), static_cast<int>(*threads));
  if (status) return *status;
  fmt::print(stderr, "ukemi_stress: {}\n", status.error().message());
  return exit_status(status.error().kind);
}
