// A library of get-ups that somebody performed: which of their moments is nearest to how a body lies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "body/body.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// One get-up, as segments of the character that shall get up.
/// 1. The floor is y = 0, up to what a motion of another body leaves.
/// 2. In the first frame the figure is on the floor and about to move, in the last it stands.
struct RisingClip {
  std::string name;     // "getups.glb: from_back"
  double from_s = 0.0;  // of its first frame, in the file's clip
  double fps = 60.0;
  int floor_frames = 1;  // how many of the first frames show a body that has not begun to rise
  std::vector<BodyPose> frames;

  double duration_s() const { return static_cast<double>(frames.size() - 1) / fps; }
};

/// The get-ups of a motion: stretches in which the figure is on the floor (lying_of) and then comes to stand.
/// Each begins where it has lain still, if it does, and ends with the motion, at the next fall, or where it
/// comes to rest more than a second after it is upright. Empty where nobody gets up.
std::vector<RisingClip> rising_clips_of(const ArticulatedBody& body, const std::string& name, double fps,
                                        const std::vector<BodyPose>& motion);

/// Where a body goes over into a clip.
struct ClipEntry {
  std::size_t clip = 0;     // of the library
  int frame = 0;            // of the clip
  Rigid world_from_clip;    // a turn about the vertical and a shift over the ground
  double apart_m = 0.0;     // of the 18 segments' origins, root mean square
  double turned_deg = 0.0;  // of the 18 segments, root mean square
  double needed_s = 0.0;    // to come from one pose to the other as people move

  /// A body that needs longer would roll over or swing its limbs about: no shift, but a motion of its own.
  static constexpr double kLongest_s = 1.0;
  static constexpr double kShortest_s = 0.3;
  bool in_reach() const { return needed_s <= kLongest_s; }
};

/// The moment of a library that is nearest to a lying pose: the clip turned about the vertical and moved over
/// the ground so that the segments, by their masses, fit best; then positions, velocities and rotations
/// (Zordan et al. 2005, "Dynamic response for motion capture animation", section 4). Moments in reach go
/// first, and earlier ones of a clip. `before`: the pose one frame before. Nothing in an empty library.
std::optional<ClipEntry> nearest_entry(const ArticulatedBody& body, const std::vector<RisingClip>& library,
                                       const BodyPose& before, const BodyPose& lying, double fps);

}  // namespace ukemi
