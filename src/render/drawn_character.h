// The character of a shot as triangles, frame by frame.
#pragma once

#include <vector>

#include "render/balance.h"
#include "render/geometry.h"
#include "render/render.h"

namespace ukemi {

/// What a frame shows.
struct FrameGeometry {
  Geometry solid;
  Geometry ghost{};    // see-through as a whole: only its front is drawn
  Geometry overlay{};  // the same, over everything else
};

/// Contract: the shot outlives the figure; every frame of the clip has one transform per node.
class DrawnCharacter {
 public:
  DrawnCharacter(const Shot& shot, const Overlays& overlays);

  /// Places of the joints, metres: the humanoid's nodes, else the skins' joints, else all nodes.
  std::vector<Vec3> joints(int frame) const;
  /// The mesh; shapes or bones where there is none, and beside one that shows little of the body.
  Geometry body(int frame) const;
  /// The body as a see-through shape without shadow.
  Geometry ghost(int frame) const;
  /// All of a frame but the floor and the blow's arrow.
  FrameGeometry geometry(int frame) const;
  /// Horizontal unit vector in which the figure looks at a frame; zero where it is unknown.
  Vec3 facing(int frame) const;

 private:
  void add_mesh(Geometry& geometry, const std::vector<Affine>& file_from_node) const;
  void add_shapes(Geometry& geometry, int frame, float alpha) const;
  void add_bones(Geometry& geometry, const std::vector<Affine>& file_from_node) const;
  void add_head(Geometry& geometry, const std::vector<Affine>& file_from_node) const;
  void add_props(Geometry& geometry, int frame) const;
  bool is_above_figure(int node) const;
  std::vector<Affine> world(int frame) const;

  const Shot& shot_;
  Affine world_from_file_;
  std::vector<int> joint_nodes_;
  std::vector<Rgba> bone_colors_;  // per node
  bool mesh_ = false;
  bool covers_ = false;  // the mesh is the body
  bool shapes_ = false;
  Overlays overlays_;
  FloorMarks floor_marks_;  // where prints are drawn
  std::vector<Vec3> hips_;  // per frame, where the trail is drawn
};

}  // namespace ukemi
