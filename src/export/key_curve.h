// One local quantity of one node over a clip, and the keys that stand for it.
#pragma once

#include <span>
#include <vector>

#include "base/animation.h"

namespace ukemi {

/// x y z w of a rotation; x y z 0 of a translation or scale.
using KeyValue = Eigen::Vector4d;

/// Contract: `reduced` is what the keys give at every frame; `keys` rise from the first to the last frame, or
/// hold a single one for what rests; rotations have continuous signs.
struct KeyCurve {
  int node = -1;
  TrackPath path = TrackPath::rotation;
  std::vector<KeyValue> wanted;   // one per frame
  std::vector<KeyValue> reduced;  // one per frame
  std::vector<int> keys;          // frames
  std::vector<KeyValue> values;   // one per key

  int last_frame() const { return static_cast<int>(wanted.size()) - 1; }
  bool is_single() const { return keys.size() == 1; }
};

/// Radians, file units or 1.
double distance(TrackPath path, const KeyValue& a, const KeyValue& b);

/// Whether a viewer, which takes the shorter arc, turns from a to b as these signs say.
bool is_short_way(TrackPath path, const KeyValue& a, const KeyValue& b);

/// Keys at the source's values, as far apart as `reduced` stays within twice the tolerance: fitted, they come
/// within it. Frames in `pinned` (ascending; first and last among them) get a key.
void choose_keys(KeyCurve& curve, double tolerance, std::span<const int> pinned);

/// Moves the values of keys `first` to `last` (indices) so that the largest error becomes small: least
/// squares whose weights follow the error over the tolerance (after Lawson). Pinned frames keep their value.
void fit_values(KeyCurve& curve, double tolerance, int first, int last, std::span<const int> pinned);

/// Fills `reduced` between two keys (indices).
void interpolate(KeyCurve& curve, int first, int last);

}  // namespace ukemi
