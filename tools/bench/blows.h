// What the benches of behaviours share: their command lines, characters, momenta for bodies of any size.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/character_path.h"
#include "body/body.h"
#include "load/load.h"
#include "prepare/setting_table.h"

namespace ukemi {

/// The parts between commas.
inline std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

inline Status set(BakeSettings& settings, const std::string& name, const std::string& value) {
  const auto setting = find_setting(name);
  return setting ? (*setting)->set(settings, value) : Status(setting.error());
}

/// The arguments NAME=VALUE from the `first` on.
inline Status set_all(BakeSettings& settings, int argc, char** argv, int first) {
  for (int i = first; i < argc; ++i) {
    const std::string option = argv[i];
    const auto equals = option.find('=');
    const std::string value = equals == std::string::npos ? "" : option.substr(equals + 1);
    if (const Status status = set(settings, option.substr(0, equals), value); !status) return status;
  }
  return Done{};
}

inline Result<Character> load_named(const std::string& name, Diagnostics& diagnostics) {
  const auto path = character_path(name);
  if (!path) return path.error();
  return load_character(*path, LoadOptions{}, diagnostics);
}

/// N s that are to this body what `n_s` are to a man of 78 kg and 1.78 m.
inline double momentum_for(const ArticulatedBody& body, double n_s) {
  return n_s * body.mass_kg / 78.0 * std::sqrt(body.height_m / 1.78);
}

}  // namespace ukemi
