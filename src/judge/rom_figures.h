// How far poses lie outside the range of motion, joint by joint.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/character.h"
#include "base/segments.h"
#include "clip/frames.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// Bones do not tell how the segments inside them are rolled about their length; a choice of rolls for a
/// whole clip is one reading of it.
enum class Rolls {
  stored,       // as the bake that made the clip wrote them into it
  canonical,    // in every frame like a human body (canonical_segments_of)
  first_frame,  // like a human body in the first frame, from then on fixed to the nodes
};
std::string_view name(Rolls rolls);  // "stored", "canonical", "first-frame"

/// One joint over a clip; empty for a joint above a fused segment.
struct JointPath {
  std::vector<SwingTwist> charts;
  std::vector<double> excess_deg;  // of each chart
};

struct RomPaths {
  Rolls rolls = Rolls::canonical;
  bool neutral_from_motion = false;  // see HumanoidOptions
  PerJoint<JointPath> joints;
};

struct JointRomFigures {
  double over_1deg_fraction = 0.0;  // of the frames
  double over_5deg_fraction = 0.0;
  double excess_max_deg = 0.0;
};

/// Over all joints that move.
struct RomFigures {
  double over_1deg_fraction = 0.0;  // of the joint samples
  double over_5deg_fraction = 0.0;
  double excess_max_deg = 0.0;
  std::optional<Joint> worst_joint;
  Rolls rolls = Rolls::canonical;
  bool neutral_from_motion = false;
  PerJoint<std::optional<JointRomFigures>> joints;  // nothing where the segment is fused
};

/// The joints' paths through `poses`: with the stored frames where there are any, else with the rolls that
/// leave fewer samples outside.
RomPaths rom_paths(const Skeleton& skeleton, const Humanoid& humanoid, const RangeOfMotion& range,
                   const std::vector<Pose>& poses, const std::optional<SegmentFrames>& stored = {});

JointRomFigures rom_figures(const JointPath& path);
RomFigures rom_figures(const RomPaths& paths);

/// A clip of a character, and how its segments were found.
struct ClipToCheck {
  const Character* character;
  std::size_t animation;
  HumanoidOptions options;
};

/// The range that a clip is judged by: that of its bake where it is asked for the human one, else what is
/// asked for.
RangeOfMotion range_of_clip(const RangeOfMotion& range, const Character& character, std::size_t animation);

/// The joints' paths through a clip, in the range of the clip: with the frames that its bake stored in it,
/// else the reading that leaves fewer samples outside. A file with only motion has two neutral poses to be
/// read from: its rest pose, and how the person holds himself in the mean.
RomPaths rom_paths(const ClipToCheck& clip, const Humanoid& humanoid, const RangeOfMotion& range);

/// A clip's poses as they are checked, at most 60 a second.
Clip clip_to_check(const Character& character, std::size_t clip);

}  // namespace ukemi
