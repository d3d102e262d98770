// The criteria of one clip, each with its band. Sources: medians and spreads of captured hits, falls and
// get-ups; [1] Choi 2015, J Biomech 48:911 (falls on video); [2] Thelen 1997, J Gerontol 52:M8 (largest lean
// caught by a step); [3] Hof 2010, JEB 213:2655, and 2005 (extrapolated centre of mass); [4] Hsiao and
// Robinovitch 1998, J Biomech 31:1 (hands and pelvis); [5] DeGoede and Ashton-Miller 2002, J Biomech 35:843
// (elbows); [6] Bohannon and Lusardi 2004 (floor to standing).
#pragma once

#include <vector>

#include "judge/judgement.h"

namespace ukemi {

/// What the criteria of a clip are read from.
struct Evidence {
  const JudgedMotion& motion;
  const BodyCourse& body;
  const JudgeSettings& settings;
  Window window;  // from the blow on

  /// Momentum of the blow, scaled to a man of 78 kg and 1.78 m; nothing where it is unknown.
  std::optional<double> momentum_n_s() const;
};

/// Criteria 2 and 4 to 10; `steps` in the window.
std::vector<Criterion> standing_criteria(const Evidence& evidence, const std::vector<Step>& steps);
/// Criteria 12 and 14 to 18.
std::vector<Criterion> fall_criteria(const Evidence& evidence, const FallEvents& fall);
/// Criterion 19.
Criterion get_up_criterion(const BodyCourse& body, const Window& window, const GetUpEvents& get_up);
/// Criterion 11: from the blow to the pelvis's contact or the end.
Criterion asymmetry_criterion(const BodyCourse& body, const Window& window);
/// Criterion 20: joint speeds over the window.
Criterion joint_speed_criterion(const JudgedMotion& motion, const Window& window);

/// What a window of the motion shows.
struct Phase {
  ReactionKind kind;
  Window window;
};
/// Criterion 21: each phase's jerk as a share of what it may be; the highest.
Criterion jerk_criterion(const BodyCourse& body, const std::vector<Phase>& phases);

/// A criterion that applies: passed where every clause holds.
Criterion judged(int number, std::string_view name, std::vector<Clause> clauses);
Criterion not_applicable(int number, std::string_view name);

}  // namespace ukemi
