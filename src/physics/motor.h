// Motors between the two bodies of a joint: what restriction and muscles are made of.
#pragma once

#include "physics/model.h"

namespace ukemi {

Quat orientation(const Model& model, int body);
/// World axes of the joint frame.
Quat world_from_joint(const Model& model, const ModelJoint& joint);
/// Angular velocity of the child relative to the parent, world, rad/s.
Vec3 relative_omega(const Model& model, const ModelJoint& joint);
/// A torque on the child, the opposite on the parent, world, N m.
void add_torque(const Model& model, const ModelJoint& joint, const Vec3& torque);

/// A motor whose angles grow with the child's rotation relative to the parent. No axes yet.
dJointID create_motor(OdeWorld& world, const Model& model, const ModelJoint& joint);
void set_axis(dJointID motor, std::size_t row, const Vec3& axis);

/// A row that drives the speed about an axis:
///   torque = (target - speed after the step) / cfm, at most `most_n_m` either way.
struct MotorRow {
  Vec3 axis = Vec3::UnitX();  // world, unit
  double target = 0.0;        // rad/s
  double cfm = 1.0;           // rad/(s N m)
  double most_n_m = 0.0;      // unbounded(): no bound
};
double unbounded();
void set_row(dJointID motor, std::size_t i, const MotorRow& row);

}  // namespace ukemi
