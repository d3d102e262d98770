// The stages in a row: a character and an impact in, a clip, its pictures and its report out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "body/body.h"
#include "export/export.h"
#include "humanoid/humanoid.h"
#include "render/render.h"
#include "resample/resample.h"
#include "restrict/range_of_motion.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Everything that one bake may be told. Defaults are the program's.
struct BakeSettings {
  // hit
  std::string hit = "chest";        // segment
  std::string from = "front";       // front back left right above or AZIMUTH[,ELEVATION] degrees
  std::string preset = "medicine-ball";  // assets/impacts/presets.toml
  std::optional<double> ball_mass_kg, ball_speed_m_s, ball_radius_m;
  std::optional<std::string> scene;  // ball, push, impulse; from the preset unless given
  // body
  std::optional<double> mass_kg;
  Sex sex = Sex::male;
  HumanoidOptions humanoid;
  // start
  std::optional<std::string> pose;  // rest, stand, guard
  std::optional<std::string> clip;  // name of a clip of the file
  std::optional<double> at_s;
  // method
  std::string region = "human";
  SimulationSettings simulation;
  // clip
  bool until_rest = true;           // trim the still tail
  double hold_s = 0.25;             // kept of it
  KeyReduction keys;
  // out
  std::vector<std::filesystem::path> outputs;
  std::optional<double> bvh_metres_per_unit;
  std::filesystem::path sheet;      // empty: none
  std::filesystem::path report;     // empty: none
};

struct BakeTimings {
  double load = 0, simulate = 0, resample = 0, export_ = 0, render = 0, total = 0;
};

/// What a bake made, before anything is written.
struct BakeOutcome {
  Humanoid humanoid;
  ArticulatedBody body;
  RangeOfMotion range;              // in force: widened joints included
  std::vector<std::pair<Joint, double>> widened;  // radians
  Pose start;
  StartState state;
  Scene scene;
  SimulationResult simulation;
  Clip clip;
  ResampleError resample_error;
  BakeTimings timings_s;
};

/// Runs the stages on a loaded character. Errors: those of the stages.
Result<BakeOutcome> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics);

/// Loads, bakes and writes every output; the report as JSON text (format 1). Nothing is written when anything fails
/// before the first write.
Result<std::string> bake_file(const std::filesystem::path& character, const BakeSettings& settings,
                              Diagnostics& diagnostics);

}  // namespace ukemi
