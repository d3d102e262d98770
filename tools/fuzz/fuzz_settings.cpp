// Settings in words, one NAME=VALUE a line, as a command line has them; a living body then has ten steps
// under those that are about the blow and the behaviour.
#include <array>
#include <string>
#include <string_view>

#include "bake/bake.h"
#include "base/character_path.h"
#include "fuzz/checks.h"
#include "load/load.h"
#include "prepare/prepared.h"
#include "prepare/setting_table.h"

namespace {

using namespace ukemi;

constexpr double kTenSteps_s = 10.0 / 240.0;

const Character& mannequin() {
  static const Character character = [] {
    Diagnostics diagnostics;
    return *load_character(*character_path("mannequin"), {}, diagnostics);
  }();
  return character;
}

/// Names files, which a fuzzer must not open.
bool names_a_file(std::string_view name) {
  constexpr std::array kFiles{"map", "pose", "clip", "region", "active-file", "root"};
  for (const std::string_view file : kFiles)
    if (name == file) return true;
  return false;
}

/// What is in force, said in words, is taken again and says the same.
void require_round_trip(const Setting& setting, const BakeSettings& settings) {
  const std::vector<std::string> words = setting.get(settings);
  BakeSettings again;
  for (const std::string& word : words)
    fuzz::require(static_cast<bool>(setting.set(again, word)), "a value in force is taken");
  fuzz::require(setting.get(again) == words, "and says the same");
}

/// NAME=VALUE, or nothing where it is refused.
void take(std::string_view line, BakeSettings& settings, BakeSettings& lived) {
  const auto equals = line.find('=');
  const auto setting = find_setting(line.substr(0, equals));
  if (!setting) return fuzz::require_clear(setting.error());
  const std::string value(equals == std::string_view::npos ? "" : line.substr(equals + 1));
  if (const Status status = (*setting)->set(settings, value); !status)
    return fuzz::require_clear(status.error());
  require_round_trip(**setting, settings);
  const std::string_view group = (*setting)->group;
  if (!names_a_file((*setting)->name) && (group == "hit" || group == "behaviour" || group == "body"))
    fuzz::require(static_cast<bool>((*setting)->set(lived, value)), "what was taken is taken again");
}

void live(BakeSettings settings) {
  Diagnostics diagnostics;
  settings.simulation.duration_s = kTenSteps_s;
  const auto prepared = prepare_bake(mannequin(), settings, diagnostics);
  if (!prepared) return fuzz::require_clear(prepared.error());
  const auto result =
      simulate(simulation_input(*prepared, prepared->scene, settings.simulation), diagnostics);
  if (!result) return fuzz::require_clear(result.error());
  for (const BodyPose& frame : result->trajectory.frames)
    for (const Rigid& segment : frame)
      fuzz::require(segment.translation.allFinite() && segment.rotation.coeffs().allFinite(),
                    "every frame is finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  BakeSettings settings, lived;
  std::string_view text = fuzz::text_of(data, size);
  while (!text.empty()) {
    const auto end = text.find('\n');
    if (end != 0) take(text.substr(0, end), settings, lived);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  const Status status = check_values(settings);
  fuzz::require(static_cast<bool>(status), "what was taken is legal");
  live(lived);
  return 0;
}
