#include "cli/character_options.h"

#include <fmt/format.h>

#include <utility>

#include "bake/impact.h"
#include "bake/nearest.h"

namespace ukemi {
namespace {

constexpr Range kUnitRange{0.0, 1e6, true};
const std::vector<std::pair<std::string, double>> kUnits = {{"m", 1.0},    {"dm", 0.1},    {"cm", 0.01},
                                                            {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};

Error usage(std::string what, std::string fix) {
  return {ErrorKind::usage, "", 0, 0, "", std::move(what), std::move(fix)};
}

Status take_map(HumanoidOptions& target, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size())
    return usage(fmt::format("--map: '{}' is not SEGMENT=NODE", text),
                 "write --map head=NodeName or --map head=#12");
  const std::string segment = text.substr(0, equals);
  if (const auto known = parse_segment(segment); !known)
    return usage("--map: " + known.error().what, known.error().fix);
  if (!target.map.emplace(segment, text.substr(equals + 1)).second)
    return usage(fmt::format("--map gives '{}' two nodes", segment), "give each segment one node");
  return Done{};
}

Status take_unit(HumanoidOptions& target, const std::string& text) {
  std::vector<std::string> names;
  for (const auto& [name, metres] : kUnits) {
    if (name == text) {
      target.metres_per_unit = metres;
      return Done{};
    }
    names.push_back(name);
  }
  const auto metres = parse_number("--unit", text, kUnitRange);
  if (!metres)
    return usage(fmt::format("--unit: '{}' is no unit", text),
                 "give m, dm, cm, mm, in, ft, or metres per unit");
  target.metres_per_unit = *metres;
  return Done{};
}

}  // namespace

void declare_humanoid_options(Options& options, HumanoidOptions& target) {
  options.custom(
      "--map", "SEGMENT=NODE", [&target](const std::string& text) { return take_map(target, text); },
      "node that moves a segment, by its name or #INDEX, where the program finds another or none", true);
  options.custom(
      "--unit", "UNIT", [&target](const std::string& text) { return take_unit(target, text); },
      "length unit of the file: m, dm, cm, mm, in, ft, or metres per unit [default: found out]");
  options.custom(
      "--up", "y|z",
      [&target](const std::string& text) -> Status {
        if (text != "y" && text != "z")
          return usage(fmt::format("--up: '{}' is no up axis", text), "give y or z");
        target.up_axis = text.front();
        return Done{};
      },
      "up axis of the file [default: found out]");
  options.number("--height", "M", target.height_m, Range{0.05, 50.0},
                 "height of the character, sole to crown [default: found out]");
}

}  // namespace ukemi
