// Whether a clip moves like a person: criteria of hits, falls and get-ups, from where the joints are over
// time.
#pragma once

#include "judge/judgement.h"

namespace ukemi {

/// Criteria by kind: standing 2, 4 to 11, 20, 21; falls 11, 12, 14 to 18, 20, 21, and 19 where the person
/// gets up again; get-ups 19 to 21. Bands are those of captured people, of 53 hits, 25 falls and 11 get-ups,
/// and of published measurements. Lengths are scaled to a man of 1.75 m, momenta to one of 78 kg and 1.78 m.
Judgement judge(const JudgedMotion& motion, const JudgeSettings& settings = {});

}  // namespace ukemi
