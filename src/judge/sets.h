// Criteria of several bakes of one character: what no single clip shows.
#pragma once

#include <vector>

#include "judge/judgement.h"

namespace ukemi {

/// A bake of a set.
struct SetMember {
  Judgement judgement;
  double momentum_n_s = 0.0;  // scaled to a man of 78 kg and 1.78 m
  double azimuth_deg = 0.0;   // where the blow came from: 0 front, 90 left, 180 back, 270 right
  bool knock_out = false;
};

/// The criteria by number; one that no member of the set bears on is neither passed nor failed.
///  1. Up to 6 N s, and up to 10 from behind and the side: all keep their feet where they are; at 10 N s from
///     the front half or more.
///  3. At 20 to 25 N s from the front, 30 from elsewhere: one to three steps (from the side at most two).
///     At 60 to 80 N s: two to five steps or a fall; at 150: a fall.
/// 13. Pelvis contact at 0.3 to 2.8 m/s each, at 1.3 to 2.4 in the mean (knock-outs at 1.0 to 3.6).
/// 14. In a third of the falls the head stays off the floor.
/// 15. In two thirds of the falls a hand is down within -0.40 and +0.15 s of the pelvis, with the elbow
///     at 115 to 145 degrees in the mean.
/// 16. Forward: a knee is down 0.05 to 0.35 s before the pelvis in 70 %.
std::vector<Criterion> set_criteria(const std::vector<SetMember>& members);

/// 22: until 0.08 s after the blow every joint is within 1 cm of that of the limp body, later than 0.15 s one
/// is not.
Criterion latency_criterion(const JudgedMotion& living, const JudgedMotion& limp, double impact_s);

/// 23: of ten or so seeds of one blow that makes the body step: standard deviation of the first lift-off 15
/// to 60 ms, of the first length 3 to 10 cm; each foot goes first in a fifth or more.
Criterion spread_criterion(const std::vector<Judgement>& seeds);

}  // namespace ukemi
