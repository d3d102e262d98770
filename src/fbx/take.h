// One take: an animation stack with its layer, curve nodes and curves.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fbx/models.h"
#include "fbx/tree.h"

namespace ukemi {

/// FBX counts time in these.
inline constexpr double kTicksPerSecond = 46186158000.0;

/// Motion of one model: x, y and z of each animated property, one number per frame; empty where it is not
/// animated.
struct ModelCurves {
  std::int64_t model = 0;
  std::array<std::vector<double>, 3> translation;
  std::array<std::vector<double>, 3> rotation_deg;
  std::array<std::vector<double>, 3> scaling;
};

struct FbxTake {
  std::string name;
  std::vector<std::int64_t> ticks;  // of each frame, rising
  std::vector<ModelCurves> models;
};

/// Adds the take to the end of the objects, connections and takes; nothing that was there changes but the
/// counts of the definitions. A property that rests has a key at either end. Its name is made unique among
/// the stacks.
void add_take(FbxTree& tree, const FbxTake& take);

}  // namespace ukemi
