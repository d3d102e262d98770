// A humanoid made by hand: 66 nodes in centimetres below a turned and scaled armature, and a clip of it
// falling.
#pragma once

#include <string>

#include "base/animation.h"
#include "base/character.h"
#include "humanoid/humanoid.h"

namespace ukemi::test {

/// Skeleton, map and document (a .glb without mesh).
struct Puppet {
  Character character;
  Humanoid humanoid;
};
Puppet make_puppet();

/// Falls for 0.7 s, hits the floor, comes to rest; fingers hold still.
Clip falling_clip(const Skeleton& skeleton, int frames = 181, double fps = 60.0);

/// Document of a skeleton alone, written in the plainest way.
std::string plain_document(const Skeleton& skeleton);

/// Largest distance of any node between the clip and the reduced clip as a viewer plays it, metres.
double largest_distance_m(const Skeleton& skeleton, const Clip& clip, const std::vector<Track>& tracks,
                          const Similarity& world_from_file);

}  // namespace ukemi::test
