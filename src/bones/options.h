// What the user says about a character.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace ukemi {

struct HumanoidOptions {
  std::map<std::string, std::string> map;  // segment name -> node label, from the user
  std::string root{};  // node label: of several figures the one at or below it; empty: the first
  std::optional<double> metres_per_unit;
  std::optional<char> up_axis;  // 'y' or 'z'
  std::optional<double> height_m;
  /// Of a file with only motion: the neutral pose is corrected by how the person moves (refine.h), because
  /// capture suits and marker sets put trunk and hands askew. False: it is that of the rest pose.
  bool neutral_from_motion = true;
};

}  // namespace ukemi
