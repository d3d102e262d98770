// A whole bake as a batch does it, stage by stage.
#pragma once

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

/// The character is loaded, nothing is drawn. Prints ms a bake.
Status measure_stages(const Character& character, int count);

}  // namespace ukemi
