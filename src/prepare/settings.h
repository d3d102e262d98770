// What one bake is asked for, as values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/segments.h"
#include "behave/behaviour.h"
#include "body/body.h"
#include "clip/recovery.h"
#include "clip/root_motion.h"
#include "export/additive.h"
#include "humanoid/humanoid.h"
#include "prepare/direction.h"
#include "render/render.h"
#include "restrict/range_of_motion.h"
#include "rise/get_up.h"
#include "simulate/simulate.h"

namespace ukemi {

/// What a director wants to become of the body.
enum class Wanted { stand, fall };
/// Arms that hold something: they neither swing nor catch the body.
enum class HoldingArms { none, left, right, both };

/// Everything that one bake may be told. Defaults are the program's.
struct BakeSettings {
  // hit
  Segment hit = Segment::chest;
  Direction from;
  std::string preset = "medicine-ball";  // assets/impacts/presets.toml
  std::optional<double> ball_mass_kg, ball_speed_m_s, ball_radius_m;
  std::optional<SceneKind> scene;           // the preset's unless given
  double strength = 1.0;                    // of the blow: times its momentum
  double aim_up_m = 0.0, aim_left_m = 0.0;  // ball, box: from the segment's centre, as the blow sees it
  double fall_height_m = 0.0;               // fall: start height above the floor
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
  std::optional<double> ground_speed_m_s;  // of a clip that walks on the spot; unless given: found out
  // behaviour
  std::optional<Behaviour> behaviour;  // unless given: alert, limp with fixed steps
  double most_steps = 6;               // of a recovery
  std::optional<Wanted> outcome;       // reached by search; unless given: what physics decides
  std::optional<double> search;        // trials at most; unless given: 5 with an outcome, else 1
  bool assist = false;                 // a force from outside may help towards the outcome
  HoldingArms arms = HoldingArms::none;
  double muscle = 1.0;               // strength, of a healthy adult's
  std::optional<Knockout> knockout;  // alive until then
  bool breathes = true;              // of a living body that lies still
  std::optional<double> latency_s;   // unless given: the behaviour's
  std::optional<double> get_up_s;    // gets up after lying for this time; unless given: stays down
  GetUpStyle get_up_style = GetUpStyle::plain;
  std::string get_up_clip;  // FILE, FILE#NAME or a folder of clips that lead the get-up; empty: planned
  double seed = 0;          // varies stance, latency, arms and steps; 0: the mean of all
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
  GroundPlacement ground;
  Additive additive = Additive::off;  // a difference from the first frame
  bool extra_bones_play = false;      // bones of no segment play the start clip on
  std::optional<double> smooth_hz;    // cut-off of a zero-phase filter
  KeyReduction keys;
  // out
  bool append = false;   // to the clips that an output holds
  std::string reaction;  // name of the clip; empty: SEGMENT_FROM
  std::vector<std::filesystem::path> outputs;
  bool clip_only = false;   // without the mesh
  bool all_joints = false;  // keys for every joint of the skin
  std::optional<double> bvh_metres_per_unit;
  std::filesystem::path sheet;         // empty: none
  std::filesystem::path preview;       // moving; empty: none
  ThemeKind theme = ThemeKind::light;  // of the pictures
  std::filesystem::path report;        // empty: none
  std::filesystem::path events;        // times of the clip's marks; empty: none
};

/// The name a bake's clip gets: that of the settings, else SEGMENT_FROM.
std::string reaction_name(const BakeSettings& settings);

/// Simulated time, s. Default: 3 for a limp body, 4 for a living one, 12 with a get-up, which begins at rest.
double simulated_s(const BakeSettings& settings);

/// Seconds that a body lies before it gets up; a clip to get up by asks for that, too. Nothing: it stays
/// down.
std::optional<double> gets_up_after_s(const BakeSettings& settings);

/// The behaviour in force.
BehaviourSettings behaviour_settings(const BakeSettings& settings);

}  // namespace ukemi
