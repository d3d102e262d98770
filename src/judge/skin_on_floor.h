// How deep the skin of a clip lies below the floor.
#pragma once

#include <vector>

#include "body/skin_points.h"

namespace ukemi {

/// Depths below the floor (y = 0), m; 0 where nothing is.
struct SkinDepth {
  double body_m = 0.0;   // skin of the body (is_body, body/skin_points.h)
  double other_m = 0.0;  // hair, skirts, wings, what hands hold
  int body_node = -1;    // that carries the deepest of them
  int other_node = -1;
};

/// Linear blend skinning of the outermost vertices that each node carries.
class SkinOverFloor {
 public:
  /// `pose` and `segments`: the start pose.
  SkinOverFloor(const Character& character, const Humanoid& humanoid, const ArticulatedBody& body,
                const Pose& pose, const BodyPose& segments);

  SkinDepth depth(const Pose& frame) const;

 private:
  struct Watched {
    SkinVertex vertex;
    bool is_body = false;
  };
  const Character& character_;
  const Humanoid& humanoid_;
  std::vector<Watched> watched_;
};

/// Depths over a whole clip.
struct SkinOnFloor {
  SkinDepth max;       // each skin where it is deepest
  double end_m = 0.0;  // of the body's skin in the last frame
};
SkinOnFloor skin_on_floor(const SkinOverFloor& skin, const std::vector<Pose>& frames);

}  // namespace ukemi
