// Ranges of motion as TOML.
#include "fuzz/checks.h"
#include "restrict/range_of_motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  const auto range = parse_range_of_motion(fuzz::text_of(data, size), "input.toml");
  if (range)
    fuzz::require_sound(*range);
  else
    fuzz::require_clear(range.error());
  return 0;
}
