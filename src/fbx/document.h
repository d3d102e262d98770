// An FBX document made for a character that comes from another format.
#pragma once

#include "fbx/scene.h"
#include "fbx/tree.h"

namespace ukemi {

/// Header, settings, models, meshes with skins and materials, bind pose; no take.
FbxTree make_fbx_document(const FbxScene& scene);

}  // namespace ukemi
