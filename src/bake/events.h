// The times of a clip's events, as a file of its own beside the clip.
#pragma once

#include <string>

#include "base/animation.h"

namespace ukemi {

/// JSON, format 1 (assets/schemas/events.schema.json): the clip's name, length, frames per second, and its
/// marks in order of time. The same marks are in the extras of a glTF.
std::string events_json(const Clip& clip);

}  // namespace ukemi
