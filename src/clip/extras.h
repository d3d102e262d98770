// What is added to the extras of a baked animation (see animation_extras in frames.h).
#pragma once

#include <string>
#include <string_view>

namespace ukemi {

/// The extras with "fps", the frame rate of the bake, for which glTF has no place. `extras_json` is as
/// animation_extras writes it.
std::string with_fps(std::string_view extras_json, double fps);

}  // namespace ukemi
