// Options of pictures that several commands have.
#pragma once

#include <string>

#include "base/result.h"
#include "render/render.h"

namespace ukemi {

/// light or dark. Errors: usage.
Status take_theme(const std::string& text, ThemeKind& theme);

}  // namespace ukemi
