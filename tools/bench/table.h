// What samples say together: the table, its JSON, and one build against another.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "sample.h"

namespace ukemi {

/// What was measured.
struct Measured {
  std::string character;
  int hits = 0;
  double duration_s = 0.0;
  std::vector<Sample> samples;
};

/// A mean ratio with the ends of its 95 % interval.
struct Ratio {
  int pairs = 0;
  double value = 1.0, low = 1.0, high = 1.0;
};

/// Sum of `cost` over sum of `reference`, number by number; the interval is that of a ratio of means
/// (1.96 standard errors). Contract: of the same length; references above 0.
Ratio ratio_of_sums(const std::vector<double>& cost, const std::vector<double>& reference);
/// Geometric mean of cost / reference; the interval is that of the mean of the logarithms.
Ratio mean_ratio(const std::vector<double>& cost, const std::vector<double>& reference);

/// A line per row, its cost a ratio to the reference of the same hits.
std::string table_text(const Measured& measured);
/// Format 1: the same figures, and every sample.
std::string table_json(const Measured& measured);
/// Errors: input (no such file, no bench's JSON).
Result<Measured> measured_in(const std::string& file);

/// CPU time of `ours` over that of `theirs`, run by run of the same hits; `relative`: each over its own
/// reference, for runs that were not interleaved. Rows are those of ours.
std::string comparison_text(const std::vector<Sample>& ours, const std::vector<Sample>& theirs,
                            bool relative);

}  // namespace ukemi
