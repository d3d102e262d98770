// What is in a file: skeleton, humanoid map, units, clips, and whether its poses are humanly possible.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"
#include "judge/rom_figures.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

enum class Verdict { humanoid, not_humanoid, malformed };
std::string_view name(Verdict verdict);  // "humanoid", "not-humanoid", "malformed"
/// 0 humanoid, 1 not a humanoid, 2 malformed.
int exit_status(Verdict verdict);

struct ClipInspection {
  std::string name;
  double duration_s = 0.0;
  long frames = 0;
  double fps = 0.0;               // see native_rate; 0 for a single key
  std::optional<RomFigures> rom;  // of a humanoid
};

struct Inspection {
  Verdict verdict = Verdict::malformed;
  std::string reason;          // of the verdict
  std::optional<Error> error;  // what loading or mapping answered
  std::optional<Character> character;
  std::optional<Humanoid> humanoid;
  std::optional<RomFigures> rest;
  std::vector<ClipInspection> clips;
};

struct InspectSettings {
  HumanoidOptions humanoid;
  std::string region = "human";
};

/// `file` may be "mannequin". A file that cannot be loaded is malformed, not an error. Errors: the region's.
Result<Inspection> inspect(const std::string& file, const InspectSettings& settings,
                           Diagnostics& diagnostics);

/// `inspect --json`, format 1.
std::string inspection_json(const Inspection& inspection, const Diagnostics& diagnostics);
/// For people.
std::string inspection_text(const std::string& file, const Inspection& inspection);

}  // namespace ukemi
