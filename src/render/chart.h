// Values on a logarithmic scale: one line per row, one panel per quantity.
#pragma once

#include <string>
#include <vector>

#include "render/render.h"

namespace ukemi {

struct ChartPanel {
  std::string title;
  std::string unit;
  std::vector<double> values;  // one per row, at least 0; 0 stands left of the scale
};

struct Chart {
  std::string title;
  std::vector<std::string> notes;
  std::vector<std::string> rows;
  std::vector<bool> strong;  // rows drawn in the accent colour
  std::vector<ChartPanel> panels;
};

/// Contract: every panel has as many values as there are rows. Errors: output, when a font is missing.
Result<Picture> render_chart(const Chart& chart);

}  // namespace ukemi
