// The judgement of a clip as the motion of a person: events, criteria with their bands, score.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "judge/events.h"
#include "judge/judged_motion.h"

namespace ukemi {

/// Times are those of the motion's frames.
struct JudgeSettings {
  std::optional<double> impact_s;      // of the blow; default: found, see find_blow
  std::optional<double> from_s, to_s;  // what is judged; default: from the impact to the last frame
  std::optional<double> momentum_n_s;  // of the blow; default: unknown
  std::optional<Segment> hit;          // where it landed; default: unknown
  std::optional<ReactionKind> kind;    // default: found
  bool knock_out = false;              // the body does not protect itself
};

/// Legal values, both ends included.
struct Band {
  double low = 0.0;
  double high = 0.0;  // infinite: no upper end
};

/// A value with its band; one that does not exist lies outside.
struct Clause {
  std::string_view name;
  std::optional<double> value;
  Band band;

  bool holds() const { return value && *value >= band.low && *value <= band.high; }
};

/// Numbered as the criteria of a clip are everywhere: 2, 4 to 12, 14 to 21. Those that are missing belong to
/// a set of clips, see sets.h.
struct Criterion {
  int number = 0;
  std::string_view name;
  std::vector<Clause> clauses;
  std::optional<bool> passed{};  // nothing where the criterion does not apply
};

struct Judgement {
  ReactionKind kind = ReactionKind::stand;
  JudgedOutcome outcome = JudgedOutcome::stood;
  JudgedPose final_pose = JudgedPose::standing;
  double impact_s = 0.0;
  bool impact_found = false;  // the time of the blow was found, not given
  std::vector<Step> steps;    // before a fall, or of a body that stays up
  std::optional<FallEvents> fall;
  std::optional<GetUpEvents> get_up;
  std::vector<Criterion> criteria;  // by number
  double score = 0.0;               // passed over applicable criteria
};

/// Of the criteria that apply, how many pass; 1 where none applies.
double score_of(const std::vector<Criterion>& criteria);

/// The criterion of that number; null where there is none.
const Criterion* find_criterion(const Judgement& judgement, int number);

}  // namespace ukemi
