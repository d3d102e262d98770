// How falls look to the judge, over characters, blows and directions: each fall's clauses that fail, how
// often each clause fails on each character, the share of falls that pass each criterion, and the means of
// what belongs to a set. ukemi_falls CHARACTER,... SEGMENT,... BLOW,... AZIMUTH,... [SETTING=VALUE ...] BLOW:
// a preset, or N s of an impulse on a man of 78 kg and 1.78 m (scaled as in the judge).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bake/bake.h"
#include "blows.h"
#include "judge/judge.h"

namespace ukemi {
namespace {

struct Blow {
  const Character* character = nullptr;
  std::string what, segment, blow, azimuth;
  std::string error;
  std::optional<Judgement> judgement;
  LimitFigures limits;
};

/// The blow in N s, where it is a number.
std::optional<double> momentum(const std::string& blow) {
  char* end = nullptr;
  const double value = std::strtod(blow.c_str(), &end);
  return *end == '\0' ? std::optional(value) : std::nullopt;
}

void run(const BakeSettings& base, Blow& blow) {
  BakeSettings settings = base;
  (void)set(settings, "hit", blow.segment);
  (void)set(settings, "from", blow.azimuth);
  Diagnostics diagnostics;
  if (const auto n_s = momentum(blow.blow)) {
    const auto prepared = prepare_bake(*blow.character, settings, diagnostics);
    if (!prepared) return void(blow.error = prepared.error().message());
    settings.scene = SceneKind::impulse;
    settings.ball_mass_kg = 1.0;
    settings.ball_speed_m_s = momentum_for(prepared->body, *n_s);
  } else {
    (void)set(settings, "preset", blow.blow);
  }
  auto outcome = bake(*blow.character, settings, diagnostics);
  if (!outcome) return void(blow.error = outcome.error().message());
  const JudgedMotion motion =
      judged_motion(*blow.character, outcome->prepared.humanoid, outcome->timeline.clip);
  JudgeSettings judging;
  judging.impact_s = 0.0;
  judging.hit = settings.hit;
  blow.judgement = judge(motion, judging);
  blow.limits = outcome->limits;
}

void print_row(const Blow& blow) {
  fmt::print("{:<34}", blow.what);
  if (!blow.judgement) return fmt::print(" {}\n", blow.error);
  const Judgement& j = *blow.judgement;
  fmt::print(" {} {:<10} {:.2f}", j.fall ? "F" : "-", name(j.final_pose), j.score);
  if (j.fall) {
    const auto time = [](const std::optional<Contact>& c) {
      return c ? fmt::format("{:.2f}/{:.1f}", c->time_s, c->speed_m_s) : std::string("-");
    };
    fmt::print(" knee {} hand {} pelvis {:.2f}/{:.1f}{} head {} rest {:.2f}", time(j.fall->knee),
               time(j.fall->hand), j.fall->pelvis.time_s, j.fall->pelvis.speed_m_s,
               j.fall->pelvis_down ? "" : "!", time(j.fall->head), j.fall->rest_s.value_or(-1.0));
  }
  for (const Criterion& criterion : j.criteria)
    for (const Clause& clause : criterion.clauses)
      if (!clause.holds())
        fmt::print(" {} {}={:.4g}", criterion.number, clause.name, clause.value.value_or(NAN));
  if (blow.limits.over_1deg > 0) fmt::print(" OVER {}", blow.limits.over_1deg);
  fmt::print("\n");
}

/// How many falls of each character fail each clause, the clause that fails most first.
void print_failures(const std::vector<Blow>& blows) {
  std::map<std::string, std::map<std::string, int>> failed;
  for (const Blow& blow : blows) {
    if (!blow.judgement || !blow.judgement->fall) continue;
    const std::string character = blow.what.substr(0, blow.what.find(' '));
    for (const Criterion& criterion : blow.judgement->criteria)
      for (const Clause& clause : criterion.clauses)
        if (!clause.holds()) ++failed[fmt::format("{} {}", criterion.number, clause.name)][character];
  }
  std::vector<std::pair<int, std::string>> rows;
  for (const auto& [clause, characters] : failed) {
    int sum = 0;
    std::string row;
    for (const auto& [character, count] : characters)
      sum += count, row += fmt::format(" {} {}", character, count);
    rows.emplace_back(-sum, fmt::format("{:<24} fails {:>3}:{}", clause, sum, row));
  }
  std::sort(rows.begin(), rows.end());
  for (const auto& [sum, row] : rows) fmt::print("{}\n", row);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

void print_set(const std::vector<Blow>& blows) {
  std::map<int, std::pair<int, int>> passed;
  std::vector<double> share, pelvis, head, elbow;
  int hands = 0, falls = 0, no_head = 0;
  for (const Blow& blow : blows) {
    if (!blow.judgement || !blow.judgement->fall) continue;
    const Judgement& j = *blow.judgement;
    ++falls;
    share.push_back(j.score);
    pelvis.push_back(j.fall->pelvis.speed_m_s);
    if (j.fall->head)
      head.push_back(j.fall->head->speed_m_s);
    else
      ++no_head;
    if (j.fall->hand) {
      elbow.push_back(j.fall->elbow_deg);
      const double after = j.fall->hand->time_s - j.fall->pelvis.time_s;
      hands += after > -0.40 && after < 0.15;
    }
    for (const Criterion& c : j.criteria)
      if (c.passed) ++passed[c.number].second, passed[c.number].first += *c.passed;
  }
  std::sort(head.begin(), head.end());
  fmt::print(
      "{} falls: share {:.3f}; pelvis {:.2f} m/s, head none {}/{}, worst {:.1f}, hand in time {}, elbow "
      "{:.0f}\n",
      falls, mean(share), mean(pelvis), no_head, falls, head.empty() ? 0.0 : head.back(), hands, mean(elbow));
  for (const auto& [number, count] : passed) fmt::print(" {}: {}/{}", number, count.first, count.second);
  fmt::print("\n");
}

}  // namespace
}  // namespace ukemi

int main(int argc, char** argv) {
  using namespace ukemi;
  const auto argument = [&](int i, const char* otherwise) { return split(argc > i ? argv[i] : otherwise); };
  const auto names = argument(1, "mannequin");
  BakeSettings settings;
  if (const Status status = set_all(settings, argc, argv, 5); !status)
    return fmt::print("{}\n", status.error().message()), 2;
  Diagnostics diagnostics;
  std::vector<Character> characters;
  for (const std::string& name : names) {
    auto character = load_named(name, diagnostics);
    if (!character) return fmt::print("{}\n", character.error().message()), 2;
    characters.push_back(std::move(*character));
  }
  std::vector<Blow> blows;
  for (std::size_t c = 0; c < characters.size(); ++c)
    for (const auto& segment : argument(2, "chest,abdomen,thigh_l"))
      for (const auto& blow : argument(3, "100"))
        for (const auto& azimuth : argument(4, "0,45,90,135,180,225,270,315")) {
          const std::string file = names[c].substr(names[c].find_last_of('/') + 1);
          blows.push_back({&characters[c],
                           fmt::format("{} {} {} {}", file, segment, blow, azimuth),
                           segment,
                           blow,
                           azimuth,
                           {},
                           {},
                           {}});
        }
  const auto work = [&](std::size_t first) {
    for (std::size_t i = first; i < blows.size(); i += 2) run(settings, blows[i]);
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  for (const Blow& blow : blows) print_row(blow);
  print_failures(blows);
  print_set(blows);
}
