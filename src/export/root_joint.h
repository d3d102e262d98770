// A joint above the hips, for the motion over the ground.
#pragma once

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

/// The character with a joint "root" at the ground between the hips and their parent, at the end of its nodes
/// and of its document's, and at the end of the joints of every skin that has bones below it (unweighted,
/// bound where it rests). Errors: input (a document that takes no joint).
Result<Character> with_root_joint(const Character& source, int hips);

}  // namespace ukemi
