// Motion of a skeleton: keyed tracks as files hold them, and the uniformly sampled clip that a bake makes.
#pragma once

#include <string>
#include <vector>

#include "base/skeleton.h"

namespace ukemi {

enum class TrackPath { translation, rotation, scale };
enum class Interpolation { step, linear, cubic };

/// Keys of one local quantity of one node.
/// Contract:
/// 1. times are finite and strictly increasing, in seconds.
/// 2. values holds 3 (translation, scale) or 4 (rotation, x y z w) numbers per key; three times as many
///    (in-tangent, value, out-tangent) for cubic, as in glTF.
struct Track {
  int node = -1;
  TrackPath path = TrackPath::rotation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;
  std::vector<double> values;
};

struct Animation {
  std::string name;
  double start_s = 0.0;  // first key
  double end_s = 0.0;    // last key
  double fps = 0.0;      // native rate where the file has one (BVH), else 0
  std::vector<Track> tracks;
  std::string extras_json{};  // the animation's extras in the file; empty: none

  double duration_s() const { return end_s - start_s; }
};

/// The pose at `time_s` (clamped to each track's keys); untouched nodes keep their rest transform.
/// Linear rotations are slerped on the shorter arc, as glTF asks.
Pose sample(const Skeleton& skeleton, const Animation& animation, double time_s);

/// A moment worth naming, in clip time.
struct Mark {
  std::string name;  // "start", "impact", "first_ground_contact", "rest"
  double time_s = 0.0;
};

/// Uniformly sampled poses of the character's own skeleton: frame i is at i / fps seconds.
struct Clip {
  std::string name;
  double fps = 60.0;
  std::vector<Pose> frames;  // each with one local transform per node, file units
  std::vector<Mark> marks;

  double duration_s() const { return frames.empty() ? 0.0 : static_cast<double>(frames.size() - 1) / fps; }
};

/// The animation sampled from its first key on, at `fps` or as often as 5 million transforms allow.
Clip sample_clip(const Skeleton& skeleton, const Animation& animation, double fps);

}  // namespace ukemi
