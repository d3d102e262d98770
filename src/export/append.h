// Several reactions of one character in one file.
#pragma once

#include <filesystem>

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

/// The glTF file at `path`, which takes a further animation of `character`: its nodes are the character's, in
/// the same order (what a bake adds comes after them). Errors: input.
Result<Character> file_to_append_to(const std::filesystem::path& path, const Character& character);

}  // namespace ukemi
