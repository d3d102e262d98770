// How often a clip says something new.
#pragma once

#include "base/animation.h"
#include "base/character.h"

namespace ukemi {

/// Frames per second of an animation: the file's, or that of its closest keys (a reduced clip leaves keys
/// out), except for one in 500: some exporters add keys between frames.
double native_rate(const Animation& animation);

}  // namespace ukemi
