// The clips of a file by name.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

/// True where a file is motion alone: a BVH with frames, or no mesh, no skin and a single animation.
bool is_motion_only(const Character& character);

/// The clip's name, or "#INDEX" where it has none.
std::string clip_label(const Character& character, std::size_t clip);

/// Index of the clip of that name (the first of equals) or "#INDEX". Errors: usage, with the nearest name.
Result<std::size_t> find_clip(const Character& character, std::string_view name);

}  // namespace ukemi
