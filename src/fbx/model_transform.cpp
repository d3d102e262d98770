#include "fbx/model_transform.h"

namespace ukemi {
namespace {

constexpr int kXyz = 0;

/// Angles by axis in the order of the product, and back.
Vec3 in_order(const Vec3& by_axis, const AxisOrder& order) {
  return {by_axis[order[0]], by_axis[order[1]], by_axis[order[2]]};
}
Vec3 by_axis(const Vec3& in_order, const AxisOrder& order) {
  Vec3 angles;
  for (int i = 0; i < 3; ++i) angles[order[i]] = in_order[i];
  return angles;
}

Quat rotation_of(const Vec3& angles_deg, int rotation_order) {
  const AxisOrder order = axis_order(rotation_order);
  return from_euler(in_order(angles_deg * radians(1.0), order), order);
}

/// Where the chain without its translation moves the origin to.
Vec3 pivot_shift(const ModelTransform& model, const Quat& turn, const Vec3& scaling) {
  const Vec3 inside = model.scaling_offset + model.scaling_pivot - scaling.cwiseProduct(model.scaling_pivot);
  return model.rotation_offset + model.rotation_pivot + turn * (inside - model.rotation_pivot);
}

}  // namespace

AxisOrder axis_order(int rotation_order) {
  constexpr AxisOrder kOrders[] = {{2, 1, 0}, {1, 2, 0}, {0, 2, 1}, {2, 0, 1}, {1, 0, 2}, {0, 1, 2}};
  return kOrders[rotation_order >= 0 && rotation_order < 6 ? rotation_order : kXyz];
}

Affine parent_from_model(const ModelTransform& model) {
  const Quat turn = rotation_of(model.pre_rotation_deg, kXyz) *
                    rotation_of(model.rotation_deg, model.rotation_order) *
                    rotation_of(model.post_rotation_deg, kXyz).conjugate();
  Affine affine = Affine::Identity();
  affine.linear() = turn.toRotationMatrix() * model.scaling.asDiagonal();
  affine.translation() = model.translation + pivot_shift(model, turn, model.scaling);
  return affine;
}

LocalValues local_values(const ModelTransform& model, const Affine& wanted, const Vec3& scaling,
                         const Vec3& previous_deg) {
  Mat3 unscaled = wanted.linear();
  for (int i = 0; i < 3; ++i)
    if (scaling[i] != 0.0) unscaled.col(i) /= scaling[i];
  const Quat turn = rotation_part(unscaled);
  const Quat local = rotation_of(model.pre_rotation_deg, kXyz).conjugate() * turn *
                     rotation_of(model.post_rotation_deg, kXyz);
  const AxisOrder order = axis_order(model.rotation_order);
  const Vec3 angles = to_euler(local, order, in_order(previous_deg * radians(1.0), order));
  return {wanted.translation() - pivot_shift(model, turn, scaling), by_axis(angles, order) * degrees(1.0),
          scaling};
}

}  // namespace ukemi
