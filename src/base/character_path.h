// The characters that commands name.
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace ukemi {

/// "mannequin" is the program's own character, everything else a file.
Result<std::filesystem::path> character_path(const std::string& character);

}  // namespace ukemi
