#include "physics/motor.h"

#include <ode/ode.h>

namespace ukemi {
namespace {

constexpr int suffixed(int parameter, std::size_t row) {
  return parameter + static_cast<int>(row) * dParamGroup;
}

}  // namespace

Quat orientation(const Model& model, int body) { return quat(dBodyGetQuaternion(model.bodies()[body].id)); }

Quat world_from_joint(const Model& model, const ModelJoint& joint) {
  return orientation(model, joint.parent) * joint.parent_from_joint;
}

Vec3 relative_omega(const Model& model, const ModelJoint& joint) {
  return vec3(dBodyGetAngularVel(model.bodies()[joint.child].id)) -
         vec3(dBodyGetAngularVel(model.bodies()[joint.parent].id));
}

void add_torque(const Model& model, const ModelJoint& joint, const Vec3& torque) {
  dBodyAddTorque(model.bodies()[joint.child].id, torque.x(), torque.y(), torque.z());
  dBodyAddTorque(model.bodies()[joint.parent].id, -torque.x(), -torque.y(), -torque.z());
}

dJointID create_motor(OdeWorld& world, const Model& model, const ModelJoint& joint) {
  const dJointID motor = dJointCreateAMotor(world.id(), nullptr);
  dJointAttach(motor, model.bodies()[joint.child].id, model.bodies()[joint.parent].id);
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, 0);
  return motor;
}

void set_axis(dJointID motor, std::size_t row, const Vec3& axis) {
  dJointSetAMotorAxis(motor, static_cast<int>(row), 0, axis.x(), axis.y(), axis.z());
}

double unbounded() { return dInfinity; }

void set_row(dJointID motor, std::size_t i, const MotorRow& row) {
  set_axis(motor, i, row.axis);
  dJointSetAMotorParam(motor, suffixed(dParamVel, i), row.target);
  dJointSetAMotorParam(motor, suffixed(dParamFMax, i), row.most_n_m);
  dJointSetAMotorParam(motor, suffixed(dParamCFM, i), row.cfm);
}

}  // namespace ukemi
