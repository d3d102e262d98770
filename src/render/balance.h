// What a body stands on: prints of its feet, its support, where its weight is and where it is going.
#pragma once

#include <array>
#include <vector>

#include "render/geometry.h"
#include "render/render.h"

namespace ukemi {

/// Contract: the shot has a body and one set of segments per frame.
class FloorMarks {
 public:
  FloorMarks() = default;
  explicit FloorMarks(const Shot& shot);

  /// A print for every place where a foot has stood up to the frame.
  void add_prints(Geometry& geometry, int frame) const;
  /// The convex hull of the soles that stand, the centre of mass above the floor (dot) and the capture point
  /// (ring): where a foot would have to be to stop the body.
  void add_support(Geometry& geometry, const Shot& shot, int frame) const;

 private:
  using Corners = std::array<Vec2, 4>;
  struct Print {
    int frame;  // from which it is there
    bool left;
    Corners corners;
  };
  std::array<std::array<Vec3, 4>, 2> soles_;  // left, right: foot frame
  std::vector<std::array<bool, 2>> stands_;   // per frame
  std::vector<Print> prints_;
};

}  // namespace ukemi
