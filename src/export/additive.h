// Clips as differences, for engines that add them to whatever plays.
#pragma once

#include "export/export.h"

namespace ukemi {

/// The clip's difference from a pose, node by node and in local axes: rotation pose^-1 * value, translation
/// value - pose, scale value / pose. What does not differ has no track. An engine adds it as rotation *
/// delta, translation + delta, scale * delta (AnimationUtils.makeClipAdditive of three.js, additive layers of
/// Unity). Interpolation between keys is the same as in the whole clip.
ReducedClip additive(const ReducedClip& clip, const Pose& pose);

}  // namespace ukemi
