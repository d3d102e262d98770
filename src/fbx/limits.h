// Limits of rotation and translation of an FBX's models.
#pragma once

#include <string>
#include <vector>

#include "fbx/take.h"
#include "fbx/tree.h"

namespace ukemi {

/// Switches off the limits that the take exceeds (RotationMinX, TranslationMaxZ, ...): Autodesk's SDK, and so
/// most programs, would clamp the take to them. Other limits stay. Returns the names of the models that
/// changed.
std::vector<std::string> lift_limits(FbxTree& tree, const FbxTake& take);

}  // namespace ukemi
