// A joint's range of motion as numbers and as a picture, alone, with a clip's path through it, or with a link
// that swings into its boundary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "humanoid/humanoid.h"
#include "judge/rom_figures.h"
#include "restrict/range_of_motion.h"
#include "simulate/simulate.h"

namespace ukemi {

struct RomSettings {
  std::optional<std::string> joint;  // default: all
  std::string region = "human";
  std::optional<std::string> check;  // a file, "mannequin", or a clip of the mannequin
  std::optional<std::string> clip;   // of the file to check; default: the last
  HumanoidOptions humanoid;
  std::optional<Vec2> state;  // radians: a point of the joint, drawn with its chords
  bool swing = false;         // swing a single link into the joint's boundary
};

/// A clip's path through the ranges.
struct RomCheck {
  std::string file, clip;
  double fps = 0.0;
  double duration_s = 0.0;
  long frames = 0;
  RomPaths paths;
  RomFigures figures;
};

/// A single link on the joint, pulled towards the corner of the polygon's bounding box that lies furthest
/// outside the polygon.
struct RomSwing {
  Limits limits = Limits::edges;
  double fps = 0.0;
  JointPath path;
};

struct Rom {
  RangeOfMotion range;
  std::vector<Joint> joints;  // asked for
  std::optional<RomCheck> check;
  std::optional<Vec2> state;
  std::vector<RomSwing> swings;
};

/// Errors: usage (unknown joint or clip, options that exclude each other), those of the region and of loading
/// the file to check, simulation.
Result<Rom> rom_of(const RomSettings& settings, Diagnostics& diagnostics);

/// `rom --json`, format 1: { region, joints: {JOINT: {polygon_deg, twist_deg, area_deg2, meanings, check,
/// state, swing}}, check }. meanings: [below 0, above 0] of each angle. What does not apply is left out.
std::string rom_json(const Rom& rom);
/// For people: a table of the ranges, and what was checked.
std::string rom_text(const Rom& rom);
/// One joint large, all joints small, or the swings side by side. Errors: output.
Result<std::vector<std::uint8_t>> rom_png(const Rom& rom);

}  // namespace ukemi
