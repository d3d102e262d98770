// The articulated body: 18 rigid segments, 17 joints, masses and collision shapes. A description, no engine
// type.
#pragma once

#include <vector>

#include "base/character.h"
#include "base/math.h"
#include "base/result.h"
#include "base/segments.h"
#include "humanoid/humanoid.h"

namespace ukemi {

enum class ShapeKind { capsule, box };

/// In the segment's frame, metres. Capsule: along the shape's y axis, `length` between the cap centres.
/// Box: full side lengths in `size`.
struct Shape {
  ShapeKind kind = ShapeKind::capsule;
  Rigid segment_from_shape;
  double radius = 0.0;
  double length = 0.0;
  Vec3 size = Vec3::Zero();
};

struct BodySegment {
  double mass_kg = 0.0;
  Vec3 centre_of_mass = Vec3::Zero();  // segment frame
  Mat3 inertia = Mat3::Zero();         // about the centre of mass, segment axes, kg m^2
  std::vector<Shape> shapes;
  /// Outermost points of the skin where it stands far out of the shapes (a big head, a robot's hands), segment
  /// frame, m. They meet the floor alone.
  std::vector<Vec3> floor_points;
};

/// Contract:
/// 1. A fused segment has no joint: it moves rigidly with its parent (its mass and shapes are its own).
/// 2. anchors are the joint centre in the parent's and in the child's segment frame (the latter is the
/// origin).
struct BodyJoint {
  Vec3 anchor_in_parent = Vec3::Zero();
  bool fused = false;
  /// Where the segment's place relative to its parent is fixed (fused): parent_from_child.
  Rigid parent_from_child;
};

enum class Sex { male, female };

struct BodyOptions {
  double mass_kg = 0.0;  // 0: 73 kg (height / 1.741 m)^3 for a man, 61.9 kg (height / 1.735 m)^3 for a woman
  Sex sex = Sex::male;
};

struct ArticulatedBody {
  PerSegment<BodySegment> segments;
  PerJoint<BodyJoint> joints;
  double height_m = 0.0;
  double mass_kg = 0.0;
};

/// Masses, centres and inertias from de Leva 1996 scaled to the character's joint distances and mass; shapes
/// fitted to the skin where there is one, to the table otherwise. `pose` and `segments` are the start pose
/// and its canonical segments: anchors are read from them.
Result<ArticulatedBody> build_body(const Character& character, const Humanoid& humanoid, const Pose& pose,
                                   const BodyPose& segments, const BodyOptions& options,
                                   Diagnostics& diagnostics);

}  // namespace ukemi
