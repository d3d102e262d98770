// Clips as differences, for engines that add them to whatever plays.
#pragma once

#include <string_view>

#include "export/export.h"

namespace ukemi {

/// How a clip is written as a difference, if at all.
enum class Additive {
  off,
  identity,  // the difference alone: three.js, Babylon.js
  rest,      // on top of the rest pose: Godot 4, Flax
};
std::string_view name(Additive form);

/// The clip's difference from a pose, node by node and in local axes: rotation pose^-1 * value, translation
/// value - pose, scale value / pose. What does not differ has no track. An engine adds it as rotation *
/// delta, translation + delta, scale * delta (AnimationUtils.makeClipAdditive of three.js, additive layers of
/// Unity). Interpolation between keys is the same as in the whole clip.
ReducedClip additive(const ReducedClip& clip, const Pose& pose);

/// A difference on top of the rest pose: rotation rest * delta, translation rest + delta, scale rest * delta.
/// Engines that take an animation for poses and subtract the rest pose from it to add it need this form.
ReducedClip on_rest(const ReducedClip& difference, const Skeleton& skeleton);

}  // namespace ukemi
