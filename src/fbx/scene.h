// What an FBX document is made from.
#pragma once

#include <vector>

#include "base/character.h"
#include "base/math.h"

namespace ukemi {

/// A character as an FBX holds it: centimetres, y up.
struct FbxScene {
  const Character& character;   // meshes and materials, in its own units
  Skeleton skeleton;            // its nodes, in centimetres
  Similarity cm_from_file;      // without translation
  std::vector<int> bones;       // ascending
  std::vector<MeshPart> parts;  // the character's, or a simple figure
  std::vector<Skin> skins;      // of the parts
  double fps = 60.0;            // of the scene
  bool clip_only = false;       // bones and other nodes alone
};

}  // namespace ukemi
