// A character as the review page's player draws it.
#pragma once

#include <string>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// Skeleton, mesh parts, skins, base colours and the textures that they show, as JSON in ASCII without "<".
/// A character without a mesh gets the simple figure that the exporter gives it.
std::string review_mesh_json(const Character& character, const Humanoid& humanoid);

}  // namespace ukemi
