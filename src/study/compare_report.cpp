// A comparison as a table and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "bake/report.h"
#include "base/version.h"
#include "study/compare.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kWithoutActive = "b";  // that c adds the active restriction to

double share(const MethodFigures& figures) {
  return figures.samples > 0 ? static_cast<double>(figures.over_1deg) / static_cast<double>(figures.samples)
                             : 0.0;
}

const MethodFigures* find_method(const Comparison& comparison, std::string_view wanted) {
  for (const MethodFigures& figures : comparison.methods)
    if (figures.method.name == wanted) return &figures;
  return nullptr;
}

struct Claim {
  const char* key;
  const char* words;
  std::vector<double> MethodFigures::*by_hit;
};
constexpr std::array kClaims = {
    Claim{"angular_momentum", "spin", &MethodFigures::angular_momentum_by_hit_kg_m2_s},
    Claim{"airborne", "in air", &MethodFigures::airborne_by_hit_s},
    Claim{"turning", "turning", &MethodFigures::turning_by_hit_rad_s}};

/// What the active restriction changes: a method that has it against the same without.
Json against_b_json(const Comparison& comparison, const MethodFigures& figures) {
  const MethodFigures* other = find_method(comparison, kWithoutActive);
  if (other == nullptr || figures.method.simulation.active != Active::explicit_torque) return nullptr;
  Json json;
  for (const Claim& claim : kClaims) {
    const PairedChange change = paired_change(figures, *other, claim.by_hit);
    json[claim.key] = {{"change_fraction", change.fraction},
                       {"interval_95", {change.low, change.high}},
                       {"hits_less", change.less},
                       {"hits_more", change.more}};
  }
  return json;
}

std::string against_b_text(const Comparison& comparison) {
  const MethodFigures* other = find_method(comparison, kWithoutActive);
  std::string text;
  for (const MethodFigures& figures : comparison.methods) {
    if (other == nullptr || figures.method.simulation.active != Active::explicit_torque) continue;
    text += fmt::format("{} against {}, the same hits (95 % interval):", figures.method.name, kWithoutActive);
    for (const Claim& claim : kClaims) {
      const PairedChange change = paired_change(figures, *other, claim.by_hit);
      text += fmt::format(" {} {:+.1f} % ({:+.1f} to {:+.1f}), less in {}, more in {} hits;", claim.words,
                          100.0 * change.fraction, 100.0 * change.low, 100.0 * change.high, change.less,
                          change.more);
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  Json json;
  json["format"] = 1;
  json["generator"] = generator();
  json["character"] = comparison.character;
  json["hits"] = comparison.settings.hits;
  json["seed"] = comparison.settings.seed;
  json["region"] = comparison.settings.region;
  json["widened_deg"] = Json::object();
  for (const auto& [joint, angle] : comparison.widened)
    json["widened_deg"][std::string(name(joint))] = degrees(angle);
  json["methods"] = Json::array();
  for (const MethodFigures& figures : comparison.methods) {
    Json method;
    method["method"] = figures.method.name;
    method["limits"] = name(figures.method.simulation.limits);
    method["active"] = name(figures.method.simulation.active);
    method["samples"] = figures.samples;
    method["over_1deg"] = figures.over_1deg;
    method["excess_p999_deg"] = figures.excess_p999_deg;
    method["excess_max_deg"] = figures.excess_max_deg;
    method["worst_joint"] = figures.worst_joint ? Json(name(*figures.worst_joint)) : Json(nullptr);
    method["joint_separation_max_m"] = figures.joint_separation_max_m;
    method["energy_gain_max_j"] = figures.energy_gain_max_j;
    method["exploded"] = figures.exploded;
    method["angular_momentum_mean_kg_m2_s"] = figures.angular_momentum_mean_kg_m2_s;
    method["airborne_mean_s"] = figures.airborne_mean_s;
    method["turning_mean_rad_s"] = figures.turning_mean_rad_s;
    method["against_b"] = against_b_json(comparison, figures);
    method["us_per_step"] = figures.us_per_step;
    method["cpu_s_per_s"] = figures.cpu_s_per_s;
    json["methods"].push_back(std::move(method));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

/// "0", "0.00012 %", "3.41 %"
std::string percent(double share) {
  if (share <= 0.0) return "0";
  return share < 0.001 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.2f} %", 100.0 * share);
}

std::string joules(double value) {
  return value < 1e5 ? fmt::format("{:.1f}", value) : fmt::format("{:.1e}", value);
}

std::vector<std::string> table_row(const MethodFigures& figures) {
  return {figures.method.name,
          fmt::format("{}", figures.samples),
          fmt::format("{}", figures.over_1deg),
          percent(share(figures)),
          fmt::format("{:.3f}", figures.excess_p999_deg),
          fmt::format("{:.2f}", figures.excess_max_deg),
          figures.worst_joint ? std::string(name(*figures.worst_joint)) : "-",
          fmt::format("{:.1f}", 1000.0 * figures.joint_separation_max_m),
          joules(figures.energy_gain_max_j),
          fmt::format("{}", figures.exploded),
          fmt::format("{:.2f}", figures.angular_momentum_mean_kg_m2_s),
          fmt::format("{:.3f}", figures.airborne_mean_s),
          fmt::format("{:.2f}", figures.turning_mean_rad_s),
          fmt::format("{:.0f}", figures.us_per_step),
          fmt::format("{:.3f}", figures.cpu_s_per_s)};
}

/// Columns as wide as their longest entry; words to the left, numbers to the right.
std::string aligned(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& words) {
  std::vector<std::size_t> widths(words.size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line +=
          words[i] ? fmt::format("{:<{}}  ", row[i], widths[i]) : fmt::format("{:>{}}  ", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::string comparison_text(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {
      {"method", "joint", "over", "", "p99.9", "max", "worst", "apart", "gain", "ex-", "spin", "in air",
       "turning", "us per", "cpu s"},
      {"", "samples", "1 deg", "", "deg", "deg", "joint", "mm", "J", "ploded", "kg m2/s", "s", "rad/s",
       "step", "per s"}};
  for (const MethodFigures& figures : comparison.methods) rows.push_back(table_row(figures));
  std::vector<bool> words(rows.front().size(), false);
  words[0] = words[6] = true;
  std::string text = fmt::format(
      "{}: {} random hits (seed {}), methods in the region {}, judged against human\n\n",
      comparison.character, comparison.settings.hits, comparison.settings.seed, comparison.settings.region);
  text += aligned(rows, words);
  for (const auto& [joint, angle] : comparison.widened)
    text += fmt::format("{} widened by {:.1f} degrees to hold the start pose\n", name(joint), degrees(angle));
  text += "\n" + against_b_text(comparison);
  return text +
         "\nover 1 deg, p99.9, max: how far joints lie outside the human range, every step, before any "
         "clean-up\n"
         "apart: joint separation; gain: energy without cause; exploded: diverged, gain above 1000 J or "
         "apart "
         "above 200 mm\n"
         "spin: angular momentum in the second after the hit, in air: time without ground contact, "
         "turning: RMS angular velocity of the segments in that second; means of the hits that did not "
         "explode\n"
         "a: each axis on its own; b: chords of the polygon, as exact rows, -euler: as stops of Euler "
         "angles;\n"
         "c: b and active restriction, k = 20 1/s, -k1: k = 1; ours: the default bake, -limp: without tone "
         "and damping\n";
}

}  // namespace ukemi
