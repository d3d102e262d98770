// Where an FBX model stands in its parent: the chain of translation, pivots, rotations and scaling.
#pragma once

#include "base/math.h"
#include "export/euler.h"

namespace ukemi {

/// The properties of a model that place it, file units and degrees. Angles are about x, y and z whatever the
/// order; pre- and post-rotation turn about x first, then y, then z.
struct ModelTransform {
  Vec3 translation = Vec3::Zero();   // Lcl Translation
  Vec3 rotation_deg = Vec3::Zero();  // Lcl Rotation
  Vec3 scaling = Vec3::Ones();       // Lcl Scaling
  Vec3 rotation_offset = Vec3::Zero();
  Vec3 rotation_pivot = Vec3::Zero();
  Vec3 pre_rotation_deg = Vec3::Zero();
  Vec3 post_rotation_deg = Vec3::Zero();
  Vec3 scaling_offset = Vec3::Zero();
  Vec3 scaling_pivot = Vec3::Zero();
  int rotation_order = 0;  // RotationOrder: 0 XYZ, XZY, YZX, YXZ, ZXY, 5 ZYX
};

/// The axes of RotationOrder as a product of rotations: XYZ, about x first, is R_z R_y R_x.
AxisOrder axis_order(int rotation_order);

/// parent_from_model = T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1 (FBX SDK, "Transformation of a node").
Affine parent_from_model(const ModelTransform& model);

/// The three properties that can be animated.
struct LocalValues {
  Vec3 translation = Vec3::Zero();
  Vec3 rotation_deg = Vec3::Zero();
  Vec3 scaling = Vec3::Ones();
};

/// Values with which `model` stands at `wanted`: parent_from_model of the result is `wanted`, as far as it
/// has no shear. `scaling` is given; `previous_deg` are the angles before, from which the new ones do not
/// jump.
LocalValues local_values(const ModelTransform& model, const Affine& wanted, const Vec3& scaling,
                         const Vec3& previous_deg);

}  // namespace ukemi
