// Materials and their textures as records of an FBX.
#pragma once

#include <cstdint>
#include <map>

#include "fbx/models.h"
#include "fbx/scene.h"

namespace ukemi {

/// Adds a material for each that the parts use, -1 for the default one, with the image of its base colour
/// embedded. Returns their ids.
std::map<int, std::int64_t> add_materials(const FbxScene& scene, FbxRecords& records);

}  // namespace ukemi
