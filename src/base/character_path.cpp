#include "base/character_path.h"

#include "base/files.h"

namespace ukemi {

Result<std::filesystem::path> character_path(const std::string& character) {
  if (character == "mannequin") return find_asset("characters/mannequin.glb");
  return std::filesystem::path(character);
}

}  // namespace ukemi
