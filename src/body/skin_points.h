// Vertices of the skin in the segments that move them, and which of them are the body's own.
#pragma once

#include <functional>
#include <vector>

#include "body/body.h"

namespace ukemi {

struct SkinVertex {
  int part = -1;    // of the character
  int vertex = -1;  // of the part
  int node = -1;    // that moves it most
  Segment segment = Segment::pelvis;
  Vec3 place = Vec3::Zero();  // segment frame, m
  /// On a bone of the segment, its fingers or toes, or a rigid mesh on one: not on what else hangs there,
  /// nor where the bind pose throws it far away.
  bool on_bone = false;
};

/// Every vertex that a segment moves; scenery is left out.
void for_each_skin_vertex(const Character& character, const Humanoid& humanoid, const Pose& pose,
                          const BodyPose& segments, const std::function<void(const SkinVertex&)>& see);

/// Distance of a point in a segment's frame from the outside of its nearest shape, m; below 0 inside; huge
/// where there is none. `points` of a hull do not count.
double distance_from(const std::vector<Shape>& shapes, const Vec3& point);

/// True for what simulated bodies are to keep above the floor: skin on the bones, and what lies within 40 mm
/// (of a man) of the shapes, as a face does. Not hair, skirts, wings and what hands hold.
bool is_body(const SkinVertex& vertex, const ArticulatedBody& body);

/// One of `count` evenly spread unit vectors: a Fibonacci lattice on the sphere.
Vec3 direction(int i, int count);

/// The outermost of points in evenly spread directions, in the order of `points`.
std::vector<std::size_t> outermost(const std::vector<Vec3>& points, int directions);

}  // namespace ukemi
