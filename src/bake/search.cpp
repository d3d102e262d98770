#include "bake/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bake/response.h"
#include "bake/stopwatch.h"
#include "bake/take.h"
#include "base/parallel.h"
#include "base/random.h"

namespace ukemi {
namespace {

constexpr int kTrials = 5;
constexpr double kGoodFall = 0.9;  // score above which the search for a better fall ends

/// For a body that is to stay up, the first foot and the step time matter most.
std::vector<Choice> ways_to_stand(bool planted) {
  std::vector<Choice> ways(5);
  if (planted) {
    for (int i = 1; i < 5; ++i) ways[i].tension = 1.0 + 0.1 * i, ways[i].ride = 1.0 + 0.25 * i;
    return ways;
  }
  ways[1].first_foot = BodySide::left, ways[1].tension = 1.3;
  ways[2].swing = 0.85, ways[2].tension = 1.15, ways[2].ride = 1.4;
  ways[3].first_foot = BodySide::right, ways[3].swing = 0.72, ways[3].tension = 1.15;
  ways[4].swing = 0.85, ways[4].width = 0.7, ways[4].tension = 1.3, ways[4].ride = 1.4;
  return ways;
}

/// A body that is to fall gives in sooner or later; a weaker one more easily.
std::vector<Choice> ways_to_fall() {
  std::vector<Choice> ways(5);
  ways[1].gives_in_s = 0.30;
  ways[2].gives_in_s = 0.20;
  ways[3].gives_in_s = 0.45, ways[3].tension = 0.8;
  ways[4].gives_in_s = 0.15, ways[4].tension = 0.7;
  return ways;
}

Choice varied(const Choice& choice, Random& random) {
  Choice other = choice;
  other.swing *= random.uniform(0.85, 1.1);
  other.width *= random.uniform(0.7, 1.1);
  other.tension *= random.uniform(0.9, 1.15);
  other.ride *= random.uniform(0.8, 1.5);
  if (other.gives_in_s) *other.gives_in_s *= random.uniform(0.7, 1.6);
  return other;
}

struct TriedTake {
  std::optional<BakedClip> take;  // nothing: it did not reach the outcome and was not followed to its end
  Diagnostics diagnostics;
};

class Search {
 public:
  Search(const Character& character, const BakeSettings& settings, const Prepared& prepared,
         const SearchRun& run)
      : character_(character), settings_(settings), prepared_(prepared), run_(run) {}

  /// The best of the choices that reach the outcome.
  Result<std::optional<TriedTake>> best_of(const std::vector<Choice>& choices);
  /// The least force from outside that reaches the outcome.
  Result<std::optional<TriedTake>> helped();
  /// A trial with any outcome.
  Result<TriedTake> followed(const Choice& choice);
  int trials() const { return trials_; }
  bool interrupted() const { return interrupted_; }

 private:
  Result<TriedTake> tried(const Choice& choice) const;
  bool reaches(const BakedClip& take) const;
  bool is_enough(const BakedClip& take) const;
  Result<TriedTake> run(const Choice& choice, bool must_stand) const;
  Result<std::optional<TriedTake>> with_help(double most_n);

  const Character& character_;
  const BakeSettings& settings_;
  const Prepared& prepared_;
  const SearchRun& run_;
  int trials_ = 0;
  bool interrupted_ = false;
};

Result<TriedTake> Search::run(const Choice& choice, bool must_stand) const {
  Stopwatch watch;
  BehaviourSettings behaviour = prepared_.behaviour;
  behaviour.choice = choice;
  behaviour.must_stand = must_stand;
  TriedTake trial;
  auto simulation = simulate_take(settings_, prepared_, behaviour, trial.diagnostics);
  if (!simulation) return simulation.error();
  if (must_stand && simulation->behaviour.fall_begins_s) return trial;
  const double simulate_s = watch.lap();
  auto take = clip_of_take(character_, settings_, prepared_, std::move(*simulation));
  if (!take) return take.error();
  trial.take = std::move(*take);
  trial.take->timings_s.simulate = simulate_s;
  trial.take->timings_s.resample = watch.lap();
  return trial;
}

Result<TriedTake> Search::followed(const Choice& choice) { return run(choice, false); }

Result<TriedTake> Search::tried(const Choice& choice) const {
  auto trial = run(choice, settings_.outcome == Wanted::stand);
  if (trial && trial->take && !reaches(*trial->take)) trial->take.reset();
  return trial;
}

bool Search::reaches(const BakedClip& take) const {
  if (!settings_.outcome) return true;
  const bool fell = response_of(take).outcome == Outcome::fell;
  return fell == (settings_.outcome == Wanted::fall);
}

bool Search::is_enough(const BakedClip& take) const {
  if (!settings_.outcome) return false;
  if (settings_.outcome == Wanted::fall) return take.score >= kGoodFall;
  return take.behaviour.steps.size() <= 1 && take.figures.rest_time_s;
}

/// Trials are run side by side in groups; what counts goes by their order alone.
Result<std::optional<TriedTake>> Search::best_of(const std::vector<Choice>& choices) {
  std::optional<TriedTake> best;
  const auto group = static_cast<std::size_t>(std::max(1, run_.threads));
  for (std::size_t begin = 0; begin < choices.size(); begin += group) {
    const std::size_t count = std::min(group, choices.size() - begin);
    std::vector<TriedTake> trials(count);
    const Status status = for_each_parallel(count, run_.threads, [&](std::size_t i) -> Status {
      auto trial = tried(choices[begin + i]);
      if (!trial) return trial.error();
      trials[i] = std::move(*trial);
      return Done{};
    });
    if (!status) return status.error();
    for (TriedTake& trial : trials) {
      ++trials_;
      if (run_.after_each) run_.after_each(trials_, static_cast<int>(choices.size()));
      if (!trial.take) continue;
      const bool enough = is_enough(*trial.take);
      if (!best || trial.take->score > best->take->score || (enough && !is_enough(*best->take)))
        best = std::move(trial);
      if (enough) return best;
    }
    interrupted_ = run_.stopped && run_.stopped() && begin + count < choices.size();
    if (interrupted_) break;
  }
  return best;
}

Result<std::optional<TriedTake>> Search::with_help(double most_n) {
  Choice choice;
  choice.help = {most_n, settings_.outcome == Wanted::fall};
  auto trial = tried(choice);
  if (!trial) return trial.error();
  ++trials_;
  return trial->take ? std::optional(std::move(*trial)) : std::nullopt;
}

Result<std::optional<TriedTake>> Search::helped() {
  constexpr int kDoublings = 6, kHalvings = 3;
  double enough = 0.05 * prepared_.body.mass_kg * settings_.simulation.gravity;
  double too_little = 0.0;
  std::optional<TriedTake> best;
  for (int i = 0; i < kDoublings && !best; ++i) {
    auto trial = with_help(enough);
    if (!trial) return trial.error();
    best = std::move(*trial);
    if (!best) too_little = enough, enough *= 2.0;
  }
  for (int i = 0; i < kHalvings && best; ++i) {
    const double force = 0.5 * (too_little + enough);
    auto trial = with_help(force);
    if (!trial) return trial.error();
    (*trial ? enough : too_little) = force;
    if (*trial) best = std::move(*trial);
  }
  return best;
}

void warn_of_the_outcome(const BakeSettings& settings, int trials, Diagnostics& diagnostics) {
  const std::string_view word = settings.outcome == Wanted::stand ? "stand" : "fall";
  const std::string none = trials == 1 ? fmt::format("the trial does not {}", word)
                                       : fmt::format("none of {} trials {}s", trials, word);
  const std::string_view way_on = settings.assist
                                      ? "help from outside was tried too: give another --strength"
                                      : "--search N tries more, --assist adds a force from outside";
  diagnostics.warn("", fmt::format("{}: the clip shows what the body does without help; {}", none, way_on));
}

}  // namespace

int most_trials(const BakeSettings& settings) {
  return static_cast<int>(settings.search.value_or(settings.outcome ? kTrials : 1));
}

std::vector<Choice> choices_for(const BakeSettings& settings) {
  const auto count = static_cast<std::size_t>(most_trials(settings));
  std::vector<Choice> choices =
      settings.outcome == Wanted::fall ? ways_to_fall() : ways_to_stand(settings.most_steps == 0.0);
  const std::size_t known = choices.size();
  Random random(static_cast<std::uint64_t>(settings.seed) + 1);
  while (choices.size() < count) choices.push_back(varied(choices[choices.size() % known], random));
  choices.resize(count);
  return choices;
}

Result<BakedClip> search_take(const Character& character, const BakeSettings& settings,
                              const Prepared& prepared, const SearchRun& run, Diagnostics& diagnostics) {
  Search search(character, settings, prepared, run);
  const bool limp = prepared.behaviour.kind == Behaviour::limp;
  const std::vector<Choice> choices = limp ? std::vector<Choice>(1) : choices_for(settings);
  auto best = search.best_of(choices);
  if (!best) return best.error();
  if (!*best && settings.assist && !search.interrupted()) best = search.helped();
  if (!best) return best.error();
  const bool reached = best->has_value();
  if (!reached) {
    auto first = search.followed(choices.front());
    if (!first) return first.error();
    *best = std::move(*first);
  }
  for (const Warning& warning : (*best)->diagnostics.warnings())
    diagnostics.warn(warning.subject, warning.what);
  if (!reached) warn_of_the_outcome(settings, search.trials(), diagnostics);
  if (search.interrupted())
    diagnostics.warn("", fmt::format("stopped after {} of {} trials; the best of them is kept",
                                     search.trials(), choices.size()));
  (*best)->take->trials = search.trials();
  return std::move(*(*best)->take);
}

}  // namespace ukemi
