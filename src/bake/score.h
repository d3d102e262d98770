// How much like a person's the answer to a blow is.
#pragma once

#include "bake/baked.h"
#include "base/character.h"
#include "prepare/settings.h"

namespace ukemi {

/// Score of a baked clip from the blow to where it begins to recover, see judge/judge.h.
double human_score(const Character& character, const BakedClip& baked);

}  // namespace ukemi
