// The stages in a row: a character and an impact in, a clip, its pictures and its report out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/character.h"
#include "base/files.h"
#include "base/result.h"
#include "behave/behaviour.h"
#include "body/body.h"
#include "body/muscles.h"
#include "clip/resample.h"
#include "clip/start.h"
#include "export/export.h"
#include "humanoid/humanoid.h"
#include "render/render.h"
#include "restrict/range_of_motion.h"
#include "simulate/simulate.h"

namespace ukemi {

/// What a clip goes back to, see add_recovery: the start pose, or what the start clip plays by then.
enum class RecoverTo { rest, clip };

/// What takes the motion over the ground: the hips as simulated, a root joint above them, or nothing.
enum class RootMotion { hips, root, in_place };

/// Everything that one bake may be told. Defaults are the program's.
struct BakeSettings {
  // hit
  std::string hit = "chest";             // segment
  std::string from = "front";            // front back left right above or AZIMUTH[,ELEVATION] degrees
  std::string preset = "medicine-ball";  // assets/impacts/presets.toml
  std::optional<double> ball_mass_kg, ball_speed_m_s, ball_radius_m;
  std::optional<std::string> scene;         // ball slope fall push impulse box; from the preset unless given
  double strength = 1.0;                    // of the blow: times its momentum
  double aim_up_m = 0.0, aim_left_m = 0.0;  // ball, box: from the segment's centre, as the blow sees it
  double fall_height_m = 0.0;               // fall: so high above the floor
  double tip_speed_m_s = 0.8;               // fall: of the centre of mass
  double slope_deg = 20.0;                  // slope: of the ramp
  // body
  std::optional<double> mass_kg;
  Sex sex = Sex::male;
  HumanoidOptions humanoid;
  // start
  std::optional<std::string> pose;  // rest, stand, guard
  std::optional<std::string> clip;  // name of a clip of the file
  std::optional<double> at_s;
  // behaviour
  std::optional<Behaviour> behaviour;  // unless given: alert, limp with fixed steps
  double most_steps = 6;               // of a recovery
  double muscle = 1.0;                 // strength, of a healthy adult's
  std::optional<double> latency_s;     // unless given: the behaviour's
  double seed = 0;                     // varies stance, latency, arms and steps; 0: the mean of all
  // method
  std::string region = "human";        // name or file, see load_range_of_motion
  std::optional<RangeOfMotion> range;  // in place of the region's
  SimulationSettings simulation;
  std::string active_file;  // thresholds of the active restriction; empty: assets/limits/active.toml
  // clip
  bool until_rest = true;  // trim the still tail
  double hold_s = 0.25;    // kept of it
  double lead_s = 0.0;     // of the start, before the impact
  std::optional<double> recover_s;
  RecoverTo recover_to = RecoverTo::rest;
  RootMotion root_motion = RootMotion::hips;
  bool align = false;               // starts at the origin, facing +z
  bool additive = false;            // difference from the first frame
  bool extra_bones_play = false;    // bones of no segment play the start clip on
  std::optional<double> smooth_hz;  // cut-off of a zero-phase filter
  KeyReduction keys;
  // out
  bool append = false;   // to the clips that an output holds
  std::string reaction;  // name of the clip; empty: SEGMENT_FROM
  std::vector<std::filesystem::path> outputs;
  bool clip_only = false;  // glTF without the mesh
  std::optional<double> bvh_metres_per_unit;
  std::filesystem::path sheet;         // empty: none
  std::filesystem::path preview;       // moving; empty: none
  ThemeKind theme = ThemeKind::light;  // of the pictures
  std::filesystem::path report;        // empty: none
};

/// Wall-clock seconds.
struct BakeTimings {
  double load = 0, simulate = 0, resample = 0, export_ = 0, render = 0, total = 0;
};

/// What a bake made, before anything is written.
struct BakeOutcome {
  std::string reaction;  // "head_left": name of the clip
  Humanoid humanoid;
  Start start;
  ArticulatedBody body;
  RangeOfMotion range;                            // in force: widened joints included
  std::vector<std::pair<Joint, double>> widened;  // radians
  Scene scene;
  ActiveThresholds thresholds;  // of the active restriction
  MuscleStrength strength;
  BehaviourSettings behaviour;
  SimulationResult simulation;     // trajectory above a floor at y = 0, its still tail trimmed, lead
                                   // and recovery added
  Clip clip;                       // where the file places the figure; a frame per frame of the trajectory
  double impact_s = 0.0;           // in the clip
  double ground_lift_max_m = 0.0;  // how far frames were raised so that the skin stays above the floor
  ResampleError resample_error;
  BakeTimings timings_s;
};

struct OutputFile {
  std::filesystem::path path;
  std::vector<std::uint8_t> bytes;
};

/// A bake with its files, and the report on it.
struct BakedFile {
  BakeOutcome outcome;
  ReducedClip reduced;
  std::vector<Vec3> root_curve;   // see ExportedClip
  std::vector<OutputFile> files;  // clips and pictures
  std::string report;             // JSON, format 1
};

/// The name a bake's clip gets: that of the settings, else SEGMENT_FROM.
std::string reaction_name(const BakeSettings& settings);

/// What is wrong with the settings, told without a character: words, numbers, outputs (extension, folder,
/// twice the same). Errors: usage, output.
Status check_settings(const std::string& character, const BakeSettings& settings);

/// What the simulation is given: everything of a bake but its simulation, clip and timings. Errors: those of
/// the stages.
Result<BakeOutcome> prepare_bake(const Character& character, const BakeSettings& settings,
                                 Diagnostics& diagnostics);

/// The behaviour in force.
BehaviourSettings behaviour_settings(const BakeSettings& settings);

/// What the simulation of a prepared bake is given.
SimulationInput simulation_input(const BakeOutcome& prepared, const Scene& scene,
                                 const SimulationSettings& settings);

/// Runs the stages on a loaded character. Errors: those of the stages.
Result<BakeOutcome> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics);

/// Bakes a loaded character and makes every file that the settings name; nothing is written, the report not
/// made. Errors: those of the stages.
Result<BakedFile> bake_loaded(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics);

/// Lays the files beside their targets and counts the time. Errors: output.
Status add_files(BakedFile& baked, PendingFiles& files);

/// Writes the clips and the pictures of a bake. Errors: output.
Status write_files(BakedFile& baked);

/// Loads, bakes and writes every output. `character` is a file or "mannequin". Nothing is written when
/// anything fails before the first write.
Result<BakedFile> bake_file(const std::string& character, const BakeSettings& settings,
                            Diagnostics& diagnostics);

}  // namespace ukemi
