#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/errors.h"
#include "base/files.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNormal95 = 1.96;
constexpr std::size_t kMostBytes = 64u << 20;
constexpr std::array kRows = {"limp", "limp, no tone", "stand",    "step",
                              "fall", "get-up",        kReference, kBulletRun};

struct Moments {
  double mean = 0.0, error = 0.0;  // standard error of the mean
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  const double n = static_cast<double>(values.size());
  for (const double value : values) m.mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - m.mean) * (value - m.mean);
  if (n > 1.0) m.error = std::sqrt(squares / (n - 1.0) / n);
  return m;
}

/// A row of the table.
struct Row {
  std::string name;
  Sample sum;  // of the hits that did not fail; largest, where its name says so
  int hits = 0, failed = 0, rested = 0;
  std::vector<double> cost, reference;
};

void add(const Sample& sample, double reference_s, Row& row) {
  if (sample.failed) {
    ++row.failed;
    return;
  }
  ++row.hits;
  row.rested += sample.rested ? 1 : 0;
  row.cost.push_back(sample.cpu_s);
  row.reference.push_back(reference_s);
  Sample& sum = row.sum;
  sum.cpu_s += sample.cpu_s;
  sum.engine_s += sample.engine_s;
  for (const auto member : {&Sample::calls, &Sample::rows, &Sample::contacts, &Sample::steps,
                            &Sample::rejected, &Sample::samples, &Sample::over_1deg, &Sample::over_own_1deg})
    sum.*member += sample.*member;
  for (const auto member : {&Sample::excess_max_deg, &Sample::separation_max_m, &Sample::energy_gain_max_j})
    sum.*member = std::max(sum.*member, sample.*member);
}

std::map<int, double> references(const std::vector<Sample>& samples) {
  std::map<int, double> seconds;
  for (const Sample& sample : samples)
    if (sample.run == kReference && !sample.failed) seconds[sample.hit] = sample.cpu_s;
  return seconds;
}

std::vector<Row> rows_of(const std::vector<Sample>& samples) {
  const std::map<int, double> reference = references(samples);
  std::vector<Row> rows;
  for (const char* name : kRows) {
    Row row;
    row.name = name;
    for (const Sample& sample : samples)
      if (sample.row == name && reference.contains(sample.hit)) add(sample, reference.at(sample.hit), row);
    if (row.hits + row.failed > 0) rows.push_back(std::move(row));
  }
  return rows;
}

double over(double sum, long count) { return count > 0 ? sum / static_cast<double>(count) : 0.0; }

/// Figures by column, those of one hit, step or call of the engine.
Json row_json(const Row& row) {
  const Sample& sum = row.sum;
  const Ratio ratio = ratio_of_sums(row.cost, row.reference);
  const long tried = sum.steps + sum.rejected;
  return {{"row", row.name},
          {"hits", row.hits},
          {"failed", row.failed},
          {"ratio", ratio.value},
          {"ratio_low", ratio.low},
          {"ratio_high", ratio.high},
          {"ms_per_hit", over(1e3 * sum.cpu_s, row.hits)},
          {"us_per_step", over(1e6 * sum.cpu_s, tried)},
          {"engine_share", sum.cpu_s > 0.0 ? sum.engine_s / sum.cpu_s : 0.0},
          {"steps", over(static_cast<double>(sum.steps), row.hits)},
          {"rejected", over(static_cast<double>(sum.rejected), row.hits)},
          {"rows", over(static_cast<double>(sum.rows), sum.calls)},
          {"contacts", over(static_cast<double>(sum.contacts), sum.calls)},
          {"samples", sum.samples},
          {"over_1deg", sum.over_1deg},
          {"over_own_1deg", sum.over_own_1deg},
          {"excess_max_deg", sum.excess_max_deg},
          {"separation_max_mm", 1e3 * sum.separation_max_m},
          {"energy_gain_max_j", sum.energy_gain_max_j},
          {"rested", row.rested}};
}

std::string row_text(const Row& row) {
  const Json j = row_json(row);
  const auto number = [&](const char* key) { return j[key].get<double>(); };
  const bool bullet = row.name == kBulletRun;
  const std::string rows = bullet ? "-" : fmt::format("{:.1f}", number("rows"));
  const std::string gain = bullet ? "-" : fmt::format("{:.2f}", number("energy_gain_max_j"));
  return fmt::format(
      "{:<14}{:>5}{:>8.3f}{:>15}{:>9.2f}{:>9.1f}{:>8.0f}%{:>7.0f}{:>9.1f}{:>7}{:>9.1f}{:>8}{:>8.2f}{:>7.2f}"
      "{:>7}{:>7}\n",
      row.name, row.hits, number("ratio"),
      fmt::format("{:.3f}-{:.3f}", number("ratio_low"), number("ratio_high")), number("ms_per_hit"),
      number("us_per_step"), 100.0 * number("engine_share"), number("steps"), number("rejected"), rows,
      number("contacts"), row.sum.over_1deg, number("excess_max_deg"), number("separation_max_mm"), gain,
      row.rested);
}

std::string percent(long part, long whole) {
  return fmt::format("{:.2f} %", over(100.0 * static_cast<double>(part), whole));
}

/// What the table cannot say of a row.
std::string remarks(const Row& row) {
  std::string text;
  if (row.failed > 0)
    text += fmt::format("{}: {} more left out: they failed or lay nowhere\n", row.name, row.failed);
  if (row.name == kBulletRun)
    text += fmt::format(
        "{}: {} of all joint samples lie over 1 degree outside our range, {} outside the cone that Bullet "
        "had\n",
        row.name, percent(row.sum.over_1deg, row.sum.samples),
        percent(row.sum.over_own_1deg, row.sum.samples));
  return text;
}

std::map<std::pair<int, std::string>, const Sample*> by_run(const std::vector<Sample>& samples) {
  std::map<std::pair<int, std::string>, const Sample*> found;
  for (const Sample& sample : samples)
    if (!sample.failed) found[{sample.hit, sample.run}] = &sample;
  return found;
}

/// Costs of the runs that both have, and how many ended otherwise.
struct Pairs {
  std::vector<double> ours, theirs;
  int otherwise = 0;
};

std::map<std::string, Pairs> pairs_of(const std::vector<Sample>& ours, const std::vector<Sample>& theirs,
                                      bool relative) {
  const auto our_reference = references(ours);
  const auto their_reference = references(theirs);
  const auto known = by_run(theirs);
  std::map<std::string, Pairs> pairs;
  for (const Sample& sample : ours) {
    const auto other = known.find({sample.hit, sample.run});
    if (sample.failed || other == known.end()) continue;
    const bool has_both = our_reference.contains(sample.hit) && their_reference.contains(sample.hit);
    if (relative && !has_both) continue;
    Pairs& row = pairs[sample.row];
    row.ours.push_back(relative ? sample.cpu_s / our_reference.at(sample.hit) : sample.cpu_s);
    row.theirs.push_back(relative ? other->second->cpu_s / their_reference.at(sample.hit)
                                  : other->second->cpu_s);
    row.otherwise += other->second->row != sample.row || other->second->steps != sample.steps ? 1 : 0;
  }
  return pairs;
}

}  // namespace

Ratio ratio_of_sums(const std::vector<double>& cost, const std::vector<double>& reference) {
  Ratio ratio{static_cast<int>(cost.size())};
  if (cost.empty()) return ratio;
  const double mean = moments(reference).mean;
  ratio.value = moments(cost).mean / mean;
  std::vector<double> left;
  for (std::size_t i = 0; i < cost.size(); ++i) left.push_back((cost[i] - ratio.value * reference[i]) / mean);
  const double half = kNormal95 * moments(left).error;
  ratio.low = ratio.value - half;
  ratio.high = ratio.value + half;
  return ratio;
}

Ratio mean_ratio(const std::vector<double>& cost, const std::vector<double>& reference) {
  Ratio ratio{static_cast<int>(cost.size())};
  if (cost.empty()) return ratio;
  std::vector<double> logs;
  for (std::size_t i = 0; i < cost.size(); ++i) logs.push_back(std::log(cost[i] / reference[i]));
  const Moments m = moments(logs);
  ratio.value = std::exp(m.mean);
  ratio.low = std::exp(m.mean - kNormal95 * m.error);
  ratio.high = std::exp(m.mean + kNormal95 * m.error);
  return ratio;
}

std::string table_text(const Measured& measured) {
  std::string text = fmt::format(
      "{}: {} random hits, {:g} s each, CPU time of one thread\n"
      "ratio: to {} on the same hits, with its 95 % interval; rows and contacts: in a call of the engine\n"
      "{:<14}{:>5}{:>8}{:>15}{:>9}{:>9}{:>9}{:>7}{:>9}{:>7}{:>9}{:>8}{:>8}{:>7}{:>7}{:>7}\n",
      measured.character, measured.hits, measured.duration_s, kReference, "", "hits", "ratio", "95 %",
      "ms/hit", "us/step", "engine", "steps", "rejected", "rows", "contacts", "over 1", "max deg", "sep mm",
      "gain J", "rested");
  std::string after;
  for (const Row& row : rows_of(measured.samples)) {
    if (row.hits > 0) text += row_text(row);
    after += remarks(row);
  }
  return text + after;
}

std::string table_json(const Measured& measured) {
  Json json;
  json["format"] = 1;
  json["bench"] = "ukemi";
  json["character"] = measured.character;
  json["hits"] = measured.hits;
  json["duration_s"] = measured.duration_s;
  json["rows"] = Json::array();
  for (const Row& row : rows_of(measured.samples)) json["rows"].push_back(row_json(row));
  json["samples"] = nlohmann::json(measured.samples);
  return json.dump(1) + "\n";
}

Result<Measured> measured_in(const std::string& file) {
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes) return bytes.error();
  try {
    const auto json = nlohmann::json::parse(*bytes);
    return Measured{json.at("character"), json.at("hits"), json.at("duration_s"),
                    json.at("samples").get<std::vector<Sample>>()};
  } catch (const nlohmann::json::exception&) {
    return input_error(file, "is not what a bench wrote with --json",
                       "write it with tools/bench/run --json FILE");
  }
}

std::string comparison_text(const std::vector<Sample>& ours, const std::vector<Sample>& theirs,
                            bool relative) {
  const auto pairs = pairs_of(ours, theirs, relative);
  std::string text = fmt::format(
      "\nthis build over the other, {}: mean of the ratios pair by pair, with its 95 % interval\n"
      "{:<14}{:>7}{:>8}{:>15}{:>12}\n",
      relative ? fmt::format("each over its own {}", kReference) : "interleaved in one run", "", "pairs",
      "ratio", "95 %", "otherwise");
  for (const char* name : kRows) {
    const auto row = pairs.find(name);
    if (row == pairs.end()) continue;
    const Ratio ratio = mean_ratio(row->second.ours, row->second.theirs);
    text += fmt::format("{:<14}{:>7}{:>8.3f}{:>15}{:>12}\n", name, ratio.pairs, ratio.value,
                        fmt::format("{:.3f}-{:.3f}", ratio.low, ratio.high), row->second.otherwise);
  }
  return text + "otherwise: pairs in which the body took another number of steps or ended in another row\n";
}

}  // namespace ukemi
