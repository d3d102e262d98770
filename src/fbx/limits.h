// Limits that an FBX sets to what a model may turn and move by.
#pragma once

#include <string>
#include <vector>

#include "fbx/take.h"
#include "fbx/tree.h"

namespace ukemi {

/// Switches off the limits that the take leaves (RotationMinX, TranslationMaxZ, ...): Autodesk's SDK, and so
/// most programs, would bend the take to them. Those that it keeps to stay. Returns the names of the models.
std::vector<std::string> lift_limits(FbxTree& tree, const FbxTake& take);

}  // namespace ukemi
