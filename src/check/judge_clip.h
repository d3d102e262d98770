// A clip of a file judged as the motion of a person.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "humanoid/humanoid.h"
#include "judge/judgement.h"

namespace ukemi {

struct JudgeClipSettings {
  std::string file;  // FILE, or FILE#CLIP with the clip's name or index; its last clip unless told
  HumanoidOptions humanoid;
  std::optional<double> mass_kg;  // default: that of a man of the figure's height
  JudgeSettings judge;            // default impact: the one that a bake wrote into the clip
};

struct JudgedClip {
  std::string file, clip;
  double fps = 0.0;  // rate of the judgement: the clip's, at least 60, at most 120
  double duration_s = 0.0;
  double height_m = 0.0, mass_kg = 0.0;
  Judgement judgement;
};

/// Errors: usage (unknown clip, times outside the clip), input (the file's, no humanoid, no clip, an additive
/// clip).
Result<JudgedClip> judge_clip(const JudgeClipSettings& settings, Diagnostics& diagnostics);

/// `judge --json`, format 1: assets/schemas/judge.schema.json.
std::string judgement_json(const JudgedClip& judged, const Diagnostics& diagnostics);
/// For people.
std::string judgement_text(const JudgedClip& judged);

}  // namespace ukemi
