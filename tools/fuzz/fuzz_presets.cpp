// Impact presets as TOML.
#include <cmath>

#include "prepare/impact.h"
#include "fuzz/checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ukemi;
  const auto presets = parse_presets(fuzz::text_of(data, size), "input.toml");
  if (!presets) {
    fuzz::require_clear(presets.error());
    return 0;
  }
  for (const ImpactPreset& preset : *presets)
    for (const double number : {preset.mass_kg, preset.speed_m_s, preset.radius_m, preset.push_duration_s})
      fuzz::require(std::isfinite(number) && number > 0.0, "a preset's numbers are above 0");
  return 0;
}
