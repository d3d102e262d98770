// What is remembered of a reaction that was baked: the same in the answers of workers, in the journal of a
// batch and, without what differs from run to run, in its manifest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/baked.h"

namespace ukemi {

struct ReactionFigures {
  double excess_max_deg = 0.0;  // over the range of motion, before projection
  long over_1deg = 0;           // samples
  double travel_m = 0.0;        // of the pelvis over the floor, from the first frame to the last
  double momentum_n_s = 0.0;    // of the blow
  double score = 0.0;           // share of the criteria of human motion that the clip meets
  std::optional<double> rest_time_s;
  std::string outcome;   // stood, stepped, fell
  std::string end_pose;  // standing, kneeling, seated, supine, prone, left_side, right_side
  long steps = 0;
  double duration_s = 0.0;  // of the clip
  double joint_separation_max_m = 0.0;
  double energy_gain_max_j = 0.0;
  long frames = 0;
  long keys = 0;
};
ReactionFigures figures_of(const BakedFile& baked);

/// Calls visit(key, figure) for each, in the order and under the keys of files.
template <typename Figures, typename Visit>
void for_each_figure(Figures& figures, const Visit& visit) {
  visit("excess_max_deg", figures.excess_max_deg);
  visit("over_1deg", figures.over_1deg);
  visit("travel_m", figures.travel_m);
  visit("momentum_n_s", figures.momentum_n_s);
  visit("score", figures.score);
  visit("rest_time_s", figures.rest_time_s);
  visit("outcome", figures.outcome);
  visit("end_pose", figures.end_pose);
  visit("steps", figures.steps);
  visit("duration_s", figures.duration_s);
  visit("joint_separation_max_m", figures.joint_separation_max_m);
  visit("energy_gain_max_j", figures.energy_gain_max_j);
  visit("frames", figures.frames);
  visit("keys", figures.keys);
}

struct WrittenFile {
  std::string name;  // relative to the batch's folder
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct ReactionRecord {
  std::string character, name;             // folder, and name of the files
  std::string digest;                      // of the inputs and the program
  std::optional<ReactionFigures> figures;  // of what was baked; nothing where it failed
  std::string library;                     // its row, see library.h
  std::vector<WrittenFile> files;
  std::vector<std::string> warnings;
  std::string error, fix;     // why it failed
  bool cannot_write = false;  // the fault of the disk, not of the reaction
  double seconds = 0.0;       // that the bake took

  bool done() const { return figures.has_value(); }
};

/// One line of JSON, without its end.
std::string record_line(const ReactionRecord& record);
/// Nothing where the line is not a record: a line that was cut off, or names files outside the batch's
/// folder.
std::optional<ReactionRecord> parse_record(std::string_view line);

}  // namespace ukemi
