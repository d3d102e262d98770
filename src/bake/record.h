// What is remembered of a reaction that was baked: the same in the answers of workers, in the journal of a
// batch and, without what differs from run to run, in its manifest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/bake.h"

namespace ukemi {

struct ReactionFigures {
  double excess_max_deg = 0.0;  // over the range of motion, before projection
  long over_1deg = 0;           // samples
  double travel_m = 0.0;        // of the pelvis over the floor, from the first frame to the last
  double momentum_n_s = 0.0;    // of the blow
  std::optional<double> rest_time_s;
  double duration_s = 0.0;  // of the clip
  double joint_separation_max_m = 0.0;
  double energy_gain_max_j = 0.0;
  long frames = 0;
  long keys = 0;
};
ReactionFigures figures_of(const BakedFile& baked);

struct WrittenFile {
  std::string name;  // relative to the batch's folder
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct ReactionRecord {
  std::string character, name;             // folder, and name of the files
  std::string digest;                      // of the inputs
  std::optional<ReactionFigures> figures;  // of what was baked; nothing where it failed
  std::vector<WrittenFile> files;
  std::vector<std::string> warnings;
  std::string error, fix;     // why it failed
  bool cannot_write = false;  // the fault of the disk, not of the reaction
  double seconds = 0.0;       // that it took

  bool done() const { return figures.has_value(); }
};

/// One line of JSON, without its end.
std::string record_line(const ReactionRecord& record);
/// Nothing where the line is no record: a line that was cut off.
std::optional<ReactionRecord> parse_record(std::string_view line);

}  // namespace ukemi
