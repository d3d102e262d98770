// Tables whose cells are separated by tabs.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace ukemi {

inline std::vector<std::string> tab_separated(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
  return cells;
}

}  // namespace ukemi
