// A character as the review page's player draws it.
#pragma once

#include <memory>
#include <string>

#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi {

struct ReviewMesh {
  std::string json;
  std::string hash;  // content_hash of it
};

/// Skeleton, mesh parts, skins, base colours and the textures that they show, as JSON in ASCII without "<".
/// A character without a mesh gets the simple figure that the exporter gives it.
/// Each thread keeps the last one: a folder holds many clips of one character.
std::shared_ptr<const ReviewMesh> review_mesh(const Character& character, const Humanoid& humanoid);

}  // namespace ukemi
