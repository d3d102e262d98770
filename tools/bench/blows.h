// What the benches of behaviours share: lists on their command lines, momenta for bodies of any size.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "body/body.h"

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

/// N s that are to this body what `n_s` are to a man of 78 kg and 1.78 m.
inline double momentum_for(const ArticulatedBody& body, double n_s) {
  return n_s * body.mass_kg / 78.0 * std::sqrt(body.height_m / 1.78);
}

}  // namespace ukemi
