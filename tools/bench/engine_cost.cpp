// Functions that stand in front of the engine's (linked with --wrap): they time its steps and count their
// rows.
#include <ode/ode.h>

#include <vector>

#include "stopwatch.h"

namespace ukemi {
namespace {

constexpr int kBallRows = 3;

thread_local EngineCost cost;
thread_local std::vector<dJointID> motors;  // of the world that was made last
thread_local long ball_rows = 0;            // likewise
thread_local long contact_rows = 0, contact_points = 0;

/// As ODE counts them: the normal, and friction where there is some, in one direction or in both.
int rows_of(const dSurfaceParameters& surface) {
  const double second = (surface.mode & dContactMu2) != 0 ? surface.mu2 : surface.mu;
  return 1 + (surface.mu > 0.0 ? 1 : 0) + (second > 0.0 ? 1 : 0);
}

/// Every axis of the simulation's motors has a motor or stands at its stop, hence a row.
long motor_rows() {
  long rows = 0;
  for (const dJointID motor : motors)
    if (dJointIsEnabled(motor)) rows += dJointGetAMotorNumAxes(motor);
  return rows;
}

}  // namespace

EngineCost engine_cost() { return cost; }
void reset_engine_cost() { cost = {}; }

}  // namespace ukemi

extern "C" {
dWorldID __real_dWorldCreate();
dJointID __real_dJointCreateBall(dWorldID, dJointGroupID);
dJointID __real_dJointCreateAMotor(dWorldID, dJointGroupID);
dJointID __real_dJointCreateContact(dWorldID, dJointGroupID, const dContact*);
int __real_dWorldStep(dWorldID, dReal);

dWorldID __wrap_dWorldCreate() {
  ukemi::motors.clear();
  ukemi::ball_rows = 0;
  return __real_dWorldCreate();
}

dJointID __wrap_dJointCreateBall(dWorldID world, dJointGroupID group) {
  ukemi::ball_rows += ukemi::kBallRows;
  return __real_dJointCreateBall(world, group);
}

dJointID __wrap_dJointCreateAMotor(dWorldID world, dJointGroupID group) {
  const dJointID motor = __real_dJointCreateAMotor(world, group);
  ukemi::motors.push_back(motor);
  return motor;
}

dJointID __wrap_dJointCreateContact(dWorldID world, dJointGroupID group, const dContact* contact) {
  ++ukemi::contact_points;
  ukemi::contact_rows += ukemi::rows_of(contact->surface);
  return __real_dJointCreateContact(world, group, contact);
}

int __wrap_dWorldStep(dWorldID world, dReal h) {
  ukemi::EngineCost& cost = ukemi::cost;
  const double begin = ukemi::thread_seconds();
  ++cost.calls;
  cost.rows += ukemi::ball_rows + ukemi::motor_rows() + ukemi::contact_rows;
  cost.contacts += ukemi::contact_points;
  ukemi::contact_rows = ukemi::contact_points = 0;
  const double before = ukemi::thread_seconds();
  const int result = __real_dWorldStep(world, h);
  cost.engine_s += ukemi::thread_seconds() - before;
  cost.counting_s += before - begin;
  return result;
}
}
