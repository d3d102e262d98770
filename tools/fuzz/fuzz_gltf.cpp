// The glTF reader: container, document, accessors, meshes, skins, animations.
#include "fuzz/checks.h"
#include "load/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  Diagnostics diagnostics;
  const auto character = read_gltf({data, size}, "folder/input.glb", diagnostics);
  if (character)
    fuzz::require_sound(*character);
  else
    fuzz::require_clear(character.error());
  return 0;
}
