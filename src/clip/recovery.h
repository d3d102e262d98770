// What stands behind the simulated part of a clip: the way back to a pose or clip.
#pragma once

#include <optional>

#include "clip/timeline.h"

namespace ukemi {

/// What a clip goes back to: the start pose, or what the start clip plays by then.
enum class RecoverTo { stance, rest, clip };  // stance: to nothing, the body stays as it stands

struct Return {
  RecoverTo where = RecoverTo::rest;
  /// What of the start clip the figure does already at the end, s from the blow; nothing: what the clip would
  /// play by then.
  std::optional<double> moment_s;
};

/// Blends from the last frame, with its velocities, to `to` in `seconds` (rounded up to whole frames).
/// The figure recovers where it stands and keeps its feet; at the end of a clip it is where it would be
/// without the blow. Errors: usage (it lies, sits or kneels: no blend gets a body up). The lowest skin point
/// goes evenly from its height to that of the pose or clip, so that nothing sinks into the floor or floats.
Status add_recovery(const Actor& actor, double seconds, const Return& to, double gravity, Timeline& timeline);

}  // namespace ukemi
