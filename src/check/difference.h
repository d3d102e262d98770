// Two clips, joint by joint.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/character.h"
#include "base/result.h"

namespace ukemi {

struct DifferenceSettings {
  std::optional<std::string> clip;  // of both files; default: the last of each, where a bake puts its clip
  double tolerance_deg = 1.0;       // key reduction turns short bones by some tenths of a degree
  double tolerance_mm = 1.0;
};

/// Largest differences of one joint over the clips.
struct JointDifference {
  std::string joint;
  double position_mm = 0.0;
  double position_at_s = 0.0;
  double rotation_deg = 0.0;
  double rotation_at_s = 0.0;
};

struct Difference {
  std::string clip_a, clip_b;
  double duration_a_s = 0.0, duration_b_s = 0.0;
  double rate = 0.0;                    // comparisons per second
  long samples = 0;                     // times compared
  std::vector<JointDifference> joints;  // worst first: by the larger share of a tolerance
  std::vector<std::string> only_in_a, only_in_b;
  bool same_axes = true;      // the rest poses agree, and so do the axes of local rotations
  bool same_duration = true;  // to half a sample
  bool within_tolerance = true;
};

/// A file's clip in the world: metres, y up.
struct PlacedClip {
  const Character* character = nullptr;
  const Animation* animation = nullptr;
  Similarity world_from_file;
};

/// Compares joints of the same name: world positions, and rotations relative to the nearest ancestor that
/// both files have (the world where there is none), at the higher of the two native rates, each clip from its
/// first key on. Errors: input (no joint has a name in both).
Result<Difference> difference_of(const PlacedClip& a, const PlacedClip& b,
                                 const DifferenceSettings& settings);

/// Loads both files and compares them. Errors: those of loading; usage (unknown clip); input (no clip).
Result<Difference> difference_of_files(const std::string& a, const std::string& b,
                                       const DifferenceSettings& settings, Diagnostics& diagnostics);

/// `diff --json`: { format, within_tolerance, tolerance_deg, tolerance_mm, a, b, duration_a_s, duration_b_s,
/// samples, position_max_mm, rotation_max_deg, joints: [{joint, position_mm, position_at_s, rotation_deg,
/// rotation_at_s}], only_in_a, only_in_b }.
std::string difference_json(const std::string& a, const std::string& b, const Difference& difference,
                            const DifferenceSettings& settings);
/// For people: the verdict and the worst joints.
std::string difference_text(const std::string& a, const std::string& b, const Difference& difference,
                            const DifferenceSettings& settings);

}  // namespace ukemi
