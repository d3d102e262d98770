// The BVH reader.
#include "fuzz/checks.h"
#include "load/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  Diagnostics diagnostics;
  const auto character = read_bvh(fuzz::text_of(data, size), "folder/input.bvh", diagnostics);
  if (character)
    fuzz::require_sound(*character);
  else
    fuzz::require_clear(character.error());
  return 0;
}
