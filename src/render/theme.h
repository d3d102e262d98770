// Colours of a picture, light or dark.
#pragma once

#include "render/canvas.h"
#include "render/geometry.h"

namespace ukemi {

struct Theme {
  // the page
  Color page, panel, border, ink, soft_ink, accent, on_accent;
  // the stage
  Rgba background, ground, line;
};

const Theme& theme(ThemeKind kind);

}  // namespace ukemi
