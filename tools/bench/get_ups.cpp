// How bodies get up, from the frames of their clips: nine lying poses of every character, one row each, then
// the worst of all.
// ukemi_get_ups CHARACTER[@HEIGHT_M],... [FIRST,LAST [SETTING=VALUE ...]]
// A single pose is shown frame by frame as well.
// cost: CPU seconds of planning it, once more.
// off balance: centre of mass outside the skin that bears (least of it with and without momentum), by phase.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bake/bake.h"
#include "blows.h"
#include "body/ground.h"
#include "body/weight.h"
#include "judge/judge.h"
#include "rise/get_up.h"
#include "stopwatch.h"

namespace ukemi {
namespace {

constexpr int kPoses = 9;
constexpr double kAsHeLay_s = 0.3;  // in which he still lies as the fall left him

struct PhaseFigures {
  std::string name;
  double mass_m = -1.0, least_m = -1.0, skin_m = 0.0;
};

struct Row {
  std::string what, error, route, lying;
  std::vector<PhaseFigures> phases;
  double slide_m = 0.0, skin_m = 0.0, duration_s = 0.0, score = 0.0, speed_m_s = 0.0;
  double cost_s = 0.0;
  long over_1deg = 0;
  std::string failed, frames, slides, fastest;
};

/// The nine falls: limp and living ones, from all around, other seeds.
void set_fall(BakeSettings& settings, int character, int pose) {
  constexpr const char* kHits[] = {"chest", "thigh_l", "head", "abdomen", "thigh_r",
                                   "chest", "pelvis",  "head", "chest"};
  (void)set(settings, "hit", kHits[pose]);
  (void)set(settings, "from", std::to_string((pose * 40 + character * 15) % 360));
  (void)set(settings, "seed", std::to_string(pose + 10 * character));
  (void)set(settings, "preset", "kick");
  (void)set(settings, "strength", "2");
  (void)set(settings, "steps", pose % 2 ? "0" : "6");
  if (pose % 3 == 0) (void)set(settings, "behaviour", "limp");
  settings.get_up_s = 0.8;
}

void see_phases(const BakedClip& outcome, const std::vector<WeightOffset>& weights, const SkinOverFloor& skin,
                Row& row) {
  const GetUpTimes& times = *outcome.get_up;
  const Clip& clip = outcome.timeline.clip;
  const int first = static_cast<int>(std::lround(times.begins_s * clip.fps));
  for (std::size_t p = 0; p < times.phases.size(); ++p) {
    PhaseFigures figures{times.phases[p].name};
    const int from = static_cast<int>(std::lround(times.phases[p].time_s * clip.fps));
    const int to = p + 1 < times.phases.size()
                       ? static_cast<int>(std::lround(times.phases[p + 1].time_s * clip.fps))
                       : static_cast<int>(clip.frames.size());
    for (int f = std::max(from, first + 1); f < to; ++f) {
      const auto i = static_cast<std::size_t>(f);
      figures.skin_m = std::max(figures.skin_m, skin.depth(clip.frames[i]).body_m);
      if (f < first + kAsHeLay_s * clip.fps) continue;
      figures.mass_m = std::max(figures.mass_m, weights[i].mass_m);
      figures.least_m = std::max(figures.least_m, weights[i].least_m());
    }
    row.skin_m = std::max(row.skin_m, figures.skin_m);
    row.phases.push_back(figures);
  }
}

/// Every third frame: how far the weight is off, and the lowest skin of what could bear, mm.
void see_frames(const BakedClip& outcome, const PerSegment<std::vector<Vec3>>& skin,
                const std::vector<BodyPose>& frames, const std::vector<WeightOffset>& weights,
                const SkinOverFloor& blended, const Skeleton& skeleton, Row& row) {
  const double fps = outcome.timeline.clip.fps;
  for (auto f = static_cast<std::size_t>(std::lround(outcome.get_up->begins_s * fps)); f < frames.size();
       f += 3) {
    row.frames +=
        fmt::format("    {:.2f} s {:4.0f} {:4.0f} |", static_cast<double>(f) / fps - outcome.get_up->begins_s,
                    1e3 * weights[f].mass_m, 1e3 * weights[f].capture_m);
    for (int s = 0; s < kSegmentCount; ++s) {
      double low = 1.0;
      for (const Vec3& p : skin[s]) low = std::min(low, (frames[f][s] * p).y());
      if (low < 0.05) row.frames += fmt::format(" {} {:.0f}", name(segment_at(s)), 1e3 * low);
    }
    const SkinDepth depth = blended.depth(outcome.timeline.clip.frames[f]);
    if (depth.body_m > 0.004)
      row.frames += fmt::format(" | {} sunk {:.0f}", skeleton.label(depth.body_node), 1e3 * depth.body_m);
    row.frames += '\n';
  }
}

void see_motion(const BakedClip& outcome, const std::vector<BodyPose>& frames, Row& row) {
  const GetUpTimes& times = *outcome.get_up;
  const double fps = outcome.timeline.clip.fps;
  const int first = static_cast<int>(std::lround(times.begins_s * fps));
  for (const PlantedPart& part : times.planted) {
    const auto place = [&](int f) {
      return Vec3(frames[static_cast<std::size_t>(first + f)][index(part.segment)] * part.point);
    };
    for (int f = part.first; f <= part.last; ++f) {
      const Vec3 way = place(f) - place(part.first);
      if (way.norm() <= row.slide_m) continue;
      row.slide_m = way.norm();
      row.slides = fmt::format("{} at {:.2f} s, up {:.0f}", name(part.segment), f / fps, 1e3 * way.y());
    }
  }
  for (std::size_t f = static_cast<std::size_t>(first) + 1; f < frames.size(); ++f)
    for (int s = 0; s < kSegmentCount; ++s) {
      const double speed = fps * (frames[f][s].translation - frames[f - 1][s].translation).norm();
      if (speed <= row.speed_m_s) continue;
      row.speed_m_s = speed;
      row.fastest =
          fmt::format("{} at {:.2f} s", name(segment_at(s)), (static_cast<double>(f) - first) / fps);
    }
}

/// CPU time in which the get-up is planned: once more, from the frame in which it begins.
double planning_s(const Prepared& prepared, const BakeSettings& settings,
                  const PerSegment<std::vector<Vec3>>& skin, const std::vector<BodyPose>& frames,
                  std::size_t first, double fps) {
  const double before_s = thread_seconds();
  const auto planned = plan_get_up(prepared.body, prepared.range, frames[first > 0 ? first - 1 : 0],
                                   frames[first], prepared.start.state.segments, skin,
                                   {settings.get_up_style, static_cast<std::uint64_t>(settings.seed), fps});
  return planned ? thread_seconds() - before_s : NAN;
}

void see(const Character& character, const BakeSettings& settings, const BakedClip& outcome, Row& row) {
  const Prepared& prepared = outcome.prepared;
  const Clip& clip = outcome.timeline.clip;
  const Actor actor = prepared.actor(character);
  const SegmentFrames segment_frames = frames_of(actor);
  std::vector<BodyPose> frames;
  for (const Pose& pose : clip.frames) frames.push_back(segments_above_floor(actor, segment_frames, pose));
  const auto outer = outermost_skin(character, prepared.humanoid, prepared.start.pose,
                                    prepared.start.segments, prepared.body);
  const SkinOverFloor skin(character, prepared.humanoid, prepared.body, prepared.start.pose,
                           prepared.start.segments);
  const auto weights = weight_offsets(prepared.body, outer, frames, clip.fps);
  see_phases(outcome, weights, skin, row);
  see_frames(outcome, outer, frames, weights, skin, character.skeleton, row);
  see_motion(outcome, frames, row);
  const int first = static_cast<int>(std::lround(outcome.get_up->begins_s * clip.fps));
  row.lying = name(lying_of(prepared.body, frames[static_cast<std::size_t>(first)]));
  row.cost_s = planning_s(prepared, settings, outer, frames, static_cast<std::size_t>(first), clip.fps);
  row.duration_s = outcome.get_up->stands_s - outcome.get_up->begins_s;
  row.route = outcome.get_up->route;
  row.over_1deg = outcome.human.over_1deg;
  JudgeSettings judging;
  judging.impact_s = 0.0;
  judging.hit = settings.hit;
  const Judgement judgement = judge(judged_motion(character, prepared.humanoid, clip), judging);
  row.score = judgement.score;
  for (const Criterion& criterion : judgement.criteria)
    for (const Clause& clause : criterion.clauses)
      if (!clause.holds() && (criterion.number == 19 || criterion.number > 19))
        row.failed += fmt::format(" {} {}={:.4g}", criterion.number, clause.name, clause.value.value_or(NAN));
}

void run(const Character& character, const BakeSettings& settings, Row& row) {
  Diagnostics diagnostics;
  const auto outcome = bake(character, settings, diagnostics);
  if (!outcome)
    row.error = outcome.error().message();
  else if (!outcome->get_up)
    row.error = "is not down";
  else
    see(character, settings, *outcome, row);
}

void print_row(const Row& row) {
  fmt::print("{:<28}", row.what);
  if (!row.error.empty()) return fmt::print(" {}\n", row.error);
  fmt::print(
      " {:<10} {:<10} {:.1f} s cost {:.2f} s score {:.2f} slide {:4.1f} ({}) skin {:4.1f} mm {:.1f} m/s ({}) "
      "over {}{}\n  "
      " ",
      row.lying, row.route, row.duration_s, row.cost_s, row.score, 1e3 * row.slide_m, row.slides,
      1e3 * row.skin_m, row.speed_m_s, row.fastest, row.over_1deg, row.failed);
  for (const PhaseFigures& phase : row.phases)
    fmt::print(" {} {:.0f}({:.0f}) mm skin {:.0f};", phase.name, 1e3 * phase.mass_m, 1e3 * phase.least_m,
               1e3 * phase.skin_m);
  fmt::print("\n");
}

void print_worst(const std::vector<Row>& rows) {
  std::map<std::string, PhaseFigures> phases;
  std::vector<double> slide, skin, balance, score, cost;
  for (const Row& row : rows) {
    if (!row.error.empty()) continue;
    double worst = -1.0;
    for (const PhaseFigures& phase : row.phases) {
      PhaseFigures& all = phases[phase.name];
      all.mass_m = std::max(all.mass_m, phase.mass_m);
      all.least_m = std::max(all.least_m, phase.least_m);
      all.skin_m = std::max(all.skin_m, phase.skin_m);
      worst = std::max(worst, phase.least_m);
    }
    balance.push_back(worst), slide.push_back(row.slide_m), skin.push_back(row.skin_m);
    score.push_back(row.score), cost.push_back(row.cost_s);
  }
  for (const auto& [name, phase] : phases)
    fmt::print("{:<14} off balance {:4.0f} ({:4.0f}) mm, skin {:4.1f} mm\n", name, 1e3 * phase.mass_m,
               1e3 * phase.least_m, 1e3 * phase.skin_m);
  const auto print = [&](const char* what, std::vector<double> values, double limit, double unit) {
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    fmt::print("{:<12} median {:.2f} worst {:.2f}, {} of {} above {:.2f}\n", what,
               unit * values[values.size() / 2], unit * values.back(),
               std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; }),
               values.size(), unit * limit);
  };
  print("off balance", balance, 0.03, 1e3);
  print("slide", slide, 0.01, 1e3);
  print("skin", skin, 0.01, 1e3);
  print("score", score, 0.93, 1.0);
  print("cost s", cost, 0.1, 1.0);
}

}  // namespace
}  // namespace ukemi

int main(int argc, char** argv) {
  using namespace ukemi;
  const auto names = split(argc > 1 ? argv[1] : "mannequin");
  const auto span = split(argc > 2 ? argv[2] : "0,8");
  BakeSettings base;
  if (const Status status = set_all(base, argc, argv, 3); !status)
    return fmt::print("{}\n", status.error().message()), 2;
  Diagnostics diagnostics;
  std::vector<Row> rows;
  std::vector<std::pair<const Character*, BakeSettings>> bakes;
  std::vector<Character> characters;
  characters.reserve(names.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto at = names[c].find('@');
    auto character = load_named(names[c].substr(0, at), diagnostics);
    if (!character) return fmt::print("{}\n", character.error().message()), 2;
    characters.push_back(std::move(*character));
    for (int pose = std::stoi(span.front()); pose <= std::min(std::stoi(span.back()), kPoses - 1); ++pose) {
      BakeSettings settings = base;
      set_fall(settings, static_cast<int>(c), pose);
      if (at != std::string::npos) (void)set(settings, "height", names[c].substr(at + 1));
      bakes.emplace_back(&characters.back(), settings);
      rows.emplace_back().what = fmt::format("{} {}", names[c].substr(names[c].find_last_of('/') + 1), pose);
    }
  }
  const auto work = [&](std::size_t first) {
    for (std::size_t i = first; i < bakes.size(); i += 2) run(*bakes[i].first, bakes[i].second, rows[i]);
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  for (const Row& row : rows) {
    print_row(row);
    if (rows.size() == 1) fmt::print("{}", row.frames);
  }
  print_worst(rows);
}
