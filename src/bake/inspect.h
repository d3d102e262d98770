// What is in a file: skeleton, humanoid map, units, clips, and whether its poses are humanly possible.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

enum class Verdict { humanoid, not_humanoid, malformed };
std::string_view name(Verdict verdict);  // "humanoid", "not-humanoid", "malformed"
/// 0 humanoid, 1 not a humanoid, 2 malformed.
int exit_status(Verdict verdict);

/// Bones do not tell how the segments inside them are rolled about their length; a choice of rolls for a
/// whole clip is one reading of it.
enum class Rolls {
  canonical,    // in every frame like a human body (canonical_segments_of)
  first_frame,  // like a human body in the first frame, from then on fixed to the nodes, as a bake leaves
                // them
};
std::string_view name(Rolls rolls);  // "canonical", "first-frame"

/// How far poses lie outside the range of motion, over all joints that move, in the reading that fits better.
struct RomFigures {
  double over_1deg_fraction = 0.0;
  double over_5deg_fraction = 0.0;
  double excess_max_deg = 0.0;
  std::optional<Joint> worst_joint;
  Rolls rolls = Rolls::canonical;
};

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

/// Frames per second of an animation: the file's, or that of its closest keys (a reduced clip leaves keys
/// out).
double native_rate(const Animation& animation);

RomFigures rom_figures(const Skeleton& skeleton, const Humanoid& humanoid, const RangeOfMotion& range,
                       const std::vector<Pose>& poses);

/// `file` may be "mannequin". A file that cannot be loaded is malformed, not an error. Errors: the region's.
Result<Inspection> inspect(const std::string& file, const InspectSettings& settings,
                           Diagnostics& diagnostics);

/// `inspect --json`, format 1.
std::string inspection_json(const Inspection& inspection, const Diagnostics& diagnostics);
/// For people.
std::string inspection_text(const std::string& file, const Inspection& inspection);

}  // namespace ukemi
