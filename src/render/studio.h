// A shot made ready to be drawn.
#pragma once

#include <memory>

#include "render/painter.h"
#include "render/staging.h"

namespace ukemi {

struct Studio {
  const Shot& shot;
  DrawnCharacter figure;
  JointPaths joints;
  std::unique_ptr<Painter> painter;

  /// All that a frame shows: figure, props, and the arrow of the blow where it is time for it.
  FrameGeometry geometry(int frame) const;
};

/// Everything but the painter. Contract: the shot outlives the studio. Errors: input (a clip without frames,
/// of another skeleton, with a joint that is not finite).
Result<Studio> study(const Shot& shot, const Overlays& overlays);
/// The painter, of pictures of the given size; one at a time may live. Errors: output when no off-screen
/// context can be made.
Status equip(Studio& studio, int width, int height);
/// Both.
Result<Studio> open_studio(const Shot& shot, const Overlays& overlays, int width, int height);

}  // namespace ukemi
